"""The paper's twisted family (eq. eight) and Enneper's surface beside computed films."""

from __future__ import annotations

from math import pi

import numpy as np
from scipy.optimize import minimize_scalar

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal import TWISTED, ConformalFilm, make_basis
from eulerplateau.exact.conformal.energy import terms

# Points of the loop that are compared, and quadrature of the family's area.
_POINTS, _ANGLES, _RADII = 400, 400, 40


def family_fit(films: list[ConformalFilm]) -> list[dict[str, float]]:
    """Return, for each film, the nearest member t of the paper's family and its energy.

    The loops have the same length and are compared point by point in arc length: `rms` is
    the root mean square distance in L. `not_enneper` is how much of the loop is not in the
    harmonics 1, 3 (x, y) and 2 (z) of Enneper's surface, relative, in the tangent.
    """
    return [_fit(film) for film in films]


def _fit(film: ConformalFilm) -> dict[str, float]:
    x = _by_arc_length(film.curve.x, film.curve.x1)
    sign = np.sign(film.curve.x[len(film.curve.x) // 8, 2])

    def distance(t: float) -> float:
        return float(np.sqrt(((x - _loop(sign * t)) ** 2).sum(axis=1).mean()))

    best = minimize_scalar(distance, bounds=(0.0, 1.0), method="bounded")
    return {
        "sigma_hat": film.load,
        "t": float(best.x),
        "rms": float(best.fun),
        "energy": film.energy,
        "family_energy": _energy(float(best.x), film.load),
        "not_enneper": _not_enneper(film),
    }


def _not_enneper(film: ConformalFilm) -> float:
    """Return the share of harmonics in theta that Enneper's surface does not have."""
    basis = make_basis(film.basis.harmonics, film.basis.family, 1.0)
    tangent = (basis.wavenumbers * basis.transfer(film.basis, film.coefficients)) ** 2
    other = np.ones(basis.size, dtype=bool)
    for part, own in zip(basis.slices, ((1, 3), (1, 3), (2,)), strict=True):
        other[part] = np.isin(basis.wavenumbers[part], own, invert=True)
    return float(np.sqrt(tangent[other].sum() / tangent.sum()))


def _coefficients(t: float) -> FloatArray:
    """Return the family's loop of radius 1: harmonics 1 of x and y, 2 of z."""
    basis = _BASIS
    c = np.zeros(basis.size)
    x, y, z = basis.slices
    c[x.start], c[y.start], c[z.start] = 1 + t**2, 1 - t**2, t
    return c


_BASIS = make_basis(64, TWISTED)


def _loop(t: float) -> FloatArray:
    curve = _BASIS.curve(_coefficients(t))
    return _by_arc_length(curve.x, curve.x1) / terms(_BASIS, _coefficients(t)).length


def _energy(t: float, load: float) -> float:
    """Return the energy of the family's surface with its loop scaled to length 1."""
    loop = terms(_BASIS, _coefficients(t))
    nodes, weights = np.polynomial.legendre.leggauss(_RADII)
    r, phi = (nodes[:, None] + 1) / 2, 2 * pi * np.arange(_ANGLES) / _ANGLES
    a, b, zero = 1 + t**2, 1 - t**2, 0 * r * phi
    by_r = (a * np.cos(phi) + zero, b * np.sin(phi) + zero, 2 * t * r * np.sin(2 * phi))
    by_phi = (-a * r * np.sin(phi), b * r * np.cos(phi), 2 * t * r**2 * np.cos(2 * phi))
    density = np.linalg.norm(np.cross(np.stack(by_r, -1), np.stack(by_phi, -1)), axis=-1)
    area = float(weights @ density.sum(axis=1)) * pi / _ANGLES
    return load * area / loop.length**2 + loop.bending * loop.length


def _by_arc_length(x: FloatArray, x1: FloatArray) -> FloatArray:
    """Return points (n, 3) at equal arc lengths from the first of closed points (m, 3)."""
    from scipy.interpolate import CubicSpline

    n = len(x)
    speed = np.fft.rfft(np.linalg.norm(x1, axis=1))
    k = np.arange(1, len(speed))
    phi = 2 * pi * np.arange(n + 1) / n
    # The integral of the speed's Fourier series.
    waves = np.zeros_like(speed)
    waves[1:] = speed[1:] / (1j * k)
    s = np.fft.irfft(waves, n=n)
    s = np.append(s, s[0]) - s[0] + speed[0].real / n * phi
    spline = CubicSpline(s, np.vstack([x, x[:1]]), bc_type="periodic")
    found: FloatArray = spline(s[-1] * np.arange(_POINTS) / _POINTS)
    return found
