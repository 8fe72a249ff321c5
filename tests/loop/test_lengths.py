"""Projection onto the loops that keep their lengths."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.lengths import (
    close_with_lengths,
    jacobian,
    project_lengths,
    quickly_projected,
)
from eulerplateau.loop.loop import Loop
from eulerplateau.loop.turns import LengthMetric
from eulerplateau.mesh.disk import Disk
from tests.helpers import equilibria, shapes

RNG = np.random.default_rng(6)


@pytest.fixture
def loop(oval: Disk) -> Loop:
    return Loop(oval.rest_lengths)


@pytest.fixture
def bent(oval: Disk, loop: Loop) -> FloatArray:
    """A loop in space that keeps its lengths."""
    found = project_lengths(loop, shapes.crumpled(oval, 0.01)[oval.loop])
    assert found is not None
    return found


def weighted_norm(loop: Loop, step: FloatArray) -> float:
    return float(np.sqrt((loop.mean_lengths[:, None] * step**2).sum()))


def test_jacobian_is_the_derivative_of_the_constraint(loop: Loop, bent: FloatArray) -> None:
    rows, p = jacobian(loop, bent), RNG.standard_normal(bent.shape)
    # The constraint is quadratic: central differences are exact.
    difference = (loop.constraint(bent + 0.1 * p) - loop.constraint(bent - 0.1 * p)) / 0.2
    np.testing.assert_allclose(rows @ p.ravel(), difference, rtol=1e-9, atol=1e-11)
    lam = RNG.standard_normal(len(bent))
    force = loop.tension_force(bent, lam)
    np.testing.assert_allclose(lam @ rows, force.ravel(), atol=1e-12)


def test_projection_meets_the_lengths_to_rounding(oval: Disk, loop: Loop) -> None:
    for size in (1e-6, 1e-3, 1e-2):
        found = project_lengths(loop, shapes.crumpled(oval, size)[oval.loop])
        assert found is not None
        assert loop.length_error(found) < 1e-14


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("spread", [0.3, 0.9])
def test_projection_by_compiled_loops_is_the_same(d: int, spread: float) -> None:
    """Of even and of very uneven edges, in space and in a plane; none of no loop."""
    rng = np.random.default_rng(d)
    lengths = rng.uniform(1 - spread, 1 + spread, 40)
    loop = Loop(lengths / lengths.sum())
    turns = 2 * np.pi * np.cumsum(loop.rest_lengths)
    x = np.stack([np.cos(turns), np.sin(turns), np.sin(2 * turns)][:d], axis=1) / (
        2 * np.pi
    )
    for size in (1e-6, 1e-3, 1e-2):
        start = x + size * rng.standard_normal(x.shape)
        given, found = start.copy(), quickly_projected(loop, start)
        exact = project_lengths(loop, start)
        assert found is not None
        assert exact is not None
        assert (start == given).all()
        assert loop.length_error(found) < 1e-13
        np.testing.assert_allclose(found, exact, atol=1e-14)
    assert quickly_projected(loop, np.ones_like(x)) is None
    assert quickly_projected(loop, np.full_like(x, np.nan)) is None


def test_projection_leaves_a_loop_that_keeps_its_lengths_where_it_is(
    loop: Loop, bent: FloatArray
) -> None:
    found = project_lengths(loop, bent)
    assert found is not None
    assert np.abs(found - bent).max() < 1e-14


def test_projection_moves_in_proportion_to_the_violation_and_along_the_normals(
    loop: Loop, bent: FloatArray
) -> None:
    """Normals of the constraint in the norm of integral |dx|^2 ds: M^-1 J^T."""
    direction = RNG.standard_normal(bent.shape)
    normals = jacobian(loop, bent).T / np.repeat(loop.mean_lengths, 3)[:, None]
    sizes, along, aside = [1e-7, 1e-6, 1e-5], [], []
    for size in sizes:
        found = project_lengths(loop, bent + size * direction)
        assert found is not None
        move = (found - bent - size * direction).ravel()
        part = normals @ np.linalg.lstsq(normals, move, rcond=None)[0]
        along.append(float(np.linalg.norm(part)))
        aside.append(float(np.linalg.norm(move - part)))
    assert shapes.fitted_order(sizes, along) == pytest.approx(1.0, abs=0.01)
    assert shapes.fitted_order(sizes, aside) == pytest.approx(2.0, abs=0.05)


def test_projection_moves_a_tangent_displacement_at_second_order_only(
    loop: Loop, bent: FloatArray
) -> None:
    rows = jacobian(loop, bent)
    p = RNG.standard_normal(bent.size)
    p -= rows.T @ np.linalg.solve(rows @ rows.T, rows @ p)
    sizes = [1e-2, 3e-3, 1e-3, 3e-4]
    moves = []
    for size in sizes:
        start = bent + size * (p / np.linalg.norm(p)).reshape(-1, 3)
        found = project_lengths(loop, start)
        assert found is not None
        moves.append(weighted_norm(loop, found - start))
    assert shapes.fitted_order(sizes, moves) == pytest.approx(2.0, abs=0.05)


def test_projection_converges_quadratically(
    loop: Loop, bent: FloatArray, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Violations met on the way: each is bounded by a constant times the last squared."""
    met: list[float] = []
    original = LengthMetric.solve

    def watched(self: LengthMetric, excess: FloatArray) -> FloatArray:
        met.append(float(np.abs(excess / loop.rest_lengths).max()))
        return original(self, excess)

    monkeypatch.setattr(LengthMetric, "solve", watched)
    assert project_lengths(loop, bent + 1e-3 * RNG.standard_normal(bent.shape)) is not None
    far = [error for error in met if error > 1e-13]
    orders = np.log(far[1:]) / np.log(far[:-1])
    assert len(orders) >= 2
    assert (orders > 1.7).all()


def test_projection_of_a_loop_it_cannot_mend_is_none_and_no_exception(loop: Loop) -> None:
    n = len(loop.rest_lengths)
    for bad in (np.zeros((n, 3)), np.full((n, 3), np.nan), 1e200 * np.ones((n, 3))):
        assert project_lengths(loop, bad) is None


@pytest.mark.parametrize("seed", range(5))
def test_any_random_closed_loop_is_given_its_lengths(loop: Loop, seed: int) -> None:
    n = len(loop.rest_lengths)
    start = 0.1 * np.random.default_rng(seed).standard_normal((n, 3))
    found = close_with_lengths(loop, start)
    assert found is not None
    assert loop.length_error(found) < 1e-13


@pytest.mark.parametrize("scale", [1e-3, 0.5, 2.0, 1e3])
def test_a_loop_of_the_right_shape_and_the_wrong_size_keeps_its_shape(scale: float) -> None:
    loop, polygon = equilibria.ring(30)
    found = close_with_lengths(loop, scale * polygon + [5.0, 1.0, 2.0])
    assert found is not None
    assert loop.length_error(found) < 1e-13
    assert equilibria.distance_up_to_motion(found, polygon) < 1e-10
    np.testing.assert_allclose(found.mean(axis=0), [5.0, 1.0, 2.0], atol=1e-9)


def test_a_loop_that_is_a_point_has_no_directions_to_keep(loop: Loop) -> None:
    assert close_with_lengths(loop, np.ones((len(loop.rest_lengths), 3))) is None


def uneven(ratio: float) -> tuple[Loop, FloatArray]:
    """A ring in space, one edge of which is shorter than the others."""
    angle = 2 * np.pi * np.arange(24) / 24
    x = np.stack([np.cos(angle), np.sin(angle), 0.2 * np.sin(2 * angle)], axis=1)
    x[5] = x[4] + ratio * (x[5] - x[4])
    lengths = np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1)
    return Loop(lengths / lengths.sum()), x / lengths.sum()


@pytest.mark.parametrize("ratio", [0.1, 1e-2, 1e-4, 1e-6])
def test_wrong_lengths_next_to_a_short_edge_do_not_throw_it_about(ratio: float) -> None:
    """Lengths off by one per cent: no edge turns by more than about as much."""
    loop, x = uneven(ratio)
    off = 1 + 0.01 * RNG.uniform(-1, 1, (24, 1))
    moved = np.concatenate([np.zeros((1, 3)), np.cumsum(off * loop.chords(x), axis=0)[:-1]])
    given = loop.chords(moved)
    found = project_lengths(loop, moved)
    assert found is not None
    rounding = 1e-15 / float(loop.rest_lengths.min())
    assert loop.length_error(found) < max(1e-14, rounding)
    turned = loop.chords(found) / loop.rest_lengths[:, None]
    given /= np.linalg.norm(given, axis=1, keepdims=True)
    assert np.linalg.norm(turned - given, axis=1).max() < 0.02


@pytest.mark.parametrize("ratio", [0.1, 1e-4])
def test_uneven_loop_that_keeps_its_lengths_stays_where_it_is(ratio: float) -> None:
    loop, x = uneven(ratio)
    found = project_lengths(loop, x)
    assert found is not None
    assert np.abs(found - x).max() < 1e-15
