"""Which load a film has, from its specification to rows, shapes and pictures."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import replace
from pathlib import Path

import pytest
from matplotlib.axes import Axes
from matplotlib.text import Text

from eulerplateau.film.load import FILM_LOADS, LOADS, SPRING_LOAD, TENSION
from eulerplateau.film.models import make_film
from eulerplateau.mesh.disk import Disk
from eulerplateau.pictures.comparison import runs_figure
from eulerplateau.pictures.gallery import collect, page
from eulerplateau.pictures.render.captions import text_of
from eulerplateau.runs import run_branches, run_sweep
from eulerplateau.runs.record import read_run, read_runs
from eulerplateau.runs.rows import BranchRow, Row
from eulerplateau.runs.spec import RunSpec
from eulerplateau.settings import validate
from tests.helpers.plotted_runs import loads, pitchfork, record, row_at
from tests.helpers.shapes import disk_points, mesh_of
from tests.runs.test_output import ROW


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return mesh_of(*disk_points(6))


def specification(film: str, **sweep_settings: object) -> RunSpec:
    data = {
        "mesh": {"polygon": {"kind": "regular", "sides": 24}, "vertices": 120},
        "film": {"model": film},
        "sweep": {"loads": [100.0, 1000.0], **sweep_settings},
        "branches": {"special_points": 1},
    }
    return validate(data, RunSpec, "test")


def tension_rows() -> list[Row]:
    """The pitchfork of plotted_runs, its loads taken for tensions."""
    return [
        replace(
            row_at(step, load),
            kL3_alpha=load / (2 * math.sqrt(3)),
            sigma_hat=load,
            quantity=TENSION.column,
        )
        for step, load in enumerate(loads())
    ]


def test_every_film_has_a_load(mesh: Disk) -> None:
    for name, load in FILM_LOADS.items():
        assert make_film(mesh, name).load is load
    assert set(LOADS) == {"kL3_alpha", "sigma_hat"}


@pytest.mark.parametrize("film", FILM_LOADS)
def test_rows_carry_both_loads_and_the_films_own_exactly(tmp_path: Path, film: str) -> None:
    rows = run_sweep(specification(film), tmp_path / "out").rows
    assert [row.load for row in rows] == [100.0, 1000.0]
    assert {row.load_name for row in rows} == {FILM_LOADS[film]}
    for row in rows:
        assert row.sigma_hat == pytest.approx(math.sqrt(12) * row.kL3_alpha, rel=1e-15)
        assert row.load == getattr(row, FILM_LOADS[film].column)
    assert list(read_run(tmp_path / "out").rows) == list(rows)
    assert f"<!-- timestep is the load {FILM_LOADS[film].text} -->" in (
        (tmp_path / "out" / "sweep.pvd").read_text()
    )


def test_special_points_give_both_loads_with_their_errors(tmp_path: Path) -> None:
    """The disk's first threshold, of the film with a tension."""
    spec = specification("dirichlet", loads=[2000.0, 4000.0])
    result = run_branches(spec, tmp_path / "out")
    with (tmp_path / "out" / "special_points.csv").open(newline="") as file:
        special = next(csv.DictReader(file))
    row = result.rows[int(special["step"])]
    assert row.load == row.sigma_hat == float(special["sigma_hat"])
    for column in ("kL3_alpha", "sigma_hat"):
        assert 0 < float(special[f"{column}_error"]) < 1e-8 * float(special[column])
    assert read_run(tmp_path / "out").rows == result.rows


def test_films_of_different_kinds_are_compared_by_their_tension(
    tmp_path: Path, mesh: Disk
) -> None:
    springs = record(tmp_path / "a", mesh, [row_at(0, 1.0), row_at(1, 2.0)])
    other = record(tmp_path / "b", mesh, tension_rows(), model="dirichlet")
    alone = read_run(springs)
    assert [row.load for row in alone.rows] == [1.0, 2.0]
    for run in read_runs([springs, other]):
        assert {row.load_name for row in run.rows} == {run.load} == {TENSION}
        assert [row.load for row in run.rows] == [row.sigma_hat for row in run.rows]
    first, second = (run.label for run in read_runs([springs, other]))
    assert ("springs" in first, "dirichlet" in second) == (True, True)


def test_table_whose_run_says_no_film_is_shown_over_the_load_of_springs(
    tmp_path: Path, mesh: Disk
) -> None:
    folder = record(tmp_path / "run", mesh, tension_rows(), model="dirichlet")
    for text in ('{"spec": {}}', "[]", "{", '{"spec": {"film": {"model": "rubber"}}}'):
        (folder / "run.json").write_text(text)
        assert {row.load_name for row in read_run(folder).rows} == {SPRING_LOAD}


@pytest.mark.usefixtures("coarse_pictures")
@pytest.mark.parametrize("what", ["diagram", "curvature", "onset"])
def test_figures_are_over_the_films_own_load(tmp_path: Path, mesh: Disk, what: str) -> None:
    springs = record(tmp_path / "a", mesh, [row_at(i, v) for i, v in enumerate(loads())])
    other = record(tmp_path / "b", mesh, tension_rows(), model="dirichlet")
    for folder, load in ((springs, SPRING_LOAD), (other, TENSION)):
        (run,) = read_runs([folder])
        figure = runs_figure([run], what)
        texts = [text.get_text() for text in figure.findobj(Text)]
        for name in (SPRING_LOAD, TENSION):
            assert any(name.tex in text for text in texts) == (name is load)
        reach = {round(x) for ax in figure.findobj(Axes) for x in ax.get_xlim()}
        assert what == "onset" or max(reach) > max(loads()) - 1


def test_captions_and_galleries_name_the_films_own_load(tmp_path: Path, mesh: Disk) -> None:
    rows = tension_rows()
    assert TENSION.tex in text_of(rows[0])
    assert SPRING_LOAD.tex in text_of(ROW)
    folder = record(tmp_path / "run", mesh, rows, model="dirichlet")
    text = page(collect([folder])).decode()
    start = text.index('id="data">') + len('id="data">')
    assert json.loads(text[start : text.index("</script>", start)])["load"] == "sigma_hat"


def test_branch_of_a_film_with_a_tension_is_drawn_over_it(
    tmp_path: Path, mesh: Disk
) -> None:
    rows = [replace(row, sigma_hat=7 * row.kL3_alpha) for row in pitchfork()]
    folder = record(tmp_path / "run", mesh, rows, model="area")
    (run,) = read_runs([folder])
    assert all(isinstance(row, BranchRow) for row in run.rows)
    for branch in run.branches:
        assert list(branch.loads) == [row.sigma_hat for row in branch.rows]
