"""From load to load: what each solve of a sweep starts from, by solvers that pretend."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Equilibrium, Problem, Status, solving, sweep

Starts = list[tuple[Shape, FloatArray | None]]


@pytest.fixture
def pretend(monkeypatch: pytest.MonkeyPatch) -> Callable[[list[Status]], Starts]:
    """Have a solver move every film by its load and end as told; what it starts from.

    Where it is told NOT_FINITE, so is its shape.
    """

    def install(statuses: list[Status]) -> Starts:
        starts: Starts = []

        def minimise(
            problem: Problem,
            load: float,
            start: Shape,
            tensions: FloatArray | None,
            max_iterations: int | None,
            observe: Callable[[FloatArray], None],
        ) -> Equilibrium:
            status = statuses[len(starts)]
            starts.append((start, tensions))
            pull = np.full(problem.disk.n_b, load)
            found = problem.equilibrium(start.moved(start.x + load), pull, load, status)
            if status is not Status.NOT_FINITE:
                return found
            return replace(found, shape=start.moved(np.full_like(start.x, np.nan)))

        monkeypatch.setattr(solving, "_named", lambda name: minimise)
        return starts

    return install


def test_every_load_starts_from_the_last_shape_and_the_last_tensions(
    oval: Disk, oval_problem: Problem, pretend: Callable[[list[Status]], Starts]
) -> None:
    starts = pretend(3 * [Status.CONVERGED])
    found = list(sweep(oval_problem, [3.0, 5.0, 4.0], oval.x))
    assert [result.load for result in found] == [3.0, 5.0, 4.0]
    np.testing.assert_array_equal(starts[0][0].x, oval.x)
    assert starts[0][1] is None
    for (shape, tensions), last in zip(starts[1:], found, strict=False):
        assert shape is last.shape
        assert tensions is last.tensions


def test_shape_that_is_not_finite_is_recorded_and_not_started_from(
    oval: Disk, oval_problem: Problem, pretend: Callable[[list[Status]], Starts]
) -> None:
    statuses = [Status.CONVERGED, Status.NOT_FINITE, Status.CONVERGED]
    starts = pretend(statuses)
    found = list(sweep(oval_problem, [1.0, 2.0, 3.0], oval.x))
    assert [result.status for result in found] == statuses
    assert starts[2][0] is starts[1][0] is found[0].shape
    assert starts[2][1] is starts[1][1] is found[0].tensions


def test_next_start_is_the_last_finite_shape_converged_or_not(
    oval: Disk, oval_problem: Problem, pretend: Callable[[list[Status]], Starts]
) -> None:
    """STALLED is a shape to go on from; one that is not finite is none."""
    statuses = [
        Status.CONVERGED, Status.STALLED, Status.NOT_FINITE, Status.NOT_FINITE,
        Status.CONVERGED,
    ]  # fmt: skip
    starts = pretend(statuses)
    found = list(sweep(oval_problem, [1.0, 2.0, 3.0, 4.0, 5.0], oval.x))
    assert [result.status for result in found] == statuses
    for shape, tensions in starts[2:]:
        assert shape is found[1].shape
        assert tensions is found[1].tensions


def test_an_equilibrium_brings_its_tensions_along_and_a_shape_none(
    oval: Disk, oval_problem: Problem, pretend: Callable[[list[Status]], Starts]
) -> None:
    starts = pretend(5 * [Status.CONVERGED])
    found = solving.solve(oval_problem, 2.0, oval.x)
    solving.solve(oval_problem, 3.0, found)
    solving.solve(oval_problem, 3.0, found.shape)
    list(sweep(oval_problem, [3.0], found))
    solving.solve(oval_problem, 3.0, found, tensions=2 * found.tensions)
    told = [tensions for _, tensions in starts[1:]]
    assert told[0] is told[2] is found.tensions
    assert told[1] is None
    np.testing.assert_array_equal(told[3], 2 * found.tensions)
