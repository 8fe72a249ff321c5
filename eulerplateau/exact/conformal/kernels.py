"""Compiled loops of relaxation.py: the energy of a loop of free size, twice differentiated.

The formulas are energy.py's, point by point; with few harmonics an iteration in NumPy
costs its calls and not its arithmetic. Kernels that call each other stay in this file
(numba #1833).

A loop x(phi) of any length l stands for the loop of length 1 of its shape, so that nothing
is left to be held:  F = l b + sigma_hat D / l^2,  b = oint kappa^2 ds. D is diagonal in the
harmonics: base_j (1 - r)/(1 + r) c_j^2 / 2 with r = sign_j q^k_j (sector.py).

In all of them slopes : (n, 2, 3, m), x' and x'' at n points, of m columns; weights : (n,),
of the points; k, sign, base, c : (m,); q : the nome.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.compiling import njit

# Of the angle between tangents at neighbouring points, and of their lengths.
_LEAST_COSINE, _LARGEST_RATIO = 0.866, 1.5


@njit(cache=True)
def loop_energy(
    slopes: FloatArray,
    weights: FloatArray,
    k: FloatArray,
    sign: FloatArray,
    base: FloatArray,
    load: float,
    c: FloatArray,
    q: float,
) -> tuple[float, float, float, float]:
    """Return F, the length l, the bending b and D.

    F is infinite where the tangent x' turns by more than 30 degrees from point to point, or
    grows or shrinks by half: the grid would miss a bend, and with it what it costs.
    """
    n, _, d, m = slopes.shape
    length, bending, area = 0.0, 0.0, 0.0
    last, before, resolved = np.zeros(d), 0.0, True
    for i in range(n):
        uu, vv, uv, along = 0.0, 0.0, 0.0, 0.0
        for a in range(d):
            first, second = 0.0, 0.0
            for j in range(m):
                first += slopes[i, 0, a, j] * c[j]
                second += slopes[i, 1, a, j] * c[j]
            uu, vv, uv = uu + first * first, vv + second * second, uv + first * second
            along += first * last[a]
            last[a] = first
        speed = np.sqrt(uu)
        if i > 0:
            even = max(speed, before) <= _LARGEST_RATIO * min(speed, before)
            resolved = resolved and even and along >= _LEAST_COSINE * speed * before
        before = speed
        length += weights[i] * speed
        bending += weights[i] * (uu * vv - uv * uv) / (uu * uu * speed)
    for j in range(m):
        r = sign[j] * q ** k[j]
        area += 0.5 * base[j] * (1 - r) / (1 + r) * c[j] * c[j]
    energy = length * bending + load * area / length**2
    return energy if resolved else np.inf, length, bending, area


@njit(cache=True)
def loop_derivatives(
    slopes: FloatArray,
    weights: FloatArray,
    k: FloatArray,
    sign: FloatArray,
    base: FloatArray,
    load: float,
    c: FloatArray,
    q: float,
    beta: float,
    area: float,
    gradient: FloatArray,
    hessian: FloatArray,
) -> None:
    """Write F's gradient (m + 1,) and Hessian (m + 1, m + 1) by c and q at a loop, l = 1.

    beta = b - 2 sigma_hat D, the multiplier of length that scaling leaves.
    """
    n, _, d, m = slopes.shape
    tangent, bend, pull = np.zeros(m), np.zeros(m), np.zeros(m)
    p, s, block = np.zeros(d), np.zeros(d), np.zeros((2, d, 2, d))
    row = np.zeros(m)
    hessian[:] = 0.0
    for i in range(n):
        weight = weights[i]
        if weight == 0.0:
            continue
        for a in range(d):
            p[a], s[a] = 0.0, 0.0
            for j in range(m):
                p[a] += slopes[i, 0, a, j] * c[j]
                s[a] += slopes[i, 1, a, j] * c[j]
        _point(p, s, weight, beta, block)
        u, v, w = np.sum(p * p), np.sum(s * s), np.sum(p * s)
        g, u5 = u * v - w * w, weight * u**-2.5
        for a in range(d):
            by_p = 2 * u5 * (v * p[a] - w * s[a]) - 5 * g * u5 / u * p[a]
            by_s = 2 * u5 * (u * s[a] - w * p[a])
            by_length = weight * p[a] / np.sqrt(u)
            for j in range(m):
                bend[j] += by_p * slopes[i, 0, a, j] + by_s * slopes[i, 1, a, j]
                tangent[j] += by_length * slopes[i, 0, a, j]
            for o in range(2):
                row[:] = 0.0
                for b in range(d):
                    first, second = block[o, a, 0, b], block[o, a, 1, b]
                    for j in range(m):
                        row[j] += first * slopes[i, 0, b, j] + second * slopes[i, 1, b, j]
                for j in range(m):
                    factor = slopes[i, o, a, j]
                    if factor != 0.0:
                        for h in range(j + 1):
                            hessian[j, h] += factor * row[h]
    by_q, twice_by_q = 0.0, 0.0
    for j in range(m):
        r = sign[j] * q ** k[j]
        r1 = sign[j] * k[j] * q ** (k[j] - 1)
        r2 = sign[j] * k[j] * (k[j] - 1) * q ** max(k[j] - 2, 0.0)
        pull[j] = load * base[j] * (1 - r) / (1 + r) * c[j]
        change = -2 * load * base[j] * r1 / (1 + r) ** 2
        by_q += 0.5 * change * c[j] ** 2
        curved = -2 * load * base[j] * (r2 / (1 + r) ** 2 - 2 * r1**2 / (1 + r) ** 3)
        twice_by_q += 0.5 * curved * c[j] ** 2
        hessian[m, j] = change * c[j]
        hessian[j, j] += load * base[j] * (1 - r) / (1 + r)
    for j in range(m):
        gradient[j] = bend[j] + beta * tangent[j] + pull[j]
        hessian[m, j] -= 2 * by_q * tangent[j]
        for h in range(j + 1):
            mixed = (bend[j] - 2 * pull[j]) * tangent[h]
            mixed += (bend[h] - 2 * pull[h]) * tangent[j]
            hessian[j, h] += mixed + 6 * load * area * tangent[j] * tangent[h]
    gradient[m], hessian[m, m] = by_q, twice_by_q
    for j in range(m + 1):
        for h in range(j):
            hessian[h, j] = hessian[j, h]


@njit(cache=True)
def _point(
    p: FloatArray, s: FloatArray, weight: float, beta: float, block: FloatArray
) -> None:
    """Write the second derivatives (2, d, 2, d) of bending + beta length by x' and x''."""
    u, v, w = np.sum(p * p), np.sum(s * s), np.sum(p * s)
    g, u5 = u * v - w * w, weight * u**-2.5
    u7, u9 = u5 / u, u5 / u**2
    stretched = weight * beta / np.sqrt(u)
    for a in range(len(p)):
        a_p = 2 * (v * p[a] - w * s[a])
        for b in range(len(p)):
            b_p, b_s = 2 * (v * p[b] - w * s[b]), 2 * (u * s[b] - w * p[b])
            same = 1.0 if a == b else 0.0
            pp = u5 * (2 * v * same - 2 * s[a] * s[b]) + 35 * u9 * g * p[a] * p[b]
            pp -= 5 * u7 * (a_p * p[b] + p[a] * b_p + g * same)
            block[0, a, 0, b] = pp + stretched * (same - p[a] * p[b] / u)
            ps = u5 * (4 * p[a] * s[b] - 2 * s[a] * p[b] - 2 * w * same)
            block[0, a, 1, b] = ps - 5 * u7 * p[a] * b_s
            block[1, b, 0, a] = block[0, a, 1, b]
            block[1, a, 1, b] = 2 * u5 * (u * same - p[a] * p[b])
