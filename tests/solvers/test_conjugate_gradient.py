"""The paper's method against Newton's, and its own promises."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.film.models import (
    area,
)
from eulerplateau.mesh import MeshSpec, generate
from eulerplateau.mesh.disk import Disk
from eulerplateau.settings import validate
from eulerplateau.solvers import Problem, conjugate_gradient, displaced, solving
from eulerplateau.solvers.equilibrium import (
    LENGTH_TOLERANCE,
    RESIDUAL_TOLERANCE,
    Equilibrium,
    Status,
)
from eulerplateau.solvers.start import smooth_kick
from tests.helpers import equilibria, shapes


def regular() -> Disk:
    return shapes.mesh_of(*shapes.hexagon_points(5))


def irregular() -> Disk:
    """61 vertices: what this method promises does not depend on how many there are."""
    points, triangles = shapes.disk_points(4, jitter=0.2)
    return shapes.mesh_of(points * [1.5, 1.0], triangles)


def long() -> Disk:
    points, triangles = shapes.hexagon_points(5)
    return shapes.mesh_of(points * [2.0, 1.0], triangles)


@pytest.fixture(scope="module")
def coarse() -> Disk:
    return irregular()


@pytest.fixture(scope="module")
def coarse_problem(coarse: Disk) -> Problem:
    return Problem(coarse)


def solve(name: str, mesh: Disk, x: FloatArray, load: float) -> Equilibrium:
    return solving.solve(Problem(mesh), load, x, solver=name)


# From the plane, through twisted saddles, to folded films.
CASES = [
    (regular, 300.0),
    (regular, 700.0),
    (irregular, 300.0),
    (irregular, 900.0),
    (irregular, 1600.0),
    (long, 300.0),
    (long, 1000.0),
    (long, 2500.0),
]


PLAIN = [("cg-plain", regular, 300.0), ("cg-plain", irregular, 300.0)]


@pytest.mark.parametrize(
    ("name", "make", "load"), [*(("cg", *case) for case in CASES), *PLAIN]
)
def test_every_solver_reaches_the_same_equilibrium_on_every_case(
    name: str, make: Callable[[], Disk], load: float
) -> None:
    mesh = make()
    start = shapes.crumpled(mesh, 1e-3)
    cg, exact = (solve(solver, mesh, start, load) for solver in (name, "newton"))
    for result in (cg, exact):
        assert result.status is equilibria.verdict(result.shape.x_loop)
        assert result.load == load
        assert result.residual <= RESIDUAL_TOLERANCE
        assert result.length_error <= LENGTH_TOLERANCE
    assert cg.energy == pytest.approx(exact.energy, rel=1e-8)
    # The energy is quadratic about a minimum: 1e-8 of it is 1e-4 of the shape.
    assert equilibria.distance_up_to_motion(cg.shape.x, exact.shape.x) < 1e-4
    tension = np.abs(exact.tensions).max()
    np.testing.assert_allclose(cg.tensions, exact.tensions, atol=1e-2 * tension)


# Before the plane buckles, a two-lobed film, a longer one: loops of even edges, for which
# sliding along themselves changes nothing.
@pytest.mark.parametrize(
    ("name", "load", "plane"),
    [
        *(("cg", load, plane) for load in (1000.0, 1700.0) for plane in (False, True)),
        ("cg-plain", 1000.0, True),
    ],
)
def test_solvers_reach_the_same_soap_film(name: str, load: float, plane: bool) -> None:
    mesh = shapes.mesh_of(*shapes.disk_points(5))
    problem = Problem(mesh, "area", in_plane=plane)
    start = shapes.crumpled(mesh, 1e-3) * [1.2, 0.8, 1.0]
    cg, exact = (
        solving.solve(problem, load, start, solver=solver) for solver in (name, "newton")
    )
    for found in (cg, exact):
        assert found.status is equilibria.verdict(found.shape.x_loop)
        assert found.residual <= RESIDUAL_TOLERANCE
        assert found.length_error <= LENGTH_TOLERANCE
        tiling = area(mesh).tiling(found.shape.triangles)
        assert tiling.sides(found.shape.x).smallest_angle > 12
    assert cg.energy == pytest.approx(exact.energy, rel=1e-8)


@pytest.mark.parametrize("plane", [False, True])
def test_uneven_loop_of_a_soap_film_ends_where_its_sliding_was_left(plane: bool) -> None:
    """Sliding costs what the edges differ by, an error of the mesh: it is not searched."""
    mesh = irregular()
    problem = Problem(mesh, "area", in_plane=plane)
    start = shapes.crumpled(mesh, 1e-3)
    exact, cg = (
        solving.solve(problem, 1000.0, start, solver=solver) for solver in ("newton", "cg")
    )
    assert cg.converged
    assert cg.energy == pytest.approx(exact.energy, rel=1e-6)
    gap = equilibria.distance_up_to_motion(cg.shape.x_loop, exact.shape.x_loop)
    assert gap < 1e-3


def test_accepted_state_is_what_its_record_says(
    coarse: Disk, coarse_problem: Problem
) -> None:
    found = solve("cg", coarse, shapes.crumpled(coarse, 1e-3), 900.0)
    film = coarse_problem.film.energy_gradient(found.shape, 900.0)[0]
    bending = coarse_problem.bending_energy(found.shape)[0]
    assert found.energy == pytest.approx(film + bending, rel=1e-14)
    assert found.residual == coarse_problem.residual(found.shape, found.tensions, 900.0)
    assert found.length_error == coarse_problem.length_error(found.shape)
    assert (found.n_unstable, found.lowest_eigenvalue) == (None, None)
    assert found.iterations > 0
    assert found.seconds > 0


def test_kick_makes_it_leave_a_saddle(oval_problem: Problem) -> None:
    """From the planar equilibrium beyond the onset, in balance to rounding."""
    load = 1000.0
    flat = equilibria.planar(oval_problem, [300.0, load])[-1]
    shape = equilibria.spanned(oval_problem, flat.x)
    saddle = oval_problem.equilibrium(shape, flat.tensions, load, Status.CONVERGED)
    assert saddle.residual < RESIDUAL_TOLERANCE
    found = solving.solve(oval_problem, load, saddle, solver="cg")
    assert found.status is Status.CONVERGED
    assert found.energy < saddle.energy * (1 - 1e-4)
    assert np.ptp(found.shape.x[:, 2]) > 0.01
    lowest = solving.solve(oval_problem, load, found)
    assert found.energy == pytest.approx(lowest.energy, rel=1e-8)


@pytest.mark.parametrize("confirmed", [False, True])
def test_kicks_that_are_not_confirmed_give_a_saddle(
    coarse_problem: Problem, monkeypatch: pytest.MonkeyPatch, confirmed: bool
) -> None:
    """Each of five kicks leads lower, or only the first four do."""
    energies = [40.0, 39.0, 38.0, 37.0, 36.0, 36.0 if confirmed else 35.0]
    minimum = solving.solve(coarse_problem, 300.0)
    left = iter([replace(minimum, energy=e, iterations=10) for e in energies])
    monkeypatch.setattr(conjugate_gradient, "descend", lambda *arguments: next(left))
    found = solving.solve(coarse_problem, 300.0, solver="cg")
    assert found.status is (Status.CONVERGED if confirmed else Status.SADDLE)
    assert (found.energy, found.iterations) == (energies[-1], 60)
    assert next(left, None) is None


def test_restart_from_newtons_minimum_stays_there(
    oval: Disk, oval_problem: Problem
) -> None:
    start = solve("newton", oval, shapes.crumpled(oval, 1e-3), 900.0)
    found = solving.solve(oval_problem, 900.0, start, solver="cg")
    assert found.status is Status.CONVERGED
    assert found.energy == pytest.approx(start.energy, rel=1e-8)


@pytest.mark.parametrize("name", ["cg", "cg-plain"])
@pytest.mark.parametrize("limit", [1, 50])
def test_iteration_limit_is_a_status_and_not_an_exception(
    coarse: Disk, coarse_problem: Problem, limit: int, name: str
) -> None:
    start = shapes.crumpled(coarse, 1e-3)
    found = solving.solve(coarse_problem, 900.0, start, solver=name, max_iterations=limit)
    assert found.status is Status.ITERATION_LIMIT
    assert not found.converged
    assert found.iterations >= limit
    assert np.isfinite(found.shape.x).all()


@pytest.mark.parametrize("bad", [np.nan, 1e200])
def test_overflow_is_a_status_and_not_an_exception(
    coarse: Disk, coarse_problem: Problem, bad: float
) -> None:
    x = coarse.x.copy()
    x[3, 2] = bad
    with np.errstate(over="ignore", invalid="ignore"):
        found = solving.solve(coarse_problem, 900.0, x, solver="cg")
    assert found.status is Status.NOT_FINITE


def test_two_solves_are_the_same_bit_for_bit(coarse: Disk) -> None:
    start = shapes.crumpled(coarse, 1e-3)
    one, two = (solve("cg", coarse, start, 900.0) for _ in range(2))
    np.testing.assert_array_equal(one.shape.x, two.shape.x)
    assert one.iterations == two.iterations


def test_kick_is_transverse_smooth_and_a_thousandth_of_the_length(oval: Disk) -> None:
    turn = shapes.rotation()
    x = oval.x @ turn.T
    kick = smooth_kick(x[oval.loop], x, np.random.default_rng(0), 2)
    assert np.linalg.norm(kick, axis=1).max() == pytest.approx(1e-3)
    normal = turn @ [0.0, 0.0, 1.0]
    np.testing.assert_allclose(np.cross(kick, normal), 0, atol=1e-15)
    # Smooth: two kicks agree in nothing, but neighbours differ by little.
    i, j = oval.edges.T
    assert np.linalg.norm(kick[i] - kick[j], axis=1).max() < 0.7e-3
    again = smooth_kick(x[oval.loop], x, np.random.default_rng(1), 2)
    assert np.abs(again - kick).max() > 1e-4


@pytest.mark.parametrize("name", ["cg", pytest.param("cg-plain", marks=pytest.mark.slow)])
def test_loop_that_its_mesh_cannot_carry_is_given_up_soon(name: str) -> None:
    """Newton's minimum turns by over 30 degrees, and so does the way there."""
    problem = Problem(shapes.mesh_of(*shapes.disk_points(3)))
    assert solving.solve(problem, 900.0).status is Status.UNRESOLVED
    found = solving.solve(problem, 900.0, solver=name)
    assert found.status is Status.UNRESOLVED
    assert found.iterations <= 50_000


@pytest.mark.slow
@pytest.mark.parametrize(
    "finest", [16, pytest.param(40, marks=pytest.mark.slow)], ids=["817", "4921"]
)
def test_iterations_grow_no_faster_than_the_root_of_the_number_of_vertices(
    finest: int,
) -> None:
    sizes, iterations = [], []
    for rings in (4, 8, finest):
        points, triangles = shapes.disk_points(rings, jitter=0.2)
        mesh = shapes.mesh_of(points * [1.5, 1.0], triangles)
        found = solve("cg", mesh, shapes.crumpled(mesh, 1e-3), 700.0)
        assert found.status is Status.CONVERGED
        sizes.append(mesh.n_v)
        iterations.append(found.iterations)
    assert np.polyfit(np.log(sizes), np.log(iterations), 1)[0] < 0.5


@pytest.mark.slow
@pytest.mark.parametrize("vertices", [7500, 50_000])
def test_lengths_of_fine_loops_are_held_no_faster_than_rounding_bears(
    vertices: int,
) -> None:
    """Of 324 and 844 edges: held faster, rounding alone would be too large a force."""
    polygon = {"kind": "stretched-hexagon", "factor": 2.0}
    mesh = generate(validate({"polygon": polygon, "vertices": vertices}, MeshSpec, "mesh"))
    problem = Problem(mesh)
    found = solving.solve(problem, 700.0, displaced(mesh, 1e-3, 1), solver="cg")
    assert found.status is Status.CONVERGED
    assert found.residual <= conjugate_gradient.CONDITIONED.residual
    assert found.iterations < 1000
    exact = solving.solve(problem, 700.0, found)
    assert found.energy == pytest.approx(exact.energy, rel=1e-8)


@pytest.mark.parametrize(
    ("away", "status"), [(1e5, Status.CONVERGED), (1e8, Status.STALLED)]
)
def test_where_rounding_leaves_forces_too_large_it_stalls_and_does_not_go_on(
    coarse: Disk, coarse_problem: Problem, away: float, status: Status
) -> None:
    """Far from the origin: lengths are rounded by more than they may be wrong, or less."""
    start = shapes.crumpled(coarse, 1e-3) + away
    found = solving.solve(coarse_problem, 300.0, start, solver="cg")
    assert found.status is status
    assert (found.length_error <= LENGTH_TOLERANCE) == found.converged
    assert found.iterations < 500
    exact = solving.solve(coarse_problem, 300.0)
    excess = coarse_problem.loop.constraint(found.shape.x_loop)
    unstretched = found.energy + found.tensions @ excess  # to first order
    assert unstretched == pytest.approx(exact.energy, rel=1e-8)


def test_kick_is_no_rigid_motion_it_bends_the_middle_of_the_film(oval: Disk) -> None:
    """A polynomial of degree two or more: at the centre it and its slope vanish."""
    x_loop = oval.x[oval.loop]
    away = np.array([[0.6, 0.8, 0.0], [0.8, -0.6, 0.0]])
    near = [x_loop.mean(axis=0) + size * away for size in (0.0, 1e-4, 2e-4)]
    x = np.vstack([*near, x_loop])
    kick = smooth_kick(x_loop, x, np.random.default_rng(0), 2)[:, 2]
    np.testing.assert_allclose(kick[:2], 0, atol=1e-18)
    np.testing.assert_allclose(kick[4:6] / kick[2:4], 4, rtol=0.05)


# Before and past each transition, and where a hexagon's saddle turns almost for nothing.
@pytest.mark.slow
@pytest.mark.parametrize(
    ("disk", "load"),
    [
        *(
            ("elongated", load)
            for load in (1.0, 300.0, 720.0, 1000.0, 1500.0, 2200.0, 3000.0)
        ),
        *(
            ("hexagon", load)
            for load in (1.0, 800.0, 860.0, 900.0, 1100.0, 1500.0, 2000.0, 3000.0)
        ),
    ],
)
def test_on_the_papers_meshes_it_finds_a_minimum_of_newtons_to_1e_8(
    disk: str, load: float, request: pytest.FixtureRequest
) -> None:
    mesh = request.getfixturevalue(disk)
    problem = Problem(mesh)
    found = solving.solve(problem, load, shapes.crumpled(mesh, 1e-3), solver="cg")
    assert found.status is Status.CONVERGED
    assert found.iterations < 2500
    exact = solving.solve(problem, load, found)
    assert exact.is_minimum
    assert found.energy == pytest.approx(exact.energy, rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["cg", "cg-plain"])
@pytest.mark.parametrize("load", [300.0, 720.0, 1000.0])
def test_solvers_agree_on_the_papers_mesh(elongated: Disk, load: float, name: str) -> None:
    start = shapes.crumpled(elongated, 1e-3)
    cg, exact = (solve(solver, elongated, start, load) for solver in (name, "newton"))
    assert cg.status is Status.CONVERGED
    assert cg.energy == pytest.approx(exact.energy, rel=1e-8)
    assert equilibria.distance_up_to_motion(cg.shape.x, exact.shape.x) < 1e-3
