"""The constraint of sides with equal edges: its derivatives and its projection."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import EqualEdges, edges_of
from tests.helpers.polygons import order, uneven

SIDES, M = 4, 6
N = SIDES * M
EQUAL = EqualEdges(M)
RNG = np.random.default_rng(11)
STEP = RNG.uniform(-1, 1, (N, 2))
TENSIONS = RNG.standard_normal(N - SIDES)


def sides(size: float) -> FloatArray:
    """A wavy loop (n, 2) whose edges are equal but for `size` times a random move."""
    angle = 2 * np.pi * np.arange(N) / N
    wave = 1 + 0.2 * np.cos(3 * angle + 1)
    return wave[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]) + size * STEP


def projected(x: FloatArray) -> FloatArray:
    found = EQUAL.project(x)
    assert found is not None
    return found


def test_jacobian_force_and_stiffness_are_derivatives() -> None:
    x = uneven(N, 8)
    rows = EQUAL.jacobian(x)
    np.testing.assert_allclose(
        EQUAL.force(x, TENSIONS).ravel(), TENSIONS @ rows, atol=1e-14
    )
    stiffness = EQUAL.stiffness(x, TENSIONS)
    np.testing.assert_allclose(stiffness, stiffness.T, atol=1e-14)
    sizes = [1e-2, 5e-3, 2.5e-3]
    first, second = [], []
    for h in sizes:
        ahead, behind = x + h * STEP, x - h * STEP
        change = (EQUAL.excess(ahead) - EQUAL.excess(behind)).ravel() / (2 * h)
        first.append(np.abs(change - rows @ STEP.ravel()).max())
        pull = (EQUAL.force(ahead, TENSIONS) - EQUAL.force(behind, TENSIONS)) / (2 * h)
        second.append(np.abs(pull.ravel() - stiffness @ STEP.ravel()).max())
    assert order(sizes, first) == pytest.approx(2, abs=0.1)
    assert order(sizes, second) == pytest.approx(2, abs=0.1)


@pytest.mark.parametrize("size", [0.0, 1e-8, 1e-3, 0.03])
def test_projection_makes_edges_equal_to_rounding_and_holds_the_ends(size: float) -> None:
    x = sides(size)
    found = projected(x)
    assert np.abs(EQUAL.excess(found)).max() < 1e-14
    np.testing.assert_array_equal(found[::M], x[::M])


def test_each_side_keeps_a_length_of_its_own() -> None:
    x = projected(sides(0.0))
    lengths = edges_of(x).lengths.reshape(SIDES, M)
    assert np.ptp(lengths[:, 0]) > 0.01


def test_projection_moves_a_tangent_step_by_its_square() -> None:
    x = projected(sides(0.0))
    rows = EQUAL.jacobian(x)
    along = STEP.ravel() - rows.T @ np.linalg.solve(rows @ rows.T, rows @ STEP.ravel())
    step = along.reshape(-1, 2)
    sizes = [0.04, 0.02, 0.01]
    moved = [float(np.abs(projected(x + h * step) - x - h * step).max()) for h in sizes]
    assert order(sizes, moved) == pytest.approx(2, abs=0.15)


def test_long_sides_are_projected_to_rounding() -> None:
    m = 256
    angle = np.linspace(0, 2 * np.pi, 2 * m, endpoint=False) ** 1.02
    x = np.column_stack([np.cos(angle), 0.5 * np.sin(angle)])
    found = EqualEdges(m).project(x)
    assert found is not None
    assert np.abs(EqualEdges(m).excess(found)).max() < 1e-14


def test_a_loop_that_is_no_loop_is_lost() -> None:
    assert EQUAL.project(np.zeros((N, 2))) is None
    assert EQUAL.project(np.full((N, 2), np.nan)) is None
