"""`import eulerplateau as ep`: lists and arrays go in, the project's errors come out."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import eulerplateau as ep
from eulerplateau.errors import MeshError, OutputError, SpecError

ROOT = Path(__file__).parents[2]
CROSSING = [[0, 0], [1, 1], [1, 0], [0, 1]]


@pytest.fixture(scope="module")
def disk() -> ep.Disk:
    return ep.read_disk(ROOT / "meshes" / "elongated.vtp")


@pytest.fixture(scope="module")
def problem(disk: ep.Disk) -> ep.Problem:
    return ep.Problem(disk)


@pytest.fixture(scope="module")
def saddle(problem: ep.Problem) -> ep.Equilibrium:
    return ep.solve(problem, load=700)


Call = Callable[[ep.Problem], object]
WRONG: dict[str, tuple[type[Exception], str, Call]] = {
    "a vertex too few": (
        SpecError,
        "start",
        lambda p: ep.solve(p, 700, p.disk.x[:-1]),
    ),
    "two coordinates": (SpecError, "start", lambda p: ep.solve(p, 700, p.disk.x[:, :2])),
    "words for positions": (SpecError, "start", lambda p: ep.solve(p, 700, "flat")),
    "tensions of another loop": (
        SpecError,
        "tensions",
        lambda p: ep.solve(p, 700, tensions=np.zeros(3)),
    ),
    "a negative load": (SpecError, "load", lambda p: ep.solve(p, -1)),
    "no number for a load": (SpecError, "load", lambda p: ep.solve(p, float("nan"))),
    "a word for a load": (SpecError, "load", lambda p: ep.solve(p, "much")),
    "a negative load in a sweep": (SpecError, "load", lambda p: ep.sweep(p, [1, -1])),
    "an unknown solver": (SpecError, "solver", lambda p: ep.solve(p, 1, solver="magic")),
    "no iterations": (
        SpecError,
        "max_iterations",
        lambda p: ep.solve(p, 1, max_iterations=0),
    ),
    "an unknown film": (SpecError, "film", lambda p: ep.Problem(p.disk, "rubber")),
    "springs in a plane": (
        SpecError,
        "in_plane",
        lambda p: ep.Problem(p.disk, in_plane=True),
    ),
    "no disk": (SpecError, "disk", lambda p: ep.Problem("meshes/elongated.vtp")),
    "a window upside down": (SpecError, "window", lambda p: ep.explore(p, (800, 600))),
    "a crossing polygon": (SpecError, "polygon", lambda p: ep.mesh_polygon(CROSSING)),
    "an unknown polygon": (SpecError, "polygon", lambda p: ep.mesh_polygon("blob")),
    "half a polygon": (SpecError, "polygon", lambda p: ep.mesh_polygon("ellipse")),
    "no such mesh": (SpecError, "nowhere.vtp", lambda p: ep.read_disk("nowhere.vtp")),
    "no such run": (OutputError, "nowhere", lambda p: ep.read_run("nowhere")),
    "no such shape": (OutputError, "nowhere", lambda p: ep.read_shape("nowhere.vtp")),
    "an unknown key": (
        SpecError,
        "film.kind",
        lambda p: ep.run({"film": {"kind": "area"}}, "nowhere"),
    ),
    "a shape that is not finite": (
        MeshError,
        "vertex",
        lambda p: ep.measure(p.disk, p.shape(p.disk.x * np.nan)),
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_is_wrong_is_named_by_the_projects_own_errors(
    case: str, problem: ep.Problem
) -> None:
    error, culprit, call = WRONG[case]
    with pytest.raises(error, match=culprit) as caught:
        call(problem)
    assert isinstance(caught.value, ep.EulerPlateauError)
    assert "\n" not in str(caught.value)


def test_a_shape_of_another_disk_is_no_start(problem: ep.Problem) -> None:
    other = ep.read_disk(ROOT / "meshes" / "hexagon.vtp")
    with pytest.raises(SpecError, match="start"):
        ep.solve(problem, 700, other.shape)


def test_lists_arrays_shapes_and_equilibria_are_the_same_start(
    problem: ep.Problem, saddle: ep.Equilibrium
) -> None:
    x = saddle.shape.x
    starts = [x, x.tolist(), problem.shape(x), saddle]
    found = [ep.solve(problem, 705, start) for start in starts]
    energies = np.array([equilibrium.energy for equilibrium in found])
    np.testing.assert_allclose(energies, energies[0], rtol=1e-13)
    assert all(equilibrium.is_minimum for equilibrium in found)


def test_polygons_are_made_from_lists_and_arrays() -> None:
    corners = [[0, 0], [3, -1], [5, 0], [3, 1]]
    by_list = ep.mesh_polygon(corners, vertices=60)
    by_array = ep.mesh_polygon(np.array(corners), vertices=60)
    np.testing.assert_array_equal(by_list.x, by_array.x)


def test_energy_of_unit_load_is_the_energys_derivative_along_a_sweep(
    problem: ep.Problem,
) -> None:
    """dE/dload is the film's energy over the load: the envelope theorem."""
    low, middle, high = ep.sweep(problem, loads=range(699, 702))
    rate = 0.5 * (high.energy - low.energy)
    assert rate == pytest.approx(middle.film_energy / middle.load, rel=1e-5)


def test_results_print_in_a_line(problem: ep.Problem, saddle: ep.Equilibrium) -> None:
    shown = [problem, problem.disk, problem.film, saddle, saddle.shape]
    shown += [ep.Problem(problem.disk, "area", in_plane=plane).film for plane in (0, 1)]
    shown += [ep.planar_film(lobes=2, tension=2000.0)]
    for thing in shown:
        assert "\n" not in repr(thing)
        assert len(repr(thing)) < 160
    assert "700" in repr(saddle)
    assert "converged" in repr(saddle)


def test_a_run_from_python_comes_back_as_its_rows(tmp_path: Path, disk: ep.Disk) -> None:
    spec = {
        "mesh": {"file": str(ROOT / "meshes" / "elongated.vtp")},
        "sweep": {"loads": [600, 700]},
    }
    run = ep.run(spec, tmp_path / "run")
    assert [row.load for row in run.rows] == [600, 700]
    again = ep.solve(ep.Problem(disk), 700, ep.read_shape(run.shape_path(run.rows[1])))
    assert again.energy == pytest.approx(run.rows[1].energy, rel=1e-13)
