"""Cubics between points: what they reproduce exactly, and SciPy's."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from eulerplateau.arrays import FloatArray
from eulerplateau.runs.cubics import between, spline_slopes


def uneven(count: int) -> FloatArray:
    return np.cumsum(np.random.default_rng(count).uniform(0.1, 2.0, count))


@pytest.mark.parametrize(("count", "degree"), [(2, 1), (3, 2), (4, 3), (5, 3), (40, 3)])
def test_spline_through_points_of_a_polynomial_is_that_polynomial(
    count: int, degree: int
) -> None:
    exact = Polynomial(np.random.default_rng(degree).standard_normal(degree + 1))
    x = uneven(count)
    slopes = spline_slopes(x, exact(x))
    size = np.abs(exact.deriv()(x)).max()
    np.testing.assert_allclose(slopes, exact.deriv()(x), atol=1e-11 * size)
    places = np.linspace(x[0] - 0.5, x[-1] + 0.5, 101)
    found = between(x, exact(x), slopes, places)
    np.testing.assert_allclose(
        found, exact(places), atol=1e-11 * np.abs(exact(places)).max()
    )


@pytest.mark.parametrize("count", [2, 3, 4, 7, 100])
def test_they_are_those_of_scipy(count: int) -> None:
    rng = np.random.default_rng(0)
    x = uneven(count)
    y, slopes = rng.standard_normal((2, count))
    places = np.sort(np.append(x, rng.uniform(x[0], x[-1], 50)))
    np.testing.assert_allclose(
        between(x, y, slopes, places), CubicHermiteSpline(x, y, slopes)(places), atol=1e-12
    )
    smooth = CubicSpline(x, y)(places)
    found = between(x, y, spline_slopes(x, y), places)
    np.testing.assert_allclose(found, smooth, atol=1e-11 * np.abs(smooth).max())
