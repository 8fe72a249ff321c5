"""The compiled solver of the lengths against dense matrices, in the plane and in space."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.lengths import jacobian
from eulerplateau.loop.loop import Loop
from eulerplateau.loop.motions import orthonormal_motions, rigid_motions, sliding
from eulerplateau.loop.slide_kernels import (
    SLIDES,
    balance,
    keep_lengths,
    solve_lengths,
)
from eulerplateau.loop.turns import length_metric

CASES = [(n, d) for n in (3, 4, 5, 60) for d in (2, 3)]


def rough(n: int, d: int) -> tuple[Loop, FloatArray]:
    """A loop that is far from keeping its uneven lengths."""
    rng = np.random.default_rng(10 * n + d)
    return Loop(rng.uniform(0.5, 1.5, n) / n), rng.standard_normal((n, d))


def dense(loop: Loop, x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return J (n, d n), M (d n,) and J M^-1 J^T (n, n)."""
    rows, mass = jacobian(loop, x), np.repeat(loop.mean_lengths, x.shape[1])
    return rows, mass, rows / mass @ rows.T


def directions(loop: Loop, x: FloatArray) -> FloatArray:
    return loop.chords(x) / loop.rest_lengths[:, None]


@pytest.mark.parametrize(("n", "d"), CASES)
def test_lengths_are_solved_for_as_by_the_dense_matrix(n: int, d: int) -> None:
    loop, x = rough(n, d)
    matrix = dense(loop, x)[2]
    rhs = np.random.default_rng(0).standard_normal((n, 3))
    exact = np.linalg.solve(matrix, rhs)
    close = {"rtol": 1e-9, "atol": 1e-9 * float(np.abs(exact).max())}
    metric = length_metric(loop, x)
    np.testing.assert_allclose(metric.solve(rhs), exact, **close)
    np.testing.assert_allclose(metric.solve(rhs[:, 1]), exact[:, 1], **close)
    found = rhs[:, 2].copy()
    assert solve_lengths(directions(loop, x), loop.mean_lengths, found)
    np.testing.assert_allclose(found, exact[:, 2], **close)


@pytest.mark.parametrize(("n", "d"), CASES)
def test_field_that_keeps_lengths_is_the_nearest(n: int, d: int) -> None:
    loop, x = rough(n, d)
    rows, mass, matrix = dense(loop, x)
    field = np.random.default_rng(1).standard_normal((n, d))
    kept = field.copy()
    assert keep_lengths(directions(loop, x), loop.mean_lengths, kept)
    exact = field.ravel() - rows.T @ np.linalg.solve(matrix, rows @ field.ravel()) / mass
    np.testing.assert_allclose(kept.ravel(), exact, atol=1e-9 * np.abs(field).max())


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("edge", [0, 7, 11])
def test_an_edge_without_length_is_told(d: int, edge: int) -> None:
    loop, x = rough(12, d)
    x[(edge + 1) % 12] = x[edge]
    assert not solve_lengths(directions(loop, x), loop.mean_lengths, np.ones(12))
    with pytest.raises(LinAlgError, match="no length"):
        length_metric(loop, x).solve(np.ones(12))
    with np.errstate(invalid="ignore"), pytest.raises(LinAlgError, match="no length"):
        sliding(loop, x)


@pytest.mark.parametrize("d", [2, 3])
def test_sliding_is_the_tangent_without_what_stretches_and_turns(d: int) -> None:
    n = 40
    turns = 2 * np.pi * np.arange(n) / n
    x = np.stack([2 * np.cos(turns), np.sin(turns), np.cos(2 * turns)], axis=1)[:, :d]
    lengths = np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1)
    loop = Loop(lengths)
    rows, mass, _ = dense(loop, x)
    units = loop.chords(x) / lengths[:, None]
    root = np.sqrt(mass)
    tangent = (units + np.roll(units, 1, axis=0)).ravel() * root
    held = np.vstack([rows / root, (rigid_motions(x) * root[:, None]).T])
    left = tangent - held.T @ np.linalg.lstsq(held.T, tangent)[0]
    size = float(np.linalg.norm(left))
    assert size > SLIDES * np.linalg.norm(tangent)
    slide = sliding(loop, x)
    assert slide is not None
    np.testing.assert_allclose(slide.ravel() * root, left / size, atol=1e-10)


def bent_ellipse(d: int, n: int = 40) -> tuple[Loop, FloatArray]:
    """A loop that keeps its uneven lengths and is no circle."""
    turns = 2 * np.pi * np.arange(n) / n
    x = np.stack([2 * np.cos(turns), np.sin(turns), np.cos(2 * turns)], axis=1)[:, :d]
    return Loop(np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1)), x


@pytest.mark.parametrize(("d", "rigid"), [(2, 3), (3, 6)])
def test_motions_that_cost_nothing_are_rigid_ones_and_one_more_that_keeps_lengths(
    d: int, rigid: int
) -> None:
    loop, x = bent_ellipse(d)
    rows, mass, _ = dense(loop, x)
    motions = orthonormal_motions(loop, x).reshape(-1, x.size)
    assert len(motions) == rigid + 1
    np.testing.assert_allclose(motions * mass @ motions.T, np.eye(rigid + 1), atol=1e-13)
    np.testing.assert_allclose(rows @ motions.T, 0, atol=1e-13)
    root = np.sqrt(mass)
    spanned = np.linalg.qr(rigid_motions(x) * root[:, None])[0]
    inside = spanned.T @ (motions[:rigid] * root).T
    np.testing.assert_allclose(inside.T @ inside, np.eye(rigid), atol=1e-13)
    # A circle only turns.
    turns = 2 * np.pi * np.arange(12) / 12
    circle = np.pad(np.stack([np.cos(turns), np.sin(turns)], axis=1), ((0, 0), (0, d - 2)))
    even = Loop(np.full(12, 2 * np.sin(np.pi / 12)))
    assert len(orthonormal_motions(even, circle)) == rigid


@pytest.mark.parametrize("d", [2, 3])
def test_tensions_leave_least_of_a_force_and_nothing_along_motions(d: int) -> None:
    loop, x = bent_ellipse(d)
    rows, mass, _ = dense(loop, x)
    motions = orthonormal_motions(loop, x)
    force = np.random.default_rng(3).standard_normal(x.shape)
    tensions, left = np.empty(len(x)), np.empty_like(x)
    units, means = directions(loop, x), loop.mean_lengths
    largest = balance(units, means, motions, force, tensions, left)
    # Of linear least squares in the norm of M^-1, with both kinds of unknowns at once.
    root = np.sqrt(mass)
    free = motions.reshape(len(motions), -1).T * mass[:, None]
    columns = np.hstack([rows.T, free]) / root[:, None]
    shares = np.linalg.lstsq(columns, -force.ravel() / root)[0]
    np.testing.assert_allclose(tensions, shares[: len(x)], atol=1e-10)
    rest = force.ravel() + np.hstack([rows.T, free]) @ shares
    np.testing.assert_allclose(left.ravel(), rest, atol=1e-10)
    assert largest == pytest.approx(np.abs(rows.T @ tensions).max(), rel=1e-9)
