"""Runs whose films are refined on the way: rows, shapes, going on, starting from them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.mesh import read_disk, write_mesh
from eulerplateau.pictures.gallery.collection import collect
from eulerplateau.pictures.gallery.document import page
from eulerplateau.runs import read_run, read_shape, run_branches, run_sweep
from eulerplateau.runs.spec import RunSpec
from eulerplateau.settings import validate
from tests.helpers import shapes

# Two lobes without contact; the eight they snap to, in contact; the same at another load.
LOADS = [1750.0, 2000.0, 2050.0]


@pytest.fixture(scope="module")
def mesh(tmp_path_factory: pytest.TempPathFactory) -> Path:
    points, triangles = shapes.disk_points(8)
    path = tmp_path_factory.mktemp("mesh") / "oval.vtp"
    write_mesh(shapes.mesh_of(points * [1.6, 1.0], triangles), path)
    return path


def spec(mesh: Path, loads: list[float], **sections: Any) -> RunSpec:
    said = {
        "mesh": {"file": str(mesh)},
        "film": {"model": "area"},
        "loop": {"diameter": 0.008},
        "sweep": {"loads": loads},
        **sections,
    }
    return validate(said, RunSpec, "run")


@pytest.fixture(scope="module")
def swept(mesh: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "thin"
    run_sweep(spec(mesh, LOADS), folder)
    return folder


def test_rows_say_how_many_vertices_their_films_have(mesh: Path, swept: Path) -> None:
    n_v = read_disk(mesh).n_v
    free, touching, after = read_run(swept).rows
    assert (free.contacts, touching.contacts, after.contacts) == (0, 1, 1)
    assert free.film_vertices == n_v < touching.film_vertices == after.film_vertices


@pytest.mark.slow
def test_a_key_keeps_films_on_their_mesh(mesh: Path, tmp_path: Path) -> None:
    film = {"model": "area", "refine": False}
    run_sweep(spec(mesh, LOADS[:2], film=film), tmp_path / "plain")
    _, touching = read_run(tmp_path / "plain").rows
    assert touching.contacts == 1
    assert touching.film_vertices == read_disk(mesh).n_v


def test_shapes_of_a_run_are_of_one_mesh_and_are_shown_together(swept: Path) -> None:
    run = read_run(swept)
    stored = [read_shape(run.shape_path(row)) for row in run.rows]
    together = run.shapes()
    assert together.x.shape[1] == max(len(shape.x) for shape in stored)
    for place, (shape, row) in enumerate(zip(stored, run.rows, strict=True)):
        n = len(shape.x)
        assert n == row.film_vertices
        assert together.triangles(place).tolist() == shape.triangles.tolist()
        np.testing.assert_array_equal(together.x[place, :n], shape.x)
    assert b"thin" in page(collect([swept]))


def test_a_run_starts_from_a_refined_shape(mesh: Path, swept: Path, tmp_path: Path) -> None:
    run = read_run(swept)
    row, start = (
        run.rows[1],
        {"file": str(run.shape_path(run.rows[1])), "displacement": 0.0},
    )
    for refine in (True, False):
        film, folder = {"model": "area", "refine": refine}, tmp_path / str(refine)
        run_sweep(spec(mesh, [row.sigma_hat], start=start, film=film), folder)
        (again,) = read_run(folder).rows
        assert again.converged
        if refine:
            assert again.film_vertices == row.film_vertices
            # Thin triangles of a soap film are mended where it is made anew.
            assert again.energy == pytest.approx(row.energy, rel=1e-6)
        else:
            assert again.film_vertices == read_disk(mesh).n_v


@pytest.mark.slow
def test_a_run_goes_on_from_a_refined_shape(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    run_sweep(spec(mesh, LOADS[:2]), tmp_path / "run")
    run_sweep(spec(mesh, LOADS), tmp_path / "run", resume=True)
    whole, parts = read_run(swept).rows[-1], read_run(tmp_path / "run").rows[-1]
    assert parts.film_vertices == whole.film_vertices
    assert parts.energy == pytest.approx(whole.energy, rel=1e-10)


def test_branches_start_from_a_refined_shape(
    mesh: Path, swept: Path, tmp_path: Path
) -> None:
    run = read_run(swept)
    row, start = (
        run.rows[1],
        {"file": str(run.shape_path(run.rows[1])), "displacement": 0.0},
    )
    ends = {"load_min": row.sigma_hat - 1.0, "load_max": row.sigma_hat + 1.0}
    run_branches(spec(mesh, LOADS, start=start, branches=ends), tmp_path / "branches")
    film = {"model": "area", "refine": False}
    run_sweep(spec(mesh, [row.sigma_hat], start=start, film=film), tmp_path / "plain")
    found, (plain,) = (read_run(tmp_path / name).rows for name in ("branches", "plain"))
    assert found[0].contacts == 1
    assert found[0].energy == pytest.approx(plain.energy, rel=1e-8)
