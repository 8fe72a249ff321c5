"""Compiled loop over a rod's points: length, bending and their second derivatives.

The same as energy.py, point by point, of which it is tested to be a copy: an iteration of
relaxation.py with few harmonics would else cost NumPy's calls, not arithmetic.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from eulerplateau.conformal.grading import FloatArray


@njit(cache=True)
def rod(slopes: FloatArray, weight: float) -> tuple[float, float]:
    """Return oint |x'| dphi and oint |x' x x''|^2 / |x'|^5 dphi.

    slopes : (n, 2, d), x' and x'' at n points of the same weight, in d dimensions.
    """
    length, bending = 0.0, 0.0
    for i in range(slopes.shape[0]):
        u, v, c = 0.0, 0.0, 0.0
        for a in range(slopes.shape[2]):
            p, q = slopes[i, 0, a], slopes[i, 1, a]
            u, v, c = u + p * p, v + q * q, c + p * q
        speed = np.sqrt(u)
        length += speed
        bending += (u * v - c * c) / (u * u * speed)
    return weight * length, weight * bending


@njit(cache=True)
def rod_derivatives(
    slopes: FloatArray,
    weight: float,
    beta: float,
    tangent: FloatArray,
    by_slopes: FloatArray,
    blocks: FloatArray,
) -> None:
    """Write derivatives by x' and x'' at every point, weights included.

    tangent : (n, 2, d), of the length; by_slopes : (n, 2, d), of the bending;
    blocks : (n, 2, d, 2, d), the second ones of bending + beta length.
    """
    n, _, d = slopes.shape
    for i in range(n):
        p, q = slopes[i, 0], slopes[i, 1]
        u, v, c = 0.0, 0.0, 0.0
        for a in range(d):
            u, v, c = u + p[a] * p[a], v + q[a] * q[a], c + p[a] * q[a]
        g, speed = u * v - c * c, np.sqrt(u)
        u5 = weight / (u * u * speed)
        u7, u9 = u5 / u, u5 / (u * u)
        stretched = weight * beta / speed
        for a in range(d):
            g_p, g_q = 2 * (v * p[a] - c * q[a]), 2 * (u * q[a] - c * p[a])
            tangent[i, 0, a], tangent[i, 1, a] = weight * p[a] / speed, 0.0
            by_slopes[i, 0, a] = g_p * u5 - 5 * g * u7 * p[a]
            by_slopes[i, 1, a] = g_q * u5
        for a in range(d):
            ga_p = 2 * (v * p[a] - c * q[a])
            for b in range(d):
                gb_p, gb_q = 2 * (v * p[b] - c * q[b]), 2 * (u * q[b] - c * p[b])
                same = 1.0 if a == b else 0.0
                pp = u5 * (2 * v * same - 2 * q[a] * q[b]) + 35 * u9 * g * p[a] * p[b]
                pp -= 5 * u7 * (ga_p * p[b] + p[a] * gb_p + g * same)
                pp += stretched * (same - p[a] * p[b] / u)
                pq = u5 * (4 * p[a] * q[b] - 2 * q[a] * p[b] - 2 * c * same)
                pq -= 5 * u7 * p[a] * gb_q
                blocks[i, 0, a, 0, b] = pp
                blocks[i, 0, a, 1, b] = pq
                blocks[i, 1, b, 0, a] = pq
                blocks[i, 1, a, 1, b] = 2 * u5 * (u * same - p[a] * p[b])
