"""Bending, line tension and adhesions of polygons whose edges may change their lengths."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import LinAlgError

from eulerplateau.loop import Adhesions, FreeBending, LineTension, edges_of
from tests.helpers.polygons import order, remainders, turned, uneven

N = 17
X = uneven(N, 3)
STEP = np.random.default_rng(5).uniform(-0.3, 0.3, X.shape)
TERMS = {"bending": FreeBending(0.1), "line tension": LineTension(1.7, 0.1)}
POINTS = np.array([[1.0, 0.2], [-0.7, 0.9], [0.1, -1.2]])
SPRINGS = Adhesions(np.array([0, 5, 11]), POINTS, np.array([1.0, 0.4, 2.5]), 3.0)


@pytest.mark.parametrize("term", TERMS.values(), ids=TERMS)
def test_force_and_hessian_are_derivatives(term: FreeBending | LineTension) -> None:
    first, second = remainders(term, X, STEP)
    assert first == pytest.approx(2, abs=0.1)
    assert second == pytest.approx(3, abs=0.1)
    hessian = term.hessian(X)
    np.testing.assert_allclose(hessian, hessian.T, atol=1e-12 * np.abs(hessian).max())


@pytest.mark.parametrize("term", TERMS.values(), ids=TERMS)
def test_hessian_is_the_derivative_of_the_force(term: FreeBending | LineTension) -> None:
    sizes, errors = [1e-2, 5e-3, 2.5e-3], []
    for h in sizes:
        difference = (term.force(X + h * STEP) - term.force(X - h * STEP)) / (2 * h)
        errors.append(np.abs(difference.ravel() - term.hessian(X) @ STEP.ravel()).max())
    assert order(sizes, errors) == pytest.approx(2, abs=0.1)


@pytest.mark.parametrize("term", TERMS.values(), ids=TERMS)
def test_change_is_the_difference_of_energies(term: FreeBending | LineTension) -> None:
    for h in (1.0, 0.1, 1e-3):
        difference = term.energy(X + h * STEP) - term.energy(X)
        assert term.change(X, h * STEP) == pytest.approx(difference, abs=1e-12)


@pytest.mark.parametrize("term", TERMS.values(), ids=TERMS)
def test_change_keeps_its_digits_however_small_the_step(
    term: FreeBending | LineTension,
) -> None:
    slope = np.vdot(term.force(X), STEP)
    small = 2.0**-40
    assert term.change(X, small * STEP) == pytest.approx(small * slope, rel=1e-9)


@pytest.mark.parametrize("term", TERMS.values(), ids=TERMS)
def test_rigid_motions_cost_nothing(term: FreeBending | LineTension) -> None:
    moved = turned(X, 0.7) + np.array([0.3, -1.1])
    assert term.energy(moved) == pytest.approx(term.energy(X), rel=1e-13)
    scale = np.abs(term.force(X)).max()
    np.testing.assert_allclose(
        term.force(moved), turned(term.force(X), 0.7), atol=1e-12 * scale
    )
    np.testing.assert_allclose(term.force(X).sum(axis=0), 0, atol=1e-12 * scale)
    force = term.force(X)
    moment = X[:, 0] * force[:, 1] - X[:, 1] * force[:, 0]
    assert abs(moment.sum()) < 1e-11 * scale


def test_energies_scale_with_length() -> None:
    bending, tension = TERMS.values()
    assert bending.energy(3 * X) == pytest.approx(bending.energy(X) / 3, rel=1e-13)
    assert tension.energy(3 * X) == pytest.approx(3 * tension.energy(X), rel=1e-13)


def test_bending_of_a_circle_converges_with_the_square_of_the_edge() -> None:
    counts = [16, 32, 64, 128]
    errors = []
    for n in counts:
        angle = 2 * np.pi * np.arange(n) / n
        x = 0.5 * np.column_stack([np.cos(angle), np.sin(angle)])
        errors.append(FreeBending(0.1).energy(x) - 2 * np.pi / 0.5)
    assert order([1 / n for n in counts], errors) == pytest.approx(2, abs=0.02)


def test_an_edge_that_folds_back_is_refused() -> None:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    through = np.zeros_like(square)
    through[1] = [-1.0, 1.5]
    assert edges_of(square + through).turning.sum() != pytest.approx(2 * np.pi)
    with pytest.raises(LinAlgError):
        FreeBending(1.0).change(square, through)


def test_bending_holds_while_its_shortest_edge_is_about_as_long() -> None:
    shortest = float(edges_of(X).lengths.min())
    term = FreeBending(shortest)
    assert term.holds(X)
    assert term.holds(1.9 * X)
    assert not term.holds(2.1 * X)
    assert not term.holds(0.45 * X)


def test_springs_are_quadratic_and_pull_twice_their_stiffness() -> None:
    first, _ = remainders(SPRINGS, X, STEP)
    assert first == pytest.approx(2, abs=1e-6)
    bend = 0.5 * np.vdot(STEP, SPRINGS.hessian(X) @ STEP)
    change = np.vdot(SPRINGS.force(X), STEP) + bend
    assert SPRINGS.change(X, STEP) == pytest.approx(change, rel=1e-13)
    difference = SPRINGS.energy(X + STEP) - SPRINGS.energy(X)
    assert SPRINGS.change(X, STEP) == pytest.approx(difference, rel=1e-12)
    pull = SPRINGS.force(X)[5]
    np.testing.assert_allclose(pull, 2 * 3.0 * 0.4 * (X[5] - POINTS[1]), rtol=1e-14)


def test_rates_belong_to_the_parameters_terms_are_linear_in() -> None:
    rate = SPRINGS.rate("stiffness", X)
    assert rate is not None
    np.testing.assert_allclose(3.0 * rate, SPRINGS.force(X))
    pull = TERMS["line tension"].rate("line_tension", X)
    assert pull is not None
    np.testing.assert_allclose(1.7 * pull, TERMS["line tension"].force(X))
    for term in (SPRINGS, *TERMS.values()):
        assert term.rate("load", X) is None
