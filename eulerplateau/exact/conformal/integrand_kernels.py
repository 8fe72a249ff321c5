"""Compiled loops of energy.py and writhe.py: integrands along a loop, differentiated.

Point by point, in x' = p and x'' = q. With u = |p|^2, v = |q|^2, w = p.q the integrands are

    bending g u^(-5/2), g = u v - w^2;    length u^(1/2),

and the writhe's change by a displacement is that of p times q x p / (2 pi u^(3/2)). Loops
have so few points that in NumPy calls would cost more than arithmetic.
"""

from __future__ import annotations

import math

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.compiling import njit


@njit(cache=True)
def bending_slopes(x1: FloatArray, x2: FloatArray) -> FloatArray:
    """Return the derivatives (n, 2, 3) of the bending by x' and x'', each (n, 3)."""
    found = np.empty((len(x1), 2, 3))
    for i in range(len(x1)):
        u, v, w = _products(x1[i], x2[i])
        scale = u**-2.5
        radial = 5 * (u * v - w * w) / u
        for a in range(3):
            p, q = x1[i, a], x2[i, a]
            found[i, 0, a] = scale * (2 * (v * p - w * q) - radial * p)
            found[i, 1, a] = 2 * scale * (u * q - w * p)
    return found


@njit(cache=True)
def bending_second(x1: FloatArray, x2: FloatArray) -> FloatArray:
    """Return the second derivatives (n, 2, 3, 2, 3) of the bending by x' and x''."""
    found = np.empty((len(x1), 2, 3, 2, 3))
    for i in range(len(x1)):
        u, v, w = _products(x1[i], x2[i])
        scale, g = u**-2.5, u * v - w * w
        for a in range(3):
            pa, qa = x1[i, a], x2[i, a]
            g_pa = 2 * (v * pa - w * qa)
            for b in range(3):
                pb, qb = x1[i, b], x2[i, b]
                same = 1.0 if a == b else 0.0
                g_pb, g_qb = 2 * (v * pb - w * qb), 2 * (u * qb - w * pb)
                pp = 2 * v * same - 2 * qa * qb + 35 * g * pa * pb / u**2
                pp -= 5 * (g_pa * pb + pa * g_pb + g * same) / u
                pq = 4 * pa * qb - 2 * qa * pb - 2 * w * same - 5 * pa * g_qb / u
                found[i, 0, a, 0, b] = scale * pp
                found[i, 0, a, 1, b] = found[i, 1, b, 0, a] = scale * pq
                found[i, 1, a, 1, b] = 2 * scale * (u * same - pa * pb)
    return found


@njit(cache=True)
def length_second(x1: FloatArray) -> FloatArray:
    """Return the second derivatives (n, 1, 3, 1, 3) of the length by x'."""
    found = np.empty((len(x1), 1, 3, 1, 3))
    for i in range(len(x1)):
        u, _, _ = _products(x1[i], x1[i])
        for a in range(3):
            for b in range(3):
                across = (1.0 if a == b else 0.0) - x1[i, a] * x1[i, b] / u
                found[i, 0, a, 0, b] = across / math.sqrt(u)
    return found


@njit(cache=True)
def writhe_slopes(x1: FloatArray, x2: FloatArray) -> FloatArray:
    """Return how the writhe changes (n, 1, 3) by a displacement's derivative x'."""
    found = np.empty((len(x1), 1, 3))
    for i in range(len(x1)):
        u, _, _ = _products(x1[i], x2[i])
        for a in range(3):
            b, c = (a + 1) % 3, (a + 2) % 3
            across = x2[i, b] * x1[i, c] - x2[i, c] * x1[i, b]
            found[i, 0, a] = across / (2 * math.pi * u**1.5)
    return found


@njit(cache=True)
def writhe_second(x1: FloatArray, x2: FloatArray) -> FloatArray:
    """Return the second derivatives (n, 2, 3, 2, 3) of the writhe by x' and x''."""
    found = np.zeros((len(x1), 2, 3, 2, 3))
    across = np.empty(3)
    for i in range(len(x1)):
        u, _, _ = _products(x1[i], x2[i])
        scale = 0.5 / (2 * math.pi * u**1.5)
        for a in range(3):
            b, c = (a + 1) % 3, (a + 2) % 3
            across[a] = x2[i, b] * x1[i, c] - x2[i, c] * x1[i, b]
            # By x' and x'' half of e_a x x', from either side of the product.
            found[i, 0, a, 1, b] = found[i, 1, b, 0, a] = scale * x1[i, c]
            found[i, 0, a, 1, c] = found[i, 1, c, 0, a] = -scale * x1[i, b]
        for a in range(3):
            for b in range(3):
                both = across[a] * x1[i, b] + x1[i, a] * across[b]
                found[i, 0, a, 0, b] = -3 * scale * both / u
    return found


@njit(cache=True)
def tangent_area(x1: FloatArray, x2: FloatArray, axis: FloatArray) -> float:
    """Return the mean of (e x t) . t' / (1 + e . t), e the axis (3,) and t the tangent."""
    total = 0.0
    for i in range(len(x1)):
        u, _, _ = _products(x1[i], x2[i])
        along, turned = 0.0, 0.0
        for a in range(3):
            b, c = (a + 1) % 3, (a + 2) % 3
            along += axis[a] * x1[i, a]
            turned += axis[a] * (x1[i, b] * x2[i, c] - x1[i, c] * x2[i, b])
        total += turned / (u + math.sqrt(u) * along)
    return total / len(x1)


@njit(cache=True)
def crossings(seen: FloatArray) -> int:
    """Return the signed crossings of a closed polygon (n, 3) seen along z.

    Right-handed ones are positive.
    """
    n, count = len(seen), 0
    x, y, z = seen[:, 0], seen[:, 1], seen[:, 2]
    for i in range(n - 2):
        px, py, pz = x[i + 1] - x[i], y[i + 1] - y[i], z[i + 1] - z[i]
        before = px * (y[i + 2] - y[i]) - py * (x[i + 2] - x[i])
        for j in range(i + 2, n if i > 0 else n - 1):
            k = (j + 1) % n
            after = px * (y[k] - y[i]) - py * (x[k] - x[i])
            if (before > 0) != (after > 0):  # edge j crosses the line of edge i
                there = before / (before - after)
                qx, qy, qz = x[k] - x[j], y[k] - y[j], z[k] - z[j]
                along = px * (x[j] + there * qx - x[i]) + py * (y[j] + there * qy - y[i])
                here = along / (px * px + py * py)
                if 0 <= here < 1:
                    above = z[i] + here * pz > z[j] + there * qz
                    count += 1 if (after > before) == above else -1
            before = after
    return count


@njit(cache=True)
def assemble(
    slopes: FloatArray, weights: FloatArray, columns: FloatArray, starts: IntArray
) -> FloatArray:
    """Return the integral (size,) of slopes (points, m, 3) times what each column adds.

    weights : (points,)
    columns, starts : (2, points, size), x' and x'' of the columns; (4,), where those of x,
        y and z begin, and their end
    """
    points, m, _ = slopes.shape
    found = np.zeros(columns.shape[2])
    for o in range(m):
        for i in range(points):
            for a in range(3):
                share = weights[i] * slopes[i, o, a]
                for j in range(starts[a], starts[a + 1]):
                    found[j] += share * columns[o, i, j]
    return found


@njit(cache=True)
def spread(
    second: FloatArray, weights: FloatArray, columns: FloatArray, starts: IntArray
) -> FloatArray:
    """Return second derivatives (points, m, 3, m, 3) times what each column adds.

    It is (3, m, points, size), of which (a, ...) counts from the columns of coordinate a
    on. The other arguments are those of `assemble`.
    """
    points, m = second.shape[0], second.shape[1]
    found = np.empty((3, m, points, columns.shape[2]))
    for a in range(3):
        for o in range(m):
            for i in range(points):
                for b in range(a, 3):
                    first = weights[i] * second[i, o, a, 0, b]
                    last = weights[i] * second[i, o, a, 1, b] if m > 1 else 0.0
                    for j in range(starts[b], starts[b + 1]):
                        found[a, o, i, j] = (
                            first * columns[0, i, j] + last * columns[1, i, j]
                        )
    return found


@njit(cache=True, inline="always")
def _products(p: FloatArray, q: FloatArray) -> tuple[float, float, float]:
    """Return p.p, q.q and p.q."""
    u = p[0] * p[0] + p[1] * p[1] + p[2] * p[2]
    v = q[0] * q[0] + q[1] * q[1] + q[2] * q[2]
    return u, v, p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
