"""Compiled loops over a loop's vertices: how far it bends the way its frame points.

At the vertex between two edges with tangents t, u and directors d, g the loop turns by the
angle theta, and it does so towards d by theta / sin(theta) times u . d, towards g by that
times -t . g. Half of the sum of both is what the vertex adds to the integral of t' . d1,

    k1 <s> = f(t . u) (u . d - t . g) / 2,     f(cos theta) = theta / sin(theta).

It is theta times the mean cosine of the angles between directors and the plane of the
turn: of second order, the same when the loop is run through backwards, and in a plane,
the directors being its normals, just the angle: in sum 2 pi, whatever the loop. So a
natural curvature does nothing to polygons in a plane either.

Derivatives are by the edges e_i of the loop, the frame carried along without turning about
them, and by angles psi_i by which it is turned. In sums over vertices of which only edges
across themselves matter, derivatives by t and u are those of free vectors.
"""

from __future__ import annotations

import math

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.compiling import njit

# theta / sin(theta) is a power series in (1 - cos theta) / 2, with the ratios k / (k + 1/2)
# of its coefficients: up to 60 degrees so many are right to rounding.
_TERMS = 30
_SMALL = 0.25


@njit(cache=True)
def bend(
    tangents: FloatArray, lengths: FloatArray, directors: FloatArray
) -> tuple[float, FloatArray, FloatArray, FloatArray]:
    """Return K = sum_v k1_v <s_v> of a frame, and how it changes.

    Parameters
    ----------
    tangents, lengths, directors : (n, 3), (n,), (n, 3) float, of each edge

    Returns
    -------
    value : K
    cosines, sines : (n,) float, what multiplies cos psi_i and sin psi_i in K
    slope : (n, 3) float, dK/de
    """
    n = len(lengths)
    value, slope, pull = 0.0, np.zeros((n, 3)), np.zeros((n, 3))
    for i in range(n):
        j = (i + 1) % n
        t, u, d, g = tangents[i], tangents[j], directors[i], directors[j]
        c, seen = _dot(t, u), _dot(u, d) - _dot(t, g)
        f, rise, _ = _turning(t, u)
        value += f * seen
        for k in range(3):
            slope[i, k] += rise * seen * u[k] - f * (c * d[k] + g[k])
            slope[j, k] += rise * seen * t[k] + f * (d[k] + c * g[k])
            pull[i, k] += f * u[k]
            pull[j, k] -= f * t[k]
    cosines, sines = np.empty(n), np.empty(n)
    for i in range(n):
        t, d = tangents[i], directors[i]
        cosines[i] = _dot(pull[i], d)
        sines[i] = _dot(pull[i], _cross(t, d))
        _keep_across(slope[i], t, lengths[i])
    return value, cosines, sines, slope


@njit(cache=True)
def bend_twice(
    tangents: FloatArray, lengths: FloatArray, directors: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return the second derivative of K; arguments as in `bend`.

    Returns
    -------
    own, beside : (n, 3, 3) float, by each edge twice, and by it and the next
    before, here, after : (n, 3) float
        By psi_i and by the edge before i, by edge i, and by that after it.
    """
    n = len(lengths)
    own, beside = np.zeros((n, 3, 3)), np.zeros((n, 3, 3))
    before, here, after = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    slope = np.zeros((n, 3))
    by_t, by_u = np.empty(3), np.empty(3)
    for i in range(n):
        j = (i + 1) % n
        t, u, d, g = tangents[i], tangents[j], directors[i], directors[j]
        c, seen = _dot(t, u), _dot(u, d) - _dot(t, g)
        f, rise, bent = _turning(t, u)
        p, q = _cross(t, d), _cross(u, g)
        ahead, back = rise * _dot(u, p), rise * _dot(t, q)
        for k in range(3):
            by_t[k], by_u[k] = -c * d[k] - g[k], d[k] + c * g[k]
            slope[i, k] += rise * seen * u[k] + f * by_t[k]
            slope[j, k] += rise * seen * t[k] + f * by_u[k]
            here[i, k] += ahead * u[k] - f * c * p[k]
            after[i, k] += ahead * t[k] + f * p[k]
            before[j, k] -= back * u[k] + f * q[k]
            here[j, k] += f * c * q[k] - back * t[k]
        for k in range(3):
            beside[i, k, k] += rise * seen
            for m in range(3):
                own[i, k, m] += bent * seen * u[k] * u[m]
                own[i, k, m] += rise * (u[k] * by_t[m] + by_t[k] * u[m])
                own[i, k, m] -= 0.5 * f * (d[k] * u[m] + u[k] * d[m])
                own[j, k, m] += bent * seen * t[k] * t[m]
                own[j, k, m] += rise * (t[k] * by_u[m] + by_u[k] * t[m])
                own[j, k, m] += 0.5 * f * (g[k] * t[m] + t[k] * g[m])
                beside[i, k, m] += bent * seen * u[k] * t[m]
                beside[i, k, m] += rise * (u[k] * by_u[m] + by_t[k] * t[m])
                beside[i, k, m] += f * (u[k] * g[m] - d[k] * t[m])
    for i in range(n):
        j = (i + 1) % n
        t, u, s = tangents[i], tangents[j], lengths[i]
        _keep_both_across(own[i], t, t, s * s)
        _keep_both_across(beside[i], t, u, s * lengths[j])
        _keep_across(before[i], tangents[i - 1], lengths[i - 1])
        _keep_across(here[i], t, s)
        _keep_across(after[i], u, lengths[j])
        # An edge that turns becomes longer, to second order, if not its tangent.
        along = _dot(slope[i], t)
        _keep_across(slope[i], t, s)
        for k in range(3):
            own[i, k, k] -= along / (s * s)
            for m in range(3):
                own[i, k, m] += along * t[k] * t[m] / (s * s)
                own[i, k, m] -= (t[k] * slope[i, m] + slope[i, k] * t[m]) / s
    return own, beside, before, here, after


@njit(cache=True)
def _turning(t: FloatArray, u: FloatArray) -> tuple[float, float, float]:
    """Return half of theta / sin(theta), and its two derivatives by cos(theta)."""
    x, y, z = u[0] - t[0], u[1] - t[1], u[2] - t[2]
    half = 0.25 * (x * x + y * y + z * z)
    if half > _SMALL:
        c = 1 - 2 * half
        square = 1 - c * c
        f = math.acos(c) / math.sqrt(square)
        rise = (c * f - 1) / square
        return 0.5 * f, 0.5 * rise, 0.5 * (f + 3 * c * rise) / square
    # Horner's rule for the series and its derivatives, in half of 1 - cos(theta).
    f, rise, bent = 1.0, 0.0, 0.0
    for k in range(_TERMS, 0, -1):
        ratio = k / (k + 0.5)
        bent = ratio * (2 * rise + half * bent)
        rise = ratio * (f + half * rise)
        f = 1.0 + ratio * half * f
    return 0.5 * f, -0.25 * rise, 0.125 * bent


@njit(cache=True)
def _dot(a: FloatArray, b: FloatArray) -> float:
    product: float = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return product


@njit(cache=True)
def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    found = np.empty(3)
    for k in range(3):
        p, q = (k + 1) % 3, (k + 2) % 3
        found[k] = a[p] * b[q] - a[q] * b[p]
    return found


@njit(cache=True)
def _keep_across(row: FloatArray, t: FloatArray, length: float) -> None:
    """Make a derivative (3,) by a tangent one by the edge: nothing along it counts."""
    along = _dot(row, t)
    for k in range(3):
        row[k] = (row[k] - along * t[k]) / length


@njit(cache=True)
def _keep_both_across(
    matrix: FloatArray, t: FloatArray, u: FloatArray, length: float
) -> None:
    """The same of a matrix (3, 3), by t and by u."""
    for k in range(3):
        _keep_across(matrix[k], u, length)
    for m in range(3):
        along = t[0] * matrix[0, m] + t[1] * matrix[1, m] + t[2] * matrix[2, m]
        for k in range(3):
            matrix[k, m] -= along * t[k]
