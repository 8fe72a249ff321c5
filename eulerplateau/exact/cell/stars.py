"""Stars: purely concave cells whose sides meet in cusps, with protrusions or without.

At a cusp two sides touch, kappa = 0, and both run radially; what they press on each
other is normal to them, so that a straight protrusion of two strands that leads on to the
adhesion carries no force and the adhesion is not extended (beta = 0). Between the cusps
the shape is the same for all contractilities, in units of xi = (alpha / sigma)^(1/3). It
just fits between the adhesions at sigma_p; above, it is smaller by (sigma_p / sigma)^(1/3)
and the rest is protrusion (eq. protrusion). At the tips a protrusion turns back on itself:
that costs an infinite bending energy, which is left out here.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.optimize import brentq

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.checks import finite, whole_number

_NODES = 80


@dataclass(frozen=True)
class Star:
    """The part of a star between its cusps, in units of xi; alpha = sigma = 1.

    Attributes
    ----------
    adhesions : int, N >= 3
    kappa_mid : float, < 0, in the middle of a side
    kappa_slope : float, dkappa/ds at the cusp, before it
    radius : float, of the cusps
    side_length : float, of a side from cusp to cusp
    """

    adhesions: int
    kappa_mid: float
    kappa_slope: float
    radius: float
    side_length: float

    @property
    def sigma_p(self) -> float:
        """sigma_hat at which the cusps reach the adhesions."""
        return self.radius**3

    def protrusion(self, sigma_hat: float) -> float:
        """Return the length of a protrusion, in R_0, at sigma_hat >= sigma_p."""
        sigma = finite("sigma_hat", sigma_hat)
        if sigma < self.sigma_p:
            problem = (
                f"found {sigma:g}; below sigma_p = {self.sigma_p:.6g} there is no star"
            )
            raise SpecError("sigma_hat", problem)
        return 1 - float(np.cbrt(self.sigma_p / sigma))

    def half_side(self, count: int = 200) -> FloatArray:
        """Return places (count, 2) from the middle of a side to a cusp, in xi.

        The centre is the origin; the side lies below it.
        """
        _, _, x, y = _half_side(self.kappa_mid, np.linspace(0, 1, count))
        angle = np.pi / self.adhesions
        return np.stack([x, y - y[-1] - self.radius * np.cos(angle)], axis=-1)


@lru_cache(maxsize=32)
def star(adhesions: int) -> Star:
    """Return the star of N adhesions; SpecError below 3, where sides would be straight."""
    n = whole_number("adhesions", adhesions, 3)
    turn = -(0.5 * np.pi - np.pi / n)
    end = np.ones(1)

    def excess(c: float) -> float:
        return float(_half_side(c, end)[1][-1]) - turn

    c = float(brentq(excess, -1.5, -1e-6, xtol=1e-15, rtol=1e-15))
    s, _, x, _ = _half_side(c, end)
    slope = float(np.sqrt(_slope_squared(np.zeros(1), c)[0]))
    radius = float(x[-1] / np.sin(np.pi / n))
    return Star(n, c, slope, radius, 2 * float(s[-1]))


def _slope_squared(kappa: FloatArray, c: float) -> FloatArray:
    """Return kappa'^2, 0 at kappa = c: the first integral of 2 kappa'' + kappa^3 = 1."""
    rise = kappa - c
    squared: FloatArray = rise * (1 - 0.25 * (kappa + c) * (kappa**2 + c**2))
    return squared


def _half_side(
    c: float, shares: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return s, theta, x, y (k,) where kappa = c (1 - w^2), for w in [0, 1].

    dkappa / kappa' is smooth in w although kappa' is zero at the start.
    """
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    part, share = 0.5 * (nodes + 1), 0.5 * weights

    def ds(w: FloatArray) -> FloatArray:
        kappa = c * (1 - w**2)
        slope: FloatArray = 2 * np.sqrt(-c / (1 - 0.25 * (kappa + c) * (kappa**2 + c**2)))
        return slope

    def theta(w: FloatArray) -> FloatArray:
        inner = w[..., None] * part
        turned: FloatArray = w * ((ds(inner) * c * (1 - inner**2)) @ share)
        return turned

    places = shares[:, None] * part
    angle, step = theta(places), ds(places) * shares[:, None]
    return (
        step @ share,
        theta(shares),
        (step * np.cos(angle)) @ share,
        (step * np.sin(angle)) @ share,
    )
