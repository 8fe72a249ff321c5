"""One side of a regular cell, by Legendre polynomials: its energies and their derivatives.

Of a cell with N adhesions and all their symmetry one half of a side is enough, from its
middle (s = 0) to an adhesion (s = h). With u = s / h its curvature is

    h kappa(u) = pi / N + sum_j a_j P_2j(u),     j = 1 ... n,

so that it turns by pi / N whatever the a_j are, and is even about the middle. The unknowns
are z = (a_1 ... a_n, h): no equation is left, the energy decides (Ritz's method). For a
smooth side the error falls faster than any power of 1 / n.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from eulerplateau.arrays import FloatArray


class Jet(NamedTuple):
    """A quantity of z (m,): its value, slope (m,) and second derivative (m, m)."""

    value: float
    slope: FloatArray
    curvature: FloatArray

    def scaled(self, factor: float) -> Jet:
        """Return the quantity times a number."""
        return Jet(factor * self.value, factor * self.slope, factor * self.curvature)

    def plus(self, other: Jet) -> Jet:
        """Return the sum with another quantity."""
        return Jet(
            self.value + other.value,
            self.slope + other.slope,
            self.curvature + other.curvature,
        )


@dataclass(frozen=True)
class Rule:
    """Polynomials and quadrature for half a side.

    Attributes
    ----------
    places, shares : (m,) float, Gauss's nodes u in (0, 1) and weights
    kappa : (m, n) float, P_2j at the nodes
    theta : (m, n) float, the integrals of P_2j from 0
    integral : (m, m) float, values at the nodes -> integrals from 0 to the nodes
    middle, end : (n,) float, P_2j at u = 0 and 1
    end_slope : (n,) float, dP_2j/du at u = 1
    squares : (n,) float, the integrals of P_2j^2 from 0 to 1
    """

    places: FloatArray
    shares: FloatArray
    kappa: FloatArray
    theta: FloatArray
    integral: FloatArray
    middle: FloatArray
    end: FloatArray
    end_slope: FloatArray
    squares: FloatArray


@lru_cache(maxsize=8)
def rule(n: int) -> Rule:
    """Return the rule for n polynomials, P_2 ... P_2n."""
    m = 2 * n + 24
    nodes, weights = legendre.leggauss(m)
    places, shares = 0.5 * (nodes + 1), 0.5 * weights
    degrees = 2 * np.arange(1, n + 1)
    values: FloatArray = legendre.legvander(places, 2 * n + 1).astype(np.float64)
    theta = (values[:, degrees + 1] - values[:, degrees - 1]) / (2 * degrees + 1)
    # On (0, 1) the integral of P_k(2 u - 1) from 0 is (P_k+1 - P_k-1) / (4 k + 2) there.
    shifted = legendre.legvander(nodes, m)
    k = np.arange(1, m)
    raised = np.empty((m, m))
    raised[:, 0] = places
    raised[:, 1:] = (shifted[:, 2:] - shifted[:, :-2]) / (4 * k + 2)
    transform = shifted[:, :m].T * shares * (2 * np.arange(m) + 1)[:, None]
    return Rule(
        places=places,
        shares=shares,
        kappa=values[:, degrees],
        theta=theta,
        integral=raised @ transform,
        middle=legendre.legvander(np.zeros(1), 2 * n)[0, degrees],
        end=np.ones(n),
        end_slope=0.5 * degrees * (degrees + 1.0),
        squares=1.0 / (2 * degrees + 1),
    )


@dataclass(frozen=True)
class HalfSide:
    """Half a side of a cell with N regular adhesions; lengths in any unit, alpha = 1.

    Attributes
    ----------
    adhesions : int, N >= 2
    z : (n + 1,) float, the coefficients a_j and the length h
    """

    adhesions: int
    z: FloatArray

    @property
    def rule(self) -> Rule:
        """The polynomials and the quadrature."""
        return rule(len(self.z) - 1)

    @property
    def angle(self) -> float:
        """The angle pi / N by which it turns."""
        return np.pi / self.adhesions

    @property
    def h(self) -> float:
        """Its length."""
        return float(self.z[-1])

    @cached_property
    def theta(self) -> FloatArray:
        """The tangent's angle at the nodes; 0 at the middle of the side."""
        theta: FloatArray = self.angle * self.rule.places + self.rule.theta @ self.z[:-1]
        return theta

    @property
    def kappa(self) -> FloatArray:
        """The curvature at the nodes, positive where the cell is convex."""
        kappa: FloatArray = (self.angle + self.rule.kappa @ self.z[:-1]) / self.h
        return kappa

    @property
    def kappa_mid(self) -> float:
        """The curvature in the middle of the side."""
        return float(self.angle + self.rule.middle @ self.z[:-1]) / self.h

    @property
    def kappa_adhesion(self) -> float:
        """The curvature at the adhesion."""
        return float(self.angle + self.rule.end @ self.z[:-1]) / self.h

    @property
    def kappa_slope(self) -> float:
        """dkappa/ds at the adhesion, before it."""
        return float(self.rule.end_slope @ self.z[:-1]) / self.h**2

    def kappa_mid_slope(self) -> FloatArray:
        """Return the derivative of kappa_mid by z."""
        return np.append(self.rule.middle, -self.kappa_mid) / self.h

    def bending(self) -> Jet:
        """Return the integral of kappa^2 ds."""
        a, h, squares = self.z[:-1], self.h, self.rule.squares
        square = self.angle**2 + float(squares @ a**2)
        slope = np.append(2 * squares * a / h, -square / h**2)
        curvature = np.diag(np.append(2 * squares / h, 2 * square / h**3))
        curvature[-1, :-1] = curvature[:-1, -1] = -2 * squares * a / h**2
        return Jet(square / h, slope, curvature)

    def length(self) -> Jet:
        """Return h."""
        m = len(self.z)
        return Jet(self.h, np.eye(m)[-1], np.zeros((m, m)))

    @cached_property
    def _chord(self) -> Jet:
        """The integral of cos(theta) du, of the coefficients alone."""
        w, basis = self.rule.shares, self.rule.theta
        cosine, sine = np.cos(self.theta), np.sin(self.theta)
        return Jet(
            float(w @ cosine),
            -(w * sine) @ basis,
            -(basis.T * (w * cosine)) @ basis,
        )

    @cached_property
    def _bulge(self) -> Jet:
        """The area between side and chord over h^2: int sin(theta) int_0 cos(theta)."""
        w, basis, integral = self.rule.shares, self.rule.theta, self.rule.integral
        cosine, sine = np.cos(self.theta), np.sin(self.theta)
        along = integral @ cosine
        below = integral @ sine
        rest = w @ sine - below
        slope = (w * (along * cosine - rest * sine)) @ basis
        moved = integral @ (sine[:, None] * basis)
        cross = (basis * (w * cosine)[:, None]).T @ moved
        alone = -(basis.T * (w * (along * sine + rest * cosine))) @ basis
        return Jet(float(w @ (sine * along)), slope, alone - cross - cross.T)

    def radius(self) -> Jet:
        """Return the distance of the adhesion from the centre."""
        chord = self._chord
        return _times_h(chord.scaled(1 / np.sin(self.angle)), self.h, 1)

    def area(self) -> Jet:
        """Return the area between centre, middle of the side and adhesion."""
        chord, bulge = self._chord, self._bulge
        half = 0.5 / np.tan(self.angle)
        square = Jet(
            half * chord.value**2,
            2 * half * chord.value * chord.slope,
            2 * half * (chord.value * chord.curvature + np.outer(chord.slope, chord.slope)),
        )
        return _times_h(square.plus(bulge), self.h, 2)

    def springs(self, stiffness: float) -> Jet:
        """Return k_s (1 - radius)^2 / 2: half the spring of the adhesion, at radius 1."""
        radius = self.radius()
        gap = 1 - radius.value
        return Jet(
            0.5 * stiffness * gap**2,
            -stiffness * gap * radius.slope,
            stiffness * (np.outer(radius.slope, radius.slope) - gap * radius.curvature),
        )

    def refined(self, n: int) -> HalfSide:
        """Return the same side with n coefficients."""
        a = np.zeros(n)
        kept = min(n, len(self.z) - 1)
        a[:kept] = self.z[:kept]
        return HalfSide(self.adhesions, np.append(a, self.h))

    def points(self, u: FloatArray) -> FloatArray:
        """Return places (k, 2) at u = s / h in [-1, 1], the cell's centre at the origin.

        The middle of the side lies below the centre; u = 1 is counter-clockwise from it.
        """
        u = np.asarray(u, dtype=np.float64)
        nodes, shares = legendre.leggauss(len(self.rule.places) + 16)
        inner = 0.5 * u[:, None] * (nodes + 1)
        angle = self.tangent_angle(inner)
        x = 0.5 * self.h * u * (np.cos(angle) @ shares)
        y = 0.5 * self.h * u * (np.sin(angle) @ shares)
        whole = 0.5 * (nodes + 1)
        rise = 0.5 * self.h * float(np.sin(self.tangent_angle(whole)) @ shares)
        apothem = self.radius().value * np.cos(self.angle) + rise
        return np.stack([x, y - apothem], axis=-1)

    def tangent_angle(self, u: FloatArray) -> FloatArray:
        """Return the tangent's angle at u in [-1, 1], 0 in the middle of the side."""
        n = len(self.z) - 1
        degrees = 2 * np.arange(1, n + 1)
        series = np.zeros(2 * n + 2)
        series[degrees + 1] += self.z[:-1] / (2 * degrees + 1)
        series[degrees - 1] -= self.z[:-1] / (2 * degrees + 1)
        angle: FloatArray = self.angle * u + legendre.legval(u, series)
        return angle

    def curvature(self, u: FloatArray) -> FloatArray:
        """Return the curvature at u in [-1, 1]."""
        series = np.zeros(2 * len(self.z) - 1)
        series[0] = self.angle
        series[2::2] = self.z[:-1]
        kappa: FloatArray = np.asarray(
            legendre.legval(u, series) / self.h, dtype=np.float64
        )
        return kappa


def circle(adhesions: int, radius: float, n: int = 16) -> HalfSide:
    """Return the half side of a circle."""
    return HalfSide(adhesions, np.append(np.zeros(n), np.pi * radius / adhesions))


def _times_h(shape: Jet, h: float, power: int) -> Jet:
    """Return h^power times a quantity of the coefficients, as one of z."""
    factor, by_h = h**power, power * h ** (power - 1)
    m = len(shape.slope) + 1
    curvature = np.empty((m, m))
    curvature[:-1, :-1] = factor * shape.curvature
    curvature[-1, :-1] = curvature[:-1, -1] = by_h * shape.slope
    curvature[-1, -1] = power * (power - 1) * shape.value
    slope = np.append(factor * shape.slope, by_h * shape.value)
    return Jet(factor * shape.value, slope, curvature)
