"""Newton on the loop: always down, to a minimum, quadratically."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Equilibrium, Problem, Status, solving
from tests.helpers import equilibria, shapes


def solve(
    problem: Problem, x: FloatArray, load: float, max_iterations: int = 500
) -> Equilibrium:
    return solving.solve(problem, load, x, max_iterations=max_iterations)


def assert_minimum(found: Equilibrium) -> None:
    """Balanced, closed and stable, each by far within its tolerance."""
    assert found.status is equilibria.verdict(found.shape.x_loop)
    assert found.converged == (found.status is Status.CONVERGED)
    assert found.residual < 1e-9
    assert found.length_error < 1e-13
    assert found.n_unstable == 0
    assert found.lowest_eigenvalue is not None


@pytest.mark.parametrize("load", [0.0, 1.0, 300.0, 700.0, 900.0, 1600.0, 3000.0])
def test_random_starts_reach_a_minimum_at_every_load(
    oval: Disk, oval_problem: Problem, load: float
) -> None:
    for seed in range(3):
        noise = np.random.default_rng(seed).standard_normal(oval.x.shape)
        assert_minimum(solve(oval_problem, oval.x + 1e-2 * noise, load))


@pytest.mark.parametrize("size", [0.05, 0.3, 10.0])
def test_starts_that_look_nothing_like_the_mesh_reach_a_minimum(
    oval: Disk, oval_problem: Problem, size: float
) -> None:
    for seed in range(3):
        noise = np.random.default_rng(seed).standard_normal(oval.x.shape)
        assert_minimum(solve(oval_problem, size * noise, 900.0))


@pytest.mark.slow
@pytest.mark.parametrize("load", [1.0, 500.0, 853.0, 1500.0, 3000.0])
def test_a_hundred_random_starts_of_the_papers_size_reach_a_minimum(
    elongated: Disk, load: float
) -> None:
    problem = Problem(elongated)
    for seed in range(100):
        noise = np.random.default_rng(seed).standard_normal(elongated.x.shape)
        size = (1e-3, 1e-2, 0.1)[seed % 3]
        assert_minimum(solve(problem, elongated.x + size * noise, load))


def test_a_start_that_is_not_a_number_is_reported_and_not_raised(
    oval: Disk, oval_problem: Problem
) -> None:
    x = oval.x.copy()
    x[oval.loop[3], 1] = np.nan
    assert not solve(oval_problem, x, 700.0).converged


def test_a_start_that_is_a_point_is_reported_and_not_raised(
    oval: Disk, oval_problem: Problem
) -> None:
    found = solve(oval_problem, np.zeros_like(oval.x), 700.0)
    assert found.status is Status.STALLED


@pytest.mark.parametrize("load", [500.0, 900.0])
def test_iteration_ends_quadratically(
    oval: Disk, oval_problem: Problem, load: float
) -> None:
    """The residual after each of the last iterations goes with the square of the last."""
    start = shapes.crumpled(oval, 1e-3)
    found = solve(oval_problem, start, load)
    assert_minimum(found)
    total = found.iterations
    residuals = [
        solve(oval_problem, start, load, max_iterations=i).residual
        for i in range(max(1, total - 6), total)
    ]
    # Newton's method doubles the digits from when they are few until rounding ends it.
    orders = [
        np.log(after) / np.log(before)
        for before, after in pairwise(residuals)
        if before < 0.1 and after > 1e-11
    ]
    assert residuals[-1] < 1e-4
    assert orders
    assert orders[-1] > 1.6


def test_iteration_limit_is_a_status_and_keeps_the_best_shape(
    oval: Disk, oval_problem: Problem
) -> None:
    found = solve(oval_problem, shapes.crumpled(oval, 1e-2), 900.0, max_iterations=2)
    assert found.status is Status.ITERATION_LIMIT
    assert found.iterations == 2
    assert found.length_error < 1e-13
    assert np.isfinite(found.shape.x).all()


def test_energy_never_rises_from_one_iteration_to_the_next(
    oval: Disk, oval_problem: Problem
) -> None:
    start = shapes.crumpled(oval, 1e-2)
    energies = [
        solve(oval_problem, start, 1600.0, max_iterations=i).energy for i in range(1, 15)
    ]
    assert (np.diff(energies) <= 1e-12 * energies[-1]).all()


@pytest.mark.parametrize(("name", "load"), [("hexagon", 900.0), ("elongated", 720.0)])
def test_exactly_flat_start_beyond_the_onset_leaves_the_plane(
    request: pytest.FixtureRequest, name: str, load: float
) -> None:
    mesh: Disk = request.getfixturevalue(name)
    problem = Problem(mesh)
    assert (mesh.x[:, 2] == 0).all()
    found = solve(problem, mesh.x, load)
    assert_minimum(found)
    assert np.ptp(found.shape.x[:, 2]) > 0.01
    flat = equilibria.planar(problem, [500.0, load])[-1]
    planar = equilibria.spanned(problem, flat.x)
    energy = problem.film.energy_gradient(planar, load)[0]
    energy += problem.bending_energy(planar)[0]
    assert found.energy < energy * (1 - 1e-6)


@pytest.mark.parametrize("name", ["hexagon", "elongated"])
def test_exactly_flat_start_below_the_onset_stays_in_the_plane(
    request: pytest.FixtureRequest, name: str
) -> None:
    mesh: Disk = request.getfixturevalue(name)
    problem = Problem(mesh)
    found = solve(problem, mesh.x, 600.0)
    assert_minimum(found)
    assert np.abs(found.shape.x[:, 2]).max() < 1e-4


@pytest.mark.parametrize("load", [852.0, 853.0, 854.0, 858.0])
def test_a_saddle_that_turns_almost_for_free_does_not_stop_the_iteration(
    hexagon: Disk, load: float
) -> None:
    """Just beyond the onset the hexagon's saddle hardly feels in which direction it is."""
    problem = Problem(hexagon)
    found = solve(problem, shapes.crumpled(hexagon, 1e-3), load)
    assert_minimum(found)
    assert found.iterations < 100


def test_restart_from_a_minimum_stays_there(oval: Disk, oval_problem: Problem) -> None:
    first = solve(oval_problem, shapes.crumpled(oval, 1e-3), 900.0)
    assert first.status is Status.CONVERGED
    again = solve(oval_problem, first.shape.x, 900.0)
    assert again.iterations <= 1
    assert again.energy == pytest.approx(first.energy, rel=1e-12)
    assert np.abs(again.shape.x - first.shape.x).max() < 1e-7


def test_only_the_loop_of_the_start_matters(oval: Disk, oval_problem: Problem) -> None:
    start = shapes.crumpled(oval, 1e-3)
    other = start.copy()
    other[oval.interior] = 7.0
    one, two = (solve(oval_problem, x, 900.0) for x in (start, other))
    np.testing.assert_array_equal(one.shape.x, two.shape.x)


def test_a_moved_start_ends_in_the_moved_minimum(oval: Disk, oval_problem: Problem) -> None:
    start = shapes.crumpled(oval, 1e-3)
    moved = start @ shapes.rotation().T + [0.3, -0.2, 0.7]
    one, two = (solve(oval_problem, x, 900.0) for x in (start, moved))
    assert one.status is two.status is Status.CONVERGED
    assert two.energy == pytest.approx(one.energy, rel=1e-11)
    assert equilibria.distance_up_to_motion(one.shape.x, two.shape.x) < 1e-6


def test_slack_film_lets_the_loop_be_a_circle(oval: Disk, oval_problem: Problem) -> None:
    found = solve(oval_problem, shapes.crumpled(oval, 1e-3), 0.0)
    around = found.shape.x_loop
    assert found.status is Status.CONVERGED
    radii = np.linalg.norm(around - around.mean(axis=0), axis=1)
    assert found.film_energy == 0.0
    # On unequal edges the circle is not exactly the polygon's: 1/n_b^2 at n_b = 36.
    np.testing.assert_allclose(radii, 1 / (2 * np.pi), rtol=0.03)
    assert found.bending_energy == pytest.approx(4 * np.pi**2, rel=0.01)
