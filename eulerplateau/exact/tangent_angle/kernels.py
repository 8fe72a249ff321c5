"""How a lobe's tangent angle goes downhill to its minimum: compiled (relaxation.py).

Arrays in, arrays out. A loop is the angle phi(s) = sum_k c_k sin(2 pi n k s), k = 1 ... m,
by which its tangent turns beyond a circle's. Its film follows from the real Fourier
coefficients of e^{i phi},

    a_l = (1/P) sum_j cos(phi_j - 2 pi n l s_j),  s_j = (j + 1/2) / (2 n P),  0 <= j < P,
    A = sum_l w_l a_l^2,  w_l = 1 / (4 pi (1 + n l)),  |l| < P,

and so do the film's derivatives, because d a_l / d c_k = (a_{l-k} - a_{l+k}) / 2, exactly
so with a_{l+2P} = -a_l. With r_d = sum_l w_l a_l a_{l+d} and q_d = (r_d + r_{-d}) / 2

    dA / dc_k = r_{-k} - r_k,
    d2A / dc_k dc_h = sum_l w_l / 2 (a_{l-k} - a_{l+k}) (a_{l-h} - a_{l+h})
                      - q_{k-h} + q_{k+h}.

Derivatives are those by u_k = 2 pi n k c_k, in which the bending is 4 pi^2 + u.u / 2.
Innermost loops run along rows: vectorised, they need no reordering of sums. Helpers stay
in this file (numba #1833).
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.compiling import njit

# Points on half a lobe beyond one for each harmonic: what quadrature misses is e^{i phi}'s
# coefficients from this far above the harmonics, less than what truncation does.
MORE_POINTS = 8
_STEPS, _HALVINGS = 200, 40
# What Newton's step would still gain, over the energy, when it is the last.
_DONE = 1e-15
# No step turns a tangent farther (radians).
_FARTHEST = 0.7
# Armijo's share of the predicted decrease, and rounding of an energy.
_SHARE, _ROUNDING = 1e-4, 1e-13
# The first shift where a curvature is negative, bending's being 1, and its growth; with the
# last one something is not finite.
_SHIFT, _STIFFER, _STIFFEST = 0.1, 3.0, 1e200
# At a saddle, where there is no slope, a turn along the first harmonic.
_ASIDE = 0.1
# Newton's steps to the neck's place, from a straight line between two points.
_NECK_STEPS = 3


@njit(cache=True, error_model="numpy")
def tabulate(cosine: FloatArray, sine: FloatArray) -> None:
    """Fill (P, P + 1) with cos and sin of 2 pi n l s_j, row after row."""
    count = len(cosine)
    for order in range(count + 1):
        angle = 0.5 * np.pi * order / count
        cosine[0, order], sine[0, order] = np.cos(angle), np.sin(angle)
    for j in range(1, count):
        for order in range(count + 1):
            c, s = cosine[0, order], sine[0, order]
            c, s = c * c - s * s, 2 * c * s
            cosine[j, order] = c * cosine[j - 1, order] - s * sine[j - 1, order]
            sine[j, order] = c * sine[j - 1, order] + s * cosine[j - 1, order]


@njit(cache=True, error_model="numpy")
def transform(
    c: FloatArray, lobes: int, cosine: FloatArray, sine: FloatArray, a: FloatArray
) -> tuple[float, float]:
    """Return bending and area; fill a (2 P + 4 m - 1,) with a_l, a_0 in its middle."""
    count, middle = len(cosine), len(a) // 2
    a[:] = 0.0
    for j in range(count):
        phi = 0.0
        for k in range(len(c)):
            phi += c[k] * sine[j, k + 1]
        real, imaginary = np.cos(phi) / count, np.sin(phi) / count
        for order in range(count + 1):
            a[middle + order] += real * cosine[j, order]
        for order in range(1, count + 1):
            a[middle - order] += imaginary * sine[j, order]
    for order in range(1, count + 1):
        even, odd = a[middle + order], a[middle - order]
        a[middle + order], a[middle - order] = even + odd, even - odd
    for order in range(count + 1, middle + 1):
        a[middle + order] = -a[middle + order - 2 * count]
        a[middle - order] = -a[middle - order + 2 * count]
    bending, area = 4 * np.pi**2, 0.0
    for order in range(1 - count, count):
        area += a[middle + order] ** 2 / (4 * np.pi * (1 + lobes * order))
    for k in range(len(c)):
        bending += 0.5 * (2 * np.pi * lobes * (k + 1) * c[k]) ** 2
    return bending, area


@njit(cache=True, error_model="numpy")
def differentiate(
    c: FloatArray,
    lobes: int,
    load: float,
    a: FloatArray,
    gradient: FloatArray,
    hessian: FloatArray,
) -> None:
    """Fill the energy's gradient (m,) and the upper half of its Hessian (m, m) by u.

    a : what `transform` fills.
    """
    m, middle = len(c), len(a) // 2
    count = middle - 2 * m + 1
    r, row, wave = np.zeros(4 * m + 1), np.empty(m), np.empty(m)
    for k in range(m):
        wave[k] = 2 * np.pi * lobes * (k + 1)
    hessian[:] = 0.0
    for order in range(1 - count, count):
        weight, here = load / (4 * np.pi * (1 + lobes * order)), middle + order
        for d in range(4 * m + 1):
            r[d] += weight * a[here] * a[here + d - 2 * m]
        for k in range(m):
            row[k] = (a[here - k - 1] - a[here + k + 1]) / wave[k]
        for k in range(m):
            factor = 0.5 * weight * row[k]
            for h in range(k, m):
                hessian[k, h] += factor * row[h]
    zero = 2 * m
    for k in range(m):
        slope = r[zero - k - 1] - r[zero + k + 1]
        gradient[k] = wave[k] * c[k] + slope / wave[k]
        for h in range(k, m):
            near = r[zero + h - k] + r[zero + k - h]
            far = r[zero + h + k + 2] + r[zero - h - k - 2]
            hessian[k, h] += 0.5 * (far - near) / (wave[k] * wave[h])
        hessian[k, k] += 1.0


@njit(cache=True, error_model="numpy")
def solve(hessian: FloatArray, shift: float, factor: FloatArray, x: FloatArray) -> bool:
    """Replace x (m,) by (H + shift)^-1 x, and return whether that is positive definite.

    hessian (m, m), its upper half; factor (m, m), room for Cholesky's factor.
    """
    m = len(x)
    for k in range(m):
        for h in range(k, m):
            factor[k, h] = hessian[k, h]
        factor[k, k] += shift
    for k in range(m):
        if not factor[k, k] > 0.0:
            return False
        size = 1 / np.sqrt(factor[k, k])
        for h in range(k, m):
            factor[k, h] *= size
        for i in range(k + 1, m):
            along = factor[k, i]
            for h in range(i, m):
                factor[i, h] -= along * factor[k, h]
    for k in range(m):
        x[k] /= factor[k, k]
        for h in range(k + 1, m):
            x[h] -= factor[k, h] * x[k]
    for k in range(m - 1, -1, -1):
        for h in range(k + 1, m):
            x[k] -= factor[k, h] * x[h]
        x[k] /= factor[k, k]
    return True


@njit(cache=True, error_model="numpy")
def descent_step(
    gradient: FloatArray, hessian: FloatArray, step: FloatArray
) -> tuple[float, float]:
    """Fill step (m,) with that of Newton's method, shifted so far that it goes downhill.

    Returns the shift, 0 where the Hessian is positive definite, and by how much the energy
    falls per length of the step.
    """
    m, shift = len(step), 0.0
    factor = np.empty((m, m))
    while shift < _STIFFEST:
        for k in range(m):
            step[k] = gradient[k]
        if solve(hessian, shift, factor, step):
            break
        shift = max(_STIFFER * shift, _SHIFT)
    gain = 0.0
    for k in range(m):
        gain += gradient[k] * step[k]
        step[k] = -step[k]
    return shift, gain


@njit(cache=True, error_model="numpy")
def go_down(
    c: FloatArray,
    step: FloatArray,
    short: float,
    gain: float,
    lobes: int,
    load: float,
    energy: float,
    cosine: FloatArray,
    sine: FloatArray,
    a: FloatArray,
) -> tuple[float, float, bool]:
    """Move c (m,) by the part `short` of a step, or less where the energy does not fall.

    gain : what `descent_step` returns. Returns bending and area there, and whether there is
    such a part; fills a as `transform` does.
    """
    m, there = len(c), np.empty(len(c))
    bending, area = 0.0, 0.0
    for _ in range(_HALVINGS):
        for k in range(m):
            there[k] = c[k] + short * step[k]
        bending, area = transform(there, lobes, cosine, sine, a)
        least = _SHARE * short * gain - _ROUNDING * abs(energy)
        if energy - bending - load * area >= least:
            for k in range(m):
                c[k] = there[k]
            return bending, area, True
        short *= 0.5
    return bending, area, False


@njit(cache=True, error_model="numpy")
def descend(
    c: FloatArray, lobes: int, load: float, a: FloatArray
) -> tuple[float, float, float, int, bool]:
    """Move c (m,) downhill to a minimum, and fill a (2 P + 4 m - 1,) as `transform` does.

    Returns the bending, the area, the residual |dE/du| over the root of the energy, the
    steps taken, and whether c is a minimum.
    """
    m, count = len(c), len(c) + MORE_POINTS
    cosine, sine = np.empty((count, count + 1)), np.empty((count, count + 1))
    tabulate(cosine, sine)
    gradient, step, hessian = np.empty(m), np.empty(m), np.empty((m, m))
    bending, area = transform(c, lobes, cosine, sine, a)
    last, lower, taken = False, True, 0
    while True:
        energy = bending + load * area
        differentiate(c, lobes, load, a, gradient, hessian)
        if last or not lower or taken == _STEPS:
            break
        shift, gain = descent_step(gradient, hessian, step)
        little = gain <= _DONE * abs(energy)
        last = little and shift == 0.0
        turn = 0.0
        for k in range(m):
            step[k] /= 2 * np.pi * lobes * (k + 1)
            if little and not last:
                step[k] = np.copysign(_ASIDE, c[0]) if k == 0 else 0.0
            turn += abs(step[k])
        short = _FARTHEST / turn if turn > _FARTHEST else 1.0
        bending, area, lower = go_down(
            c, step, short, gain, lobes, load, energy, cosine, sine, a
        )
        taken += 1
    left = 0.0
    for k in range(m):
        left += gradient[k] ** 2
    return bending, area, np.sqrt(left / abs(energy)), taken, last and lower


@njit(cache=True, error_model="numpy")
def waist(c: FloatArray, lobes: int, a: FloatArray) -> float:
    """Return twice the distance of a lobe's neck from its axis (PlaneLoop.waist).

    The neck is the last place from the tip on where the tangent runs along the axis, back
    to the middle; without one it is the lobe's end. c (m,) and a as `descend` leaves them.
    """
    half, count = 0.5 / lobes, len(c) + MORE_POINTS
    neck, after = half, np.pi / lobes - 0.5 * np.pi
    for j in range(count - 1, -1, -1):
        place = half * (j + 0.5) / count
        before = beyond(c, lobes, place)[0]
        if before > 0.0:
            neck = (before * neck - after * place) / (before - after)
            for _ in range(_NECK_STEPS):
                off, slope = beyond(c, lobes, neck)
                neck -= off / slope
            break
        neck, after = place, before
    else:
        neck = half
    y = 0.0
    for order in range(1 - count, count):
        wave = 2 * np.pi * (1 + lobes * order)
        y += a[len(a) // 2 + order] / wave * np.sin(wave * neck)
    return 2 * y


@njit(cache=True, error_model="numpy")
def beyond(c: FloatArray, lobes: int, s: float) -> tuple[float, float]:
    """Return how far the tangent has turned beyond the way back along x; the curvature."""
    angle, kappa = 2 * np.pi * s - 0.5 * np.pi, 2 * np.pi
    for k in range(len(c)):
        wave = 2 * np.pi * lobes * (k + 1)
        angle += c[k] * np.sin(wave * s)
        kappa += wave * c[k] * np.cos(wave * s)
    return angle, kappa
