"""Grids on the circle that resolve both ends of a long film, by Jacobi's amplitude.

The conformal image of a film with a narrow waist crowds the ends of its two lobes into two
arcs of the circle, at theta = 0 and pi, exponentially short in length over width. With

    theta = pi/2 + am(2 K / pi (phi - pi/2) | 1 - crowding^2),

the conformal map of a rectangle, functions of phi stay smooth. Everything is computed from
the complementary parameter, so that a crowding of 1e-12 costs no digits.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf, pi, sqrt

import numpy as np
from scipy.special import elliprf

from eulerplateau.arrays import FloatArray

# Terms of the series beyond exp(-_DIGITS) are left out.
_DIGITS = 40.0


@dataclass(frozen=True)
class Grading:
    """The map from phi to the conformal angle theta; `crowding` 1 is the identity.

    `crowding` is the square root of the complementary parameter, in (0, 1]: about the
    share of the circle that either end of the film takes.
    """

    crowding: float

    @cached_property
    def stretch(self) -> float:
        """2 K / pi, the elliptic argument per unit of phi."""
        return 1 / _mean(1.0, self.crowding)

    @cached_property
    def height(self) -> float:
        """Pi K' / (2 K), of the cylinder that the disk is to phi (sector.py); inf for 1."""
        if self.crowding == 1.0:
            return inf
        k = sqrt((1 - self.crowding) * (1 + self.crowding))
        return pi / 2 * _mean(1.0, self.crowding) / _mean(1.0, k)

    def theta(self, phi: FloatArray) -> FloatArray:
        """Return the conformal angles (...) at phi (...), within pi of them."""
        sn, cn, _ = self.functions(self.stretch * (phi - pi / 2))
        theta = pi / 2 + np.arctan2(sn, cn)
        return theta + 2 * pi * np.round((phi - theta) / (2 * pi))

    def rate(self, phi: FloatArray) -> FloatArray:
        """Return d theta / d phi (...) at phi (...)."""
        rate: FloatArray = self.functions(self.stretch * (phi - pi / 2))[2]
        return self.stretch * rate

    def functions(self, u: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return sn, cn and dn (...) at real arguments u (...).

        Sums over the poles' images: sech and tanh of period 2 K, fast for any crowding
        because their decay length, 2 K' / pi, is short where K is not.
        """
        if self.crowding == 1.0:
            return np.sin(u), np.cos(u), np.ones_like(u)
        k = sqrt((1 - self.crowding) * (1 + self.crowding))
        period, c = pi * self.stretch, _mean(1.0, k)
        turns = np.round(u / period)
        sign = 1 - 2 * (turns % 2)
        v = c * (u - period * turns)
        sn, cn, dn = np.tanh(v), _sech(v), _sech(v)
        for n in range(1, int(_DIGITS / (c * period)) + 2):
            shift, alternate = c * period * n, (-1) ** n
            pair = _sech(v - shift) + _sech(v + shift)
            sn = sn + alternate * (np.tanh(v - shift) + np.tanh(v + shift))
            cn, dn = cn + alternate * pair, dn + pair
        return sign * sn * c / k, sign * cn * c / k, c * dn

    def phi(self, sn: FloatArray, cn: FloatArray) -> FloatArray:
        """Return phi (...) where theta - pi/2 has the sine `sn` and the cosine `cn`."""
        if self.crowding == 1.0:
            return pi / 2 + np.arctan2(sn, cn)
        u = sn * elliprf(cn**2, cn**2 + (self.crowding * sn) ** 2, np.ones_like(sn))
        # Legendre's F from 0 to pi/2; beyond, from its symmetry about pi/2.
        u = np.where(cn < 0, pi * self.stretch - u, u)
        phi: FloatArray = pi / 2 + u / self.stretch
        return phi


def dirichlet_form(grading: Grading, points: int) -> FloatArray:
    """Return A (points, points): x^T A x / 2 is half the integral of |grad u|^2.

    u is the harmonic extension of a function of theta that takes the values x at
    phi = 2 pi j / points, j = 0, 1, ...; exact in the limit of many points, faster than
    any power. Douglas (1931):

        D = 1/(16 pi) oint oint |x - x'|^2 / sin^2((theta - theta')/2) dtheta dtheta'.

    The integrand is smooth, so the trapezoidal rule over pairs at odd distances, which
    avoids 0/0, is spectrally accurate; tan((theta - theta')/2) = dn(s) sn(d)/cn(d) with
    the arguments' mean s and half-difference d (addition theorem) loses no digits.
    """
    index = np.arange(points)
    half_step = grading.stretch * pi / points
    sums = np.arange(2 * points - 1, dtype=np.float64)
    middle = half_step * sums - grading.stretch * pi / 2
    dn_middle = grading.functions(middle)[2]
    sn, cn, _ = grading.functions(half_step * sums[:points])
    cotangent = np.divide(cn, sn, out=np.zeros_like(cn), where=index > 0)
    rate = grading.rate(2 * pi * sums[:points] / points)
    distance = np.abs(index[:, None] - index)
    kernel = 1 + (cotangent[distance] / dn_middle[index[:, None] + index]) ** 2
    kernel *= rate[:, None] * rate * (distance % 2)
    form: FloatArray = -kernel * (2 * pi / points) ** 2 / (2 * pi)
    form[index, index] = -form.sum(axis=1)
    return form


def _sech(v: FloatArray) -> FloatArray:
    # exp overflows where sech is zero to all digits.
    sech: FloatArray = 1 / np.cosh(np.clip(v, -700, 700))
    return sech


def _mean(a: float, b: float) -> float:
    """Return the arithmetic-geometric mean of positive numbers."""
    while abs(a - b) > 1e-15 * a:
        a, b = (a + b) / 2, sqrt(a * b)
    return (a + b) / 2
