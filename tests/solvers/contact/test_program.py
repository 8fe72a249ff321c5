"""The quadratic program of a step: its optimality conditions, on random ones."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import nnls

from eulerplateau.solvers.contact.program import Program, least_forces

M, K = 30, 8


def program(seed: int, lowest: float) -> Program:
    """A random one with gaps that are open or closed, H's least eigenvalue as given."""
    rng = np.random.default_rng(seed)
    vectors, _ = np.linalg.qr(rng.normal(size=(M, M)))
    values = np.concatenate([[lowest], rng.uniform(1.0, 100.0, M - 1)])
    closed = rng.uniform(size=K) < 0.4
    return Program(
        gradient=rng.normal(size=M),
        hessian=vectors * values @ vectors.T,
        widths=np.where(closed, 0.0, rng.uniform(0.0, 0.02, K)),
        rows=rng.normal(size=(K, M)),
        closed=closed,
    )


@pytest.mark.parametrize("seed", range(20))
def test_a_step_that_fits_is_the_least_on_which_nothing_overlaps(seed: int) -> None:
    given = program(seed, 0.5)
    found = given.step(np.inf)
    assert found is not None
    step, closes = found
    widths = given.widths + given.rows @ step
    assert widths.min() > -1e-12
    np.testing.assert_allclose(widths[closes], 0.0, atol=1e-12)
    pull = given.gradient + given.hessian @ step
    pushes, *_ = np.linalg.lstsq(given.rows[closes].T, pull, rcond=None)
    np.testing.assert_allclose(given.rows[closes].T @ pushes, pull, atol=1e-10)
    assert pushes.min(initial=1.0) > 0.0


@pytest.mark.parametrize("radius", [1e-3, 0.1])
@pytest.mark.parametrize("lowest", [0.5, -20.0])
@pytest.mark.parametrize("seed", range(5))
def test_a_step_cut_short_fits_lets_nothing_overlap_and_leads_down(
    seed: int, lowest: float, radius: float
) -> None:
    given = program(seed, lowest)
    found = given.step(radius)
    assert found is not None
    step, _ = found
    assert np.linalg.norm(step) <= radius
    # H is nearly singular, shifted, where the gradient hardly sees its least mode.
    assert (given.widths + given.rows @ step).min() > -1e-6 * radius
    assert given.gradient @ step + 0.5 * step @ given.hessian @ step < 0.0


@pytest.mark.parametrize("seed", range(10))
def test_forces_of_places_that_lie_side_by_side_are_those_of_least_squares(
    seed: int,
) -> None:
    """G is singular: every place has another that is moved by the same forces."""
    rng = np.random.default_rng(seed)
    half = rng.normal(size=(K, K // 2))
    moves = np.hstack([half, half])
    wanted = rng.normal(size=K)
    forces = least_forces(moves.T @ moves, -moves.T @ wanted)
    assert forces.min() >= 0.0
    assert (forces > 0.0).sum() <= K // 2
    expected = moves @ nnls(moves, wanted)[0]
    np.testing.assert_allclose(moves @ forces, expected, atol=1e-9)
