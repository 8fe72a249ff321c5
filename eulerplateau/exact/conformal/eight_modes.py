"""Second variation of the flat eight with its strands touching where they cross.

Across the plane,

    E2 = int z''^2 + (beta - 3 kappa^2) z'^2 / 2 ds + sigma/2 int |grad z|^2 dA,

z harmonic in each lobe. The strands stay in contact: a distance h between them costs
sigma h^2 / omega log(1/h), omega being the lobes' angle, more than any quadratic form.
"""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.polynomial.legendre import leggauss
from scipy.linalg import eigh

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal.eight import FlatEight

# Trial functions on a lobe; the poles and powers that span harmonic functions (lightning
# method, Gopal and Trefethen 2019); panels of 12 Gauss points, halving towards the corner.
_TRIALS, _POLES, _POWERS, _HALVINGS, _GAUSS = 16, 40, 40, 30, 12
_SPREAD = 4.0
_WAVES, _POINTS = 60, 4000


def transverse_modes(eight: FlatEight, centre: int, mirror: int) -> FloatArray:
    """Return the eigenvalues (m,), ascending, per oint z^2 ds, of one symmetry.

    z(-s) = centre z(s) about the crossing and z(1/2 - s) = mirror z(s) about the lobes'
    axis, +1 or -1 each. (1, 1) includes the translation, (-1, 1) and (-1, -1) a rotation
    each: eigenvalues 0, whose size shows the error.
    """
    s, weights = _panels()
    kappa, _, angle, x, y = eight.quarter(s)
    values, first, second = _trials(s, centre, mirror)
    stiff = 2 * second.T @ (weights[:, None] * second)
    tension = weights * (eight.beta - 3 * kappa**2)
    stiff += first.T @ (tension[:, None] * first)
    normal = -1j * np.exp(1j * angle)
    slopes = _normal_derivatives(x + 1j * y, normal, weights, values, mirror)
    film = values.T @ (weights[:, None] * slopes)
    stiff += eight.load * (film + film.T) / 2
    heavy = values.T @ (weights[:, None] * values)
    eigenvalues: FloatArray = eigh(stiff, heavy, eigvals_only=True)
    return eigenvalues


def planar_modes(eight: FlatEight) -> FloatArray:
    """Return the eigenvalues (m,), ascending, per oint v^2 ds, of normal displacements v.

    In the plane, the length kept. Three rigid motions have eigenvalue 0.
    """
    s = (np.arange(_POINTS) + 0.5) / _POINTS
    kappa, slope, lobe = _whole_loop(eight, s)
    k = 2 * pi * np.arange(1, _WAVES + 1)
    cosine, sine, zero = (
        np.cos(np.outer(s, k)),
        np.sin(np.outer(s, k)),
        np.zeros((len(s), 1)),
    )
    v = np.hstack([zero + 1, cosine, sine])
    v1 = np.hstack([zero, -k * sine, k * cosine])
    v2 = np.hstack([zero, -(k**2) * cosine, -(k**2) * sine])

    def form(weight: FloatArray, a: FloatArray, b: FloatArray) -> FloatArray:
        product = a.T @ (weight[:, None] * b) / _POINTS
        result: FloatArray = product + product.T  # of 2 E2
        return result

    one, k2 = np.ones(_POINTS), kappa**2
    # kappa^2 ds to second order, from x' = (1 - kappa v) t + v' n.
    turned = v2 - 2 * k2[:, None] * v
    stiff = form(one, turned, turned)
    stiff += 2 * form(k2**2, v, v) + 2 * form(kappa * slope, v, v1) - 2 * form(k2, v, v2)
    stiff += 4 * form(k2, v1, v1) + 10 * form(k2, v, turned)
    stiff += 15 * form(k2**2, v, v) - 2.5 * form(k2, v1, v1)
    stiff += eight.beta / 2 * form(one, v1, v1)
    stiff += eight.load / 2 * form(lobe * kappa, v, v)
    stiff += eight.load * _crossing(eight)
    heavy = form(one, v, v) / 2
    free = np.linalg.svd((v.T @ kappa)[None, :])[2][1:].T
    eigenvalues: FloatArray = eigh(
        free.T @ stiff @ free, free.T @ heavy @ free, eigvals_only=True
    )
    return eigenvalues


def _panels() -> tuple[FloatArray, FloatArray]:
    """Return points and weights on 0 < s < 1/4, dense towards the crossing."""
    ends = np.r_[
        0.0, 0.25 * 0.5 ** np.arange(_HALVINGS, 1, -1), np.linspace(0.125, 0.25, 6)
    ]
    points, weights = leggauss(_GAUSS)
    half, middle = np.diff(ends) / 2, (ends[1:] + ends[:-1]) / 2
    s = middle[:, None] + half[:, None] * points
    return s.ravel(), (half[:, None] * weights).ravel()


def _trials(s: FloatArray, centre: int, mirror: int) -> tuple[FloatArray, ...]:
    """Return trial functions and two derivatives, each (n, m), of one symmetry."""
    parity = 0 if mirror > 0 else 1
    trials = [Chebyshev.basis(2 * j + parity, [0.0, 0.5]) for j in range(_TRIALS)]
    held = []
    if centre > 0:
        held.append([trial.deriv()(0.0) for trial in trials])
    if centre < 0 or mirror < 0:  # the two strands touch
        held.append([trial(0.0) for trial in trials])
    free = np.linalg.svd(np.array(held))[2][len(held) :].T
    return tuple(
        np.stack([(t.deriv(m) if m else t)(s) for t in trials], axis=1) @ free
        for m in range(3)
    )


def _normal_derivatives(
    zeta: np.ndarray,
    normal: np.ndarray,
    weights: FloatArray,
    values: FloatArray,
    mirror: int,
) -> FloatArray:
    """Return the outward derivatives (n, m) of the harmonic extensions of `values`.

    Extensions: real (symmetric about the axis) or imaginary parts of powers and of poles
    that cluster exponentially outside the corner, least squares on the edge.
    """
    tip = float(zeta.real.max())
    centred, j = 2 * zeta[:, None] / tip - 1, np.arange(_POWERS)
    poles = tip * np.exp(_SPREAD * (np.sqrt(np.arange(1, _POLES + 1)) - np.sqrt(_POLES)))
    gap = zeta[:, None] + poles
    functions = np.hstack([centred**j, poles / gap])
    slopes = np.hstack([2 / tip * j * centred ** np.maximum(j - 1, 0), -poles / gap**2])
    part = np.real if mirror > 0 else np.imag
    basis, derivatives = part(functions), part(slopes * normal[:, None])
    root = np.sqrt(weights)[:, None]
    sizes = np.linalg.norm(root * basis, axis=0)
    used = sizes > 0  # the imaginary part of a constant vanishes
    basis, derivatives = basis[:, used] / sizes[used], derivatives[:, used] / sizes[used]
    coefficients = np.linalg.lstsq(root * basis, root * values, rcond=1e-13)[0]
    found: FloatArray = derivatives @ coefficients
    return found


def _whole_loop(
    eight: FlatEight, s: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return kappa, dkappa/ds, and which lobe, +1 or -1, each (n,), at 0 < s < 1."""
    lobe = np.where(s < 0.5, 1.0, -1.0)
    within = s % 0.5
    quarter = np.minimum(within, 0.5 - within)
    kappa, slope = eight.quarter(quarter)[:2]
    return lobe * kappa, lobe * np.where(within < 0.25, slope, -slope), lobe


def _crossing(eight: FlatEight) -> FloatArray:
    """Return the form (m, m) of twice the area that moves with the point of crossing."""
    k = np.arange(1, _WAVES + 1)
    v_first = np.hstack([1.0, np.ones(_WAVES), np.zeros(_WAVES)])
    v_second = np.hstack([1.0, (-1.0) ** k, np.zeros(_WAVES)])
    # Strands t1, t2 displaced by v n cross where u1 + t1 d1 = u2 + t2 d2.
    # At the angles a and pi - a: t1 x t2 = sin 2a, n1 x t2 = n2 x t1 = cos 2a, n x t = -1.
    cross, normal = np.sin(2 * eight.angle), np.cos(2 * eight.angle)
    d1 = (-v_second - v_first * normal) / cross
    d2 = (v_second * normal + v_first) / cross
    form = np.outer(v_first, d1) - np.outer(v_second, d2)
    result: FloatArray = form + form.T
    return result
