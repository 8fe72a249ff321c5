"""`eulerplateau catalogue`: what it leaves behind, and that its numbers agree."""

from __future__ import annotations

import csv
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from eulerplateau.errors import ConflictError
from eulerplateau.mesh import write_mesh
from eulerplateau.pictures import draw_catalogue
from eulerplateau.runs.catalogue import run_catalogue
from eulerplateau.runs.catalogue_table import COUNT_COLUMNS, Catalogue, read_catalogue
from eulerplateau.runs.rows import CatalogueRow
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.sweep import run_sweep
from eulerplateau.runs.table import read_rows
from eulerplateau.settings import validate
from tests.helpers.shapes import disk_points, mesh_of

LOADS, STARTS = [200.0, 300.0], 2


def specification(folder: Path, **film: Any) -> RunSpec:
    points, triangles = disk_points(3)
    write_mesh(mesh_of(points * [1.6, 1.0], triangles), folder / "oval.vtp")
    data = {
        "mesh": {"file": str(folder / "oval.vtp")},
        "film": film,
        "sweep": {"loads": [1.0]},
        "catalogue": {"starts": STARTS, "loads": LOADS},
    }
    return validate(data, RunSpec, "test")


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Catalogue:
    folder = tmp_path_factory.mktemp("catalogue")
    return run_catalogue(specification(folder), folder / "out")


def test_rows_are_on_disk_by_load_and_energy(result: Catalogue) -> None:
    rows = read_rows(result.folder / "catalogue.csv", CatalogueRow)
    assert tuple(rows) == result.rows
    assert sorted({row.load for row in rows}) == LOADS
    for load in LOADS:
        own = [row for row in rows if row.load == load]
        assert [row.number for row in own] == list(range(len(own)))
        assert [row.energy for row in own] == sorted(row.energy for row in own)
        assert all(row.converged and row.n_unstable <= 4 for row in own)
        assert all(row.by_starts + row.by_deflation > 0 for row in own)
        # Deflation begins at what a sweep finds.
        assert 0 in [row.first_guess for row in own]


def test_counts_end_with_what_the_rows_say(result: Catalogue) -> None:
    with (result.folder / "counts.csv").open(newline="") as file:
        lines = [{k: float(v) for k, v in line.items()} for line in csv.DictReader(file)]
    assert tuple(lines[0]) == COUNT_COLUMNS
    for load in LOADS:
        rows = [row for row in result.rows if row.load == load]
        own = [line for line in lines if line["load"] == load]
        assert [line["search"] for line in own] == list(range(1, STARTS + 1))
        assert own[-1]["together"] == len(rows)
        assert own[-1]["by_starts"] == sum(row.by_starts > 0 for row in rows)
        assert own[-1]["by_deflation"] == sum(row.by_deflation > 0 for row in rows)
        for before, after in pairwise(own):
            assert all(before[name] <= after[name] for name in COUNT_COLUMNS[2:])


def test_a_finished_one_is_left_as_it_is_and_is_no_sweeps_folder(
    result: Catalogue, tmp_path: Path
) -> None:
    about = specification(tmp_path)
    again = run_catalogue(about, result.folder)
    assert again.finished
    assert again.rows == result.rows
    assert again.counts == result.counts
    assert read_catalogue(result.folder).rows == result.rows
    with pytest.raises(ConflictError):
        run_sweep(about, result.folder)


def test_it_is_drawn(result: Catalogue) -> None:
    assert draw_catalogue(result.folder)
    assert (result.folder / "catalogue.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_a_film_kept_in_its_plane_has_a_catalogue_of_films_in_it(tmp_path: Path) -> None:
    listed = run_catalogue(
        specification(tmp_path, model="area", plane=True), tmp_path / "o"
    )
    assert {row.load for row in listed.rows} == set(LOADS)
    assert all(row.converged and row.abs_kappa_n < 1e-9 for row in listed.rows)
