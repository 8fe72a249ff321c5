"""The loop: its bending matrix, its constraint and that constraint's derivative."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.loop import Loop, strands_meet
from eulerplateau.mesh.disk import Disk
from tests.helpers import shapes, twins

RNG = np.random.default_rng(2)


def test_bending_matrix_gives_the_bending_energy_of_the_twin(oval: Disk) -> None:
    x = shapes.crumpled(oval, 0.05)
    around = x[oval.loop]
    matrix = Loop(oval.rest_lengths).bending_matrix
    expected = twins.bending_energy(oval, x)
    assert np.sum(around * (matrix @ around)) == pytest.approx(expected, rel=1e-12)


def test_bending_matrix_is_semidefinite_and_bends_nothing_by_translation(
    oval: Disk,
) -> None:
    matrix = Loop(oval.rest_lengths).bending_matrix
    values = np.linalg.eigvalsh(matrix)
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-12 * values[-1])
    np.testing.assert_allclose(matrix @ np.ones(oval.n_b), 0, atol=1e-11 * values[-1])
    assert np.sum(np.abs(values) < 1e-10 * values[-1]) == 1
    assert values[1] > 0


def test_constraint_is_that_of_the_twin_and_vanishes_at_rest(oval: Disk) -> None:
    loop = Loop(oval.rest_lengths)
    x = shapes.crumpled(oval, 0.02)
    np.testing.assert_allclose(
        loop.constraint(x[oval.loop]), twins.constraint(oval, x), rtol=1e-10
    )
    assert np.abs(loop.constraint(oval.x[oval.loop])).max() < 1e-16
    assert loop.length_error(oval.x[oval.loop]) < 1e-14


def test_constraint_resolves_a_length_error_of_1e_12() -> None:
    """The difference of squares would leave 1e-16 / 1e-12: four digits."""
    loop, strain = Loop(np.full(4, 0.25)), 2.0**-40
    square = 0.25 * np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    stretched = (1 + strain) * square
    expected = 0.25 * (strain + strain**2 / 2)
    np.testing.assert_allclose(loop.constraint(stretched), expected, rtol=1e-12)
    assert loop.length_error(stretched) == pytest.approx(strain, rel=1e-12)


def test_tension_force_is_the_gradient_of_lambda_times_constraint_with_taylor_slope_2(
    oval: Disk,
) -> None:
    loop, lam = Loop(oval.rest_lengths), RNG.standard_normal(oval.n_b)
    x = shapes.crumpled(oval, 0.02)[oval.loop]
    for _ in range(3):
        slope = twins.taylor_slope(
            lambda y: (float(lam @ loop.constraint(y)), loop.tension_force(y, lam)),
            x,
            0.1 * RNG.standard_normal(x.shape),
        )
        assert slope == pytest.approx(2.0, abs=0.05)


def test_constraint_is_invariant_under_rigid_motions_and_scales_as_a_length(
    oval: Disk,
) -> None:
    loop = Loop(oval.rest_lengths)
    x = shapes.crumpled(oval, 0.02)[oval.loop]
    moved = x @ shapes.rotation().T + [0.3, -0.2, 0.7]
    c = loop.constraint(x)
    np.testing.assert_allclose(loop.constraint(moved), c, atol=1e-12 * np.abs(c).max())
    longer = Loop(5 * oval.rest_lengths)
    np.testing.assert_allclose(longer.constraint(5 * x), 5 * c, rtol=1e-11)


def test_tension_pulls_the_two_ends_of_an_edge_together_with_opposite_forces() -> None:
    loop = Loop(np.full(4, 0.25))
    square = 0.25 * np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    gradient = loop.tension_force(square, np.array([1.0, 0, 0, 0]))
    # A gradient, so the force is its negative: vertex 0 is pulled towards +x.
    np.testing.assert_allclose(gradient, [[-1, 0, 0], [1, 0, 0], [0, 0, 0], [0, 0, 0]])


def test_curvature_of_a_regular_polygon_is_exact() -> None:
    """kappa_v = 2 n sin(pi/n) at each vertex for L = 1, so E_v = kappa_v^2 / n."""
    for n in (3, 4, 24):
        angle = 2 * np.pi * np.arange(n) / n
        x = np.stack([np.cos(angle), np.sin(angle)], axis=1) / (2 * n * np.sin(np.pi / n))
        matrix = Loop(np.full(n, 1 / n)).bending_matrix
        per_vertex = (x * (matrix @ x)).sum()
        assert per_vertex == pytest.approx((2 * n * np.sin(np.pi / n)) ** 2, rel=1e-12)


def wedge(degrees: float) -> FloatArray:
    """An isosceles triangle in edges of about 1, forty on each leg."""
    apex = np.radians(degrees)
    ends = 40 * np.array([[np.cos(apex / 2), np.sin(apex / 2)]]) * [[1.0, -1.0], [1.0, 1.0]]
    corners = [np.zeros(2), *ends, np.zeros(2)]
    counts = [40, round(80 * np.sin(apex / 2)), 40]
    sides = zip(corners, corners[1:], counts, strict=False)
    return np.concatenate([np.linspace(a, b, m, endpoint=False) for a, b, m in sides])


def test_a_sharp_corner_is_no_meeting_of_strands_and_a_needle_is() -> None:
    """Three edges from the corner its sides are 6 sin(apex / 2) edges apart."""
    assert not strands_meet(wedge(25.0))
    assert strands_meet(wedge(15.0))
