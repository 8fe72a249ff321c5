"""Branches: every point an equilibrium, every direction a tangent, whatever the step."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import islice, pairwise, takewhile

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.continuation import advance, follow
from eulerplateau.branches.point import BranchPoint, along, correct, inner, parameter_slope
from eulerplateau.branches.symmetry import loop_distance
from eulerplateau.solvers import solve
from tests.helpers import diagram
from tests.helpers.diagram import CONTROL, Diagram
from tests.helpers.marks import quick_with
from tests.helpers.shapes import fitted_order

# Far enough to rise above rounding, near enough for the leading order.
STEPS = [1e-3, 2e-3, 4e-3, 8e-3]


@pytest.fixture(scope="module")
def found() -> Diagram:
    return diagram.elongated()


@pytest.fixture(scope="module")
def some(found: Diagram) -> list[BranchPoint]:
    """A regular point of every branch, stable or not, planar or not."""
    numbers = sorted({visit.branch for visit in found.visits})
    branches = [diagram.regular(found.branch(number)) for number in numbers]
    return [branch[len(branch) // 2] for branch in branches]


def test_every_point_is_an_equilibrium_on_the_whole_mesh(found: Diagram) -> None:
    for visit in found.visits:
        shape, point = found.shape(visit.point), visit.point
        assert found.problem.length_error(shape) < 1e-12
        forces = found.problem.residual(shape, point.model.tensions, point.value)
        assert forces < 1e-9


def test_directions_solve_the_linearised_equations(some: list[BranchPoint]) -> None:
    """H p + b l' = 0, of unit arclength."""
    for point in some:
        p = point.direction.displacement.ravel() * point.model.scale
        bent = point.model.hessian @ (point.model.basis.T @ p)
        slope = parameter_slope(point.family, point.energy, point.model)
        pulled = slope * point.direction.rate
        assert np.abs(bent + pulled).max() < 1e-8 * np.abs(pulled).max()
        assert p @ p + (point.direction.rate / CONTROL.unit) ** 2 == pytest.approx(1.0)


def test_directions_are_tangents(some: list[BranchPoint]) -> None:
    """A point at arclength h lies h along the direction, to second order in h."""
    for point in some:
        gaps = []
        for step in STEPS:
            after = advance(point, step, CONTROL)
            assert after is not None
            gap = after.x - point.x - step * point.direction.displacement
            gaps.append(float(np.linalg.norm(gap)))
            assert along(point, after, CONTROL) == pytest.approx(step)
        if point.direction.rate < 0.999 * CONTROL.unit:
            assert fitted_order(STEPS, gaps) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("part", quick_with([1.0], [1.0, 0.5]))
def test_steps_of_any_length_give_minima_that_newton_confirms(
    found: Diagram, part: float
) -> None:
    """The planar branch up to its onset and the twisted branch from end to end."""
    control = replace(
        CONTROL,
        first_step=part * CONTROL.first_step,
        largest_step=part * CONTROL.largest_step,
    )
    for number, last in ((0, 650.0), (1, 750.0)):
        start = found.branch(number)[0].point
        points = follow(start, control)
        before = list(takewhile(partial(is_below, last), points))
        assert len(before) >= 5
        for point in before:
            assert found.energy(point) == pytest.approx(
                newton_energy(found, point), rel=1e-12
            )


def is_below(load: float, point: BranchPoint) -> bool:
    return point.value < load


def newton_energy(found: Diagram, near: BranchPoint) -> float:
    noise = np.random.default_rng(3).standard_normal(found.mesh.x.shape)
    start = found.shape(near).x + 1e-4 * noise
    solved = solve(found.problem, near.value, start)
    assert solved.converged
    return solved.energy


def test_branches_end_outside_the_window_or_where_told(found: Diagram) -> None:
    start = found.branch(0)[0].point
    narrow = replace(CONTROL, window=(1.0, 300.0))
    loads = [point.value for point in follow(start, narrow)]
    assert loads == sorted(loads)
    assert all(load <= 300.0 for load in loads[:-1])
    assert loads[-1] > 300.0
    few = replace(CONTROL, max_points=3)
    assert len(list(follow(start, few))) == 3
    stopped = list(follow(start, CONTROL, lambda at: at.value > 100.0))
    assert [point.value > 100.0 for point in stopped[-2:]] == [False, True]


def test_reversed_branch_is_the_same_branch(found: Diagram) -> None:
    """There and back: the same load and the same loop."""
    start = diagram.regular(found.branch(1))[4]
    there = advance(start, 5e-3, CONTROL)
    assert there is not None
    turned = replace(there, direction=there.direction.reversed())
    reach = along(turned, start, CONTROL)
    back = advance(turned, reach, CONTROL)
    assert back is not None
    assert back.value == pytest.approx(start.value, rel=1e-10)
    assert loop_distance(back.x, start.x) < 1e-8


def test_arclength_grows_by_the_distance_gone(found: Diagram) -> None:
    for before, after in pairwise(diagram.regular(found.branch(1))):
        moved = along(before, after, CONTROL)
        assert after.arclength - before.arclength == pytest.approx(moved, rel=1e-6)


def test_folds_are_passed() -> None:
    """The load falls, turns and rises; the shape goes on changing the same way."""
    points = list(folding())
    rates = np.array([point.direction.rate for point in points])
    assert (rates[0] < 0) & (rates[-1] > 0)
    assert np.sum(np.diff(np.sign(rates)) != 0) == 1
    lengths = [longest_extent(point.x) for point in points]
    turn = int(np.argmin([point.value for point in points]))
    around = lengths[turn - 3 : turn + 4]
    assert around == sorted(around)
    # Two equilibria of one load, one from each side of the fold.
    low, high = points[turn].value, min(points[0].value, points[-1].value)
    assert low < high


def folding() -> Iterator[BranchPoint]:
    _, start, control = diagram.folding_branch()
    return islice(follow(start, control), 20)


def longest_extent(x: FloatArray) -> float:
    return float(np.ptp(x, axis=0).max())


def test_no_step_where_there_is_no_branch(found: Diagram) -> None:
    """An arclength far beyond the film's size is refused, and no NaN comes back."""
    start = found.branch(0)[0].point
    for step in (50.0, -50.0):
        assert advance(start, step, CONTROL) is None


@pytest.mark.slow
def test_branch_turns_by_no_more_than_37_degrees_from_point_to_point() -> None:
    """A step round a fold that turns farther is refused, though it can be corrected."""
    _, start, control = diagram.folding_branch()
    point = advance(start, 0.1, control)
    assert point is not None
    ahead = []
    for step in np.linspace(0.005, 0.03, 6):
        guess = point.x + step * point.direction.displacement
        value = point.value + step * point.direction.rate
        after = correct(point.family, guess, value, point.direction, control)
        if after is None:
            continue
        ahead.append(inner(after.model, point.direction, after.direction, control))
        assert (advance(point, step, control) is None) == (ahead[-1] < 0.8)
    assert min(ahead) < 0.8 < max(ahead)
