"""A film that follows what one drags is that of a sweep, and tells when it jumps."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from eulerplateau.errors import OutputError
from eulerplateau.mesh import write_mesh
from eulerplateau.mesh.disk import Disk
from eulerplateau.runs import LiveFilm, RunSpec, run_sweep
from eulerplateau.solvers import Problem, Status, sweep
from tests.helpers import shapes

# Michell (1889): a straight-sided ring of a rod with C = B gives way at sqrt(3) turns.
MICHELL = 3**0.5


@pytest.fixture
def mesh(oval: Disk, tmp_path: Path) -> str:
    write_mesh(oval, tmp_path / "oval.vtp")
    return str(tmp_path / "oval.vtp")


@pytest.fixture
def finer(tmp_path: Path) -> str:
    """On which the turns of an eight's loop are resolved wherever its strands cross."""
    points, triangles = shapes.disk_points(9, jitter=0.2)
    write_mesh(shapes.mesh_of(points * [1.5, 1.0], triangles), tmp_path / "finer.vtp")
    return str(tmp_path / "finer.vtp")


def springs(mesh: str, **more: Any) -> RunSpec:
    return RunSpec(mesh={"file": mesh}, sweep={"loads": [100.0, 1500.0]}, **more)


def twisted(mesh: str) -> LiveFilm:
    """A ring whose film hardly pulls, of a rod that has a thickness and resists twist."""
    return LiveFilm(
        RunSpec(
            mesh={"file": mesh},
            film={"load": 1.0},
            loop={"twist_ratio": 1.0, "diameter": 0.03},
            sweep={"parameter": "link", "values": [0.0, 3.0]},
        )
    )


def test_a_film_that_is_dragged_is_that_of_a_sweep(mesh: str, oval: Disk) -> None:
    loads = [100.0, 400.0, 900.0, 600.0, 300.0]
    film = LiveFilm(springs(mesh))
    dragged = [film.follow({"kL3_alpha": load}).row for load in loads]
    swept = list(sweep(Problem(oval), loads))
    assert [row.status for row in dragged] == [Status.CONVERGED] * len(loads)
    assert [row.energy for row in dragged] == pytest.approx(
        [found.energy for found in swept], rel=1e-9
    )
    assert [row.step for row in dragged] == [1, 2, 3, 4, 5]


def test_a_value_beyond_its_range_is_the_end_of_that(mesh: str) -> None:
    film = LiveFilm(springs(mesh))
    assert film.follow({"kL3_alpha": 1e9}).row.kL3_alpha == 1500.0
    assert film.follow({"kL3_alpha": -5.0}).row.kL3_alpha == 100.0


def test_where_the_way_is_smooth_nothing_jumps_however_long_the_steps(mesh: str) -> None:
    film = LiveFilm(springs(mesh))
    loads = (200.0, 1500.0, 120.0, 800.0)
    assert not any(film.follow({"kL3_alpha": load}).jumped for load in loads)


@pytest.mark.slow
def test_a_ring_jumps_beyond_michells_link_and_comes_back_later(finer: str) -> None:
    film = twisted(finer)
    before = film.follow({"link": MICHELL - 0.08})
    beyond = film.follow({"link": MICHELL + 0.08})
    back = film.follow({"link": MICHELL - 0.08})
    assert [point.jumped for point in (before, beyond, back)] == [False, True, False]
    assert abs(before.row.writhe) < 0.01 < 0.9 < back.row.writhe  # type: ignore[attr-defined]
    assert back.row.energy < before.row.energy
    assert back.row.converged


@pytest.mark.slow
def test_both_states_at_one_link_are_the_other_of_each_other(finer: str) -> None:
    film = twisted(finer)
    ring = film.follow({"link": MICHELL - 0.08})
    film.follow({"link": MICHELL + 0.08})
    eight = film.follow({"link": MICHELL - 0.08})
    for state in (ring, eight, ring):
        found = film.other()
        assert found is not None
        assert found.way == "other"
        assert found.row.energy == pytest.approx(state.row.energy, rel=1e-8)


@pytest.mark.slow
def test_a_stable_film_comes_back_from_a_kick_and_from_the_start(mesh: str) -> None:
    film = LiveFilm(springs(mesh))
    before = film.follow({"kL3_alpha": 300.0})
    kicked, begun = film.kick(), film.begin()
    assert not kicked.jumped
    energies = [kicked.row.energy, begun.row.energy]
    assert energies == pytest.approx([before.row.energy] * 2, rel=1e-9)
    assert film.other() is None


def test_a_shape_that_is_saved_replaces_nothing_and_is_started_from(
    mesh: str, tmp_path: Path
) -> None:
    film = LiveFilm(springs(mesh))
    film.follow({"kL3_alpha": 900.0})
    (tmp_path / "run" / "live").mkdir(parents=True)
    (tmp_path / "run" / "live" / "live-0001.vtp").write_text("mine")
    path = film.save(tmp_path / "run")
    assert path.name == "live-0002.vtp"
    assert (tmp_path / "run" / "live" / "live-0001.vtp").read_text() == "mine"
    again = LiveFilm(springs(mesh, start={"file": str(path)}))
    found = again.follow({"kL3_alpha": 900.0})
    assert found.row.energy == pytest.approx(film.at.row.energy, rel=1e-9)


def test_a_sweep_and_saved_shapes_share_a_folder(mesh: str, tmp_path: Path) -> None:
    film, folder = LiveFilm(springs(mesh)), tmp_path / "run"
    first = film.save(folder)
    run_sweep(springs(mesh), folder)
    second = film.save(folder)
    run_sweep(springs(mesh, start={"seed": 2}), folder, overwrite=True)
    assert first.is_file()
    assert second.is_file()


def test_nothing_is_saved_into_a_folder_that_is_no_run(mesh: str, tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="something else than a run"):
        LiveFilm(springs(mesh)).save(tmp_path)  # where the mesh lies
    assert [path.name for path in tmp_path.iterdir()] == ["oval.vtp"]


def test_a_run_in_units_is_dragged_in_its_own(mesh: str) -> None:
    spec = RunSpec(
        mesh={"file": mesh},
        rod={"young_modulus": "2 GPa", "diameter": "0.2 mm", "poisson_ratio": 0.4},
        film={"model": "dirichlet", "surface_tension": "25 mN/m"},
        loop={"twist_ratio": "rod"},
        sweep={"parameter": "length", "values": ["5 cm", "10 cm"]},
    )
    film = LiveFilm(spec)
    assert [each.key for each in film.varied] == ["length_m", "link"]
    length = film.varied[0]
    assert [length.low, length.high] == pytest.approx([5.0, 10.0])
    rows = [film.follow({"length_m": cm}).row for cm in (6.0, 9.0)]
    assert [row.load for row in rows] == pytest.approx([6.0, 9.0])
    assert rows[1].sigma_hat / rows[0].sigma_hat == pytest.approx((9 / 6) ** 3)


def test_a_film_of_a_thick_loop_says_how_thick_it_is_now(mesh: str) -> None:
    film = twisted(mesh)
    assert [each.key for each in film.varied] == ["link", "kL3_alpha", "diameter"]
    assert film.follow({"diameter": 0.05}).radius == 0.025
    assert np.shape(film.at.directors) == (film.at.shape.loop.size, 3)
