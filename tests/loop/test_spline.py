"""The smooth loop through the vertices of one: orders, derivatives, motions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline
from scipy.special import ellipe

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import SplineLoop, Splines
from tests.helpers import shapes

SEMI_AXES = 1.0, 0.6
MESHES = [20, 30, 45, 68]


def uneven(n: int) -> FloatArray:
    """Places (n,) in 0 ... 1, the same for all n but for their number: spacings 1 to 3."""
    steps = np.where(np.arange(n) < n // 2, 1.0, 3.0)
    return np.concatenate([[0.0], np.cumsum(steps)[:-1]]) / steps.sum()


def circle(n: int) -> SplineLoop:
    turns = 2 * np.pi * uneven(n)
    x = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    return Splines(np.diff(turns, append=2 * np.pi)).through(x)


def loop(n: int = 17) -> tuple[Splines, FloatArray]:
    """A rough loop in space, its parameter no arc length."""
    lengths = np.random.default_rng(2).uniform(0.5, 1.5, n)
    turns = 2 * np.pi * np.cumsum(lengths) / lengths.sum()
    x = np.stack([np.cos(turns), np.sin(turns), 0.2 * np.sin(2 * turns)], axis=1)
    return Splines(lengths), x + 0.05 * np.random.default_rng(3).standard_normal(x.shape)


@pytest.mark.parametrize("n", [8, 17])
def test_it_is_the_periodic_quintic_spline(n: int) -> None:
    """As scipy makes it from B-splines, to rounding."""
    splines, x = loop(n)
    ends = np.concatenate([[0.0], np.cumsum(splines.lengths)])
    closed = np.concatenate([x, x[:1]])
    other = make_interp_spline(ends, closed, k=5, bc_type="periodic")
    found = splines.through(x)
    middles = 0.5 * (ends[1:] + ends[:-1])
    np.testing.assert_allclose(found.middles, other(middles), atol=1e-12)
    curvature = splines.lengths[:, None] ** 2 * other.derivative(2)(ends[:-1])
    np.testing.assert_allclose(found.data[2], curvature, atol=1e-11)


@pytest.mark.parametrize(
    "error",
    [
        lambda smooth: smooth.bending / (2 * np.pi) - 1,
        lambda smooth: np.linalg.norm(smooth.spanned) / np.pi - 1,
        lambda smooth: np.abs(smooth.excess / smooth.splines.lengths).max(),
        lambda smooth: np.abs(np.linalg.norm(smooth.middles, axis=1) - 1).max(),
    ],
    ids=["bending", "area", "lengths", "middles"],
)
def test_of_a_circle_all_is_right_to_fourth_order_or_better(
    error: Callable[[SplineLoop], float],
) -> None:
    """On edges of two lengths, with jumps between them."""
    errors = [float(error(circle(n))) for n in MESHES]
    assert shapes.fitted_order([1 / n for n in MESHES], errors) > 4


def test_length_of_an_ellipse_is_right_to_fourth_order_whatever_its_parameter() -> None:
    a, b = SEMI_AXES
    exact, errors = 4 * a * ellipe(1 - (b / a) ** 2), []
    for n in MESHES:
        turns = 2 * np.pi * np.arange(n) / n
        x = np.stack([a * np.cos(turns), b * np.sin(turns), 0 * turns], axis=1)
        lengths = np.full(n, 2 * np.pi / n)
        smooth = Splines(lengths).through(x)
        errors.append(float((smooth.excess + lengths).sum() / exact - 1))
    assert shapes.fitted_order([1 / n for n in MESHES], errors) > 4


NORMAL = np.array([0.3, -0.5, 0.8])
TENSIONS = np.linspace(-1.0, 2.0, 17)
FORCES = np.random.default_rng(4).standard_normal((17, 3))


@pytest.mark.parametrize(
    ("value", "gradient"),
    [
        (lambda smooth: smooth.bending, lambda smooth: smooth.bending_gradient),
        (
            lambda smooth: TENSIONS @ smooth.excess,
            lambda smooth: smooth.tension_gradient(TENSIONS),
        ),
        (
            lambda smooth: NORMAL @ smooth.spanned,
            lambda smooth: smooth.spanned_gradient(NORMAL),
        ),
        (
            lambda smooth: np.vdot(FORCES, smooth.middles),
            lambda smooth: smooth.middles_gradient(FORCES),
        ),
    ],
    ids=["bending", "lengths", "area", "middles"],
)
def test_gradients_leave_a_remainder_of_second_order_or_none(
    value: Callable[[SplineLoop], float], gradient: Callable[[SplineLoop], FloatArray]
) -> None:
    splines, x = loop()
    step = 0.1 * shapes.wave(len(x), 1.0)
    before = splines.through(x)
    slope = float(np.vdot(splines.pulled_back(gradient(before)), step))
    sizes = [0.2, 0.1, 0.05, 0.025]
    remainders = [
        value(splines.through(x + t * step)) - value(before) - t * slope for t in sizes
    ]
    rounding = 1e-13 * (abs(value(before)) + abs(slope))
    linear = max(map(abs, remainders)) < rounding
    assert linear or abs(shapes.fitted_order(sizes, remainders) - 2) < 0.1


def test_bending_and_lengths_do_not_change_where_it_moves_as_a_whole() -> None:
    splines, x = loop()
    one, other = splines.through(x), splines.through(x @ shapes.rotation() + 0.3)
    assert np.isclose(one.bending, other.bending, rtol=1e-12)
    np.testing.assert_allclose(one.excess, other.excess, atol=1e-13)
