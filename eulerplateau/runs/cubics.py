"""Cubics between points of a curve; SciPy's take longer to load than a branch to follow."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.lapack import dgtsv


def between(
    x: FloatArray, y: FloatArray, slopes: FloatArray, places: FloatArray
) -> FloatArray:
    """Return at `places` the cubics that have values and slopes (n,) at ascending x (n,).

    Hermite's; beyond the ends those of the first and last stretch.
    """
    left = np.clip(np.searchsorted(x, places, side="right") - 1, 0, len(x) - 2)
    step, rise = np.diff(x), np.diff(y)
    h, share = step[left], (places - x[left]) / step[left]
    # y_0 + t (h m_0 + t (3 dy - h (2 m_0 + m_1) + t (h (m_0 + m_1) - 2 dy)))
    first, last, up = h * slopes[left], h * slopes[left + 1], rise[left]
    bend = 3 * up - 2 * first - last + share * (first + last - 2 * up)
    found: FloatArray = y[left] + share * (first + share * bend)
    return found


def spline_slopes(x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the slopes (n,) of the cubic spline through values (n,) at ascending x (n,).

    Its second derivative is continuous, and the third too next to the ends ("not a knot":
    de Boor, A Practical Guide to Splines, chapter IV), so that it is a cubic if y is. Of
    three points it is a parabola, of two a line.
    """
    step = np.diff(x)
    chord = np.diff(y) / step
    if len(x) == 2:
        return np.repeat(chord, 2)
    if len(x) == 3:
        bend = (chord[1] - chord[0]) / (x[2] - x[0])
        ends: FloatArray = chord[0] + bend * (2 * x - x[0] - x[1])
        return ends
    right = np.empty(len(x))
    right[1:-1] = 3 * (step[1:] * chord[:-1] + step[:-1] * chord[1:])
    for end, one, other in ((0, 0, 1), (-1, -1, -2)):
        both = step[one] + step[other]
        near = (step[one] + 2 * both) * step[other] * chord[one]
        right[end] = (near + step[one] ** 2 * chord[other]) / both
    diagonal = np.array([step[1], *2 * (step[:-1] + step[1:]), step[-2]])
    below = np.append(step[1:], step[-1] + step[-2])
    above = np.append(step[0] + step[1], step[:-1])
    slopes: FloatArray = dgtsv(below, diagonal, above, right)[3]
    return slopes
