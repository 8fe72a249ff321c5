"""All shapes of a regular cell on one curve, by the curvature in the middle of its sides.

A cell pulled outwards at each adhesion by a force f has one shape for each curvature c in
mid-side: an equation more, and f an unknown more. The curve of shapes over c knows nothing
of the substrate. A substrate of stiffness k_s holds the cell in the shape where
f = 2 k_s (1 - radius), so that

    k_s(c) = f(c) / (2 (1 - radius(c))),

and equilibria on a given substrate are the roots of it, folds its extrema. Lengths in any
unit, alpha = 1; with beta = 0 one curve of sigma = 1 serves all: its lengths are in units
of xi = (alpha / sigma)^(1/3).
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.cell.side import HalfSide, Jet, circle

_ITERATIONS = 25
_COEFFICIENTS, _MOST_COEFFICIENTS = 16, 256
# The last coefficients over the largest, at which a side is resolved.
_RESOLVED = 1e-13
_LARGEST_STEP = 0.1  # of c from one shape to the next, in units of 1 / radius


def free_energy(side: HalfSide, sigma: float, beta: float) -> Jet:
    """Return half a side's share of bending, film and line tension."""
    energy = side.bending().plus(side.area().scaled(sigma))
    return energy.plus(side.length().scaled(beta)) if beta else energy


@dataclass(frozen=True)
class Tethered:
    """A shape held by a force at each adhesion.

    Attributes
    ----------
    side : HalfSide
    sigma, beta : float, of film and cortex
    force : float, f >= 0 pulls outwards
    """

    side: HalfSide
    sigma: float
    beta: float
    force: float

    @property
    def kappa_mid(self) -> float:
        """The curvature c in the middle of a side."""
        return self.side.kappa_mid

    @cached_property
    def radius(self) -> float:
        """The distance of the adhesions from the centre."""
        return self.side.radius().value

    @cached_property
    def slope(self) -> tuple[FloatArray, float, float]:
        """dz/dc (m,), df/dc and dradius/dc along the curve."""
        m = len(self.side.z)
        system, radius_slope = _system(self, m)
        moved = np.linalg.solve(system, np.append(np.zeros(m), 1.0))
        return moved[:m], float(moved[m]), float(radius_slope @ moved[:m])

    @property
    def fold_radius(self) -> float:
        """The radius of the substrate's adhesions for which k_s(c) is extreme here.

        With adhesions at R instead of 1, dk_s/dc = 0 where f' (R - radius) + f radius' = 0.
        """
        _, force, radius = self.slope
        return self.radius - self.force * radius / force if force else np.inf

    def stiffness(self, rest: float) -> float:
        """Return k_s of a substrate with adhesions at radius `rest`, giving the force."""
        return self.force / (2 * (rest - self.radius))


def _system(shape: Tethered, m: int) -> tuple[FloatArray, FloatArray]:
    """Return the bordered second derivative (m + 1, m + 1), and the slope of the radius."""
    radius = shape.side.radius()
    energy = free_energy(shape.side, shape.sigma, shape.beta)
    system = np.zeros((m + 1, m + 1))
    system[:m, :m] = energy.curvature - 0.5 * shape.force * radius.curvature
    system[:m, m] = -0.5 * radius.slope
    system[m, :m] = shape.side.kappa_mid_slope()
    return system, radius.slope


def corrected(shape: Tethered, kappa_mid: float) -> Tethered | None:
    """Return the shape with this curvature in mid-side near another; None if lost."""
    side, force = shape.side, shape.force
    m = len(side.z)
    last = np.inf
    for _ in range(_ITERATIONS):
        trial = Tethered(side, shape.sigma, shape.beta, force)
        system, radius_slope = _system(trial, m)
        energy = free_energy(side, shape.sigma, shape.beta)
        off = np.append(
            energy.slope - 0.5 * force * radius_slope, side.kappa_mid - kappa_mid
        )
        try:
            step = np.linalg.solve(system, off)
        except np.linalg.LinAlgError:
            return None
        size = float(np.abs(step[:m]).max())
        z = side.z - step[:m]
        if not np.isfinite(z).all() or z[-1] <= 0:
            return None
        side, force = HalfSide(side.adhesions, z), force - float(step[m])
        # Newton's method has converged where its steps stop to shrink.
        if size < 1e-14 or (size < 1e-9 and size > 0.3 * last):
            return _resolved(Tethered(side, shape.sigma, shape.beta, force), kappa_mid)
        last = size
    return None


def is_resolved(side: HalfSide, smallest: float = _RESOLVED) -> bool:
    """Return whether the last coefficients are next to nothing beside the largest."""
    a = np.abs(side.z[:-1])
    return bool(a[-3:].max() <= smallest * max(float(a.max()), side.angle))


def _resolved(shape: Tethered, kappa_mid: float) -> Tethered | None:
    """Return the shape with twice the coefficients where it needs them."""
    n = len(shape.side.z) - 1
    if is_resolved(shape.side) or 2 * n > _MOST_COEFFICIENTS:
        return shape
    finer = Tethered(shape.side.refined(2 * n), shape.sigma, shape.beta, shape.force)
    return corrected(finer, kappa_mid)


class ShapeCurve:
    """The shapes of a regular cell over c, from the circle on; known ones are kept."""

    def __init__(self, adhesions: int, sigma: float = 1.0, beta: float = 0.0) -> None:
        """Start at the circle that needs no force: sigma R^3 + beta R^2 = 1, sigma > 0."""
        radius = _free_radius(sigma, beta)
        start = circle(adhesions, radius, _COEFFICIENTS)
        self.start = Tethered(start, sigma, beta, 0.0)
        # Sorted by c: a search through all of them would cost more than what it finds.
        self._known, self._places = [self.start], [self.start.kappa_mid]

    def at(self, kappa_mid: float) -> Tethered | None:
        """Return the shape with a curvature in mid-side; None if the curve ends before."""
        shape = self._nearest(kappa_mid)
        step = _LARGEST_STEP / shape.radius
        while shape.kappa_mid != kappa_mid:
            gap = kappa_mid - shape.kappa_mid
            c = kappa_mid if abs(gap) <= step else shape.kappa_mid + np.copysign(step, gap)
            after = self._next(shape, c)
            if after is None:
                step *= 0.25
                if step * shape.radius < 1e-6:
                    return None
                continue
            done = c == kappa_mid
            if not done or abs(gap) > 1e-3 * step:
                self._keep(after)
            if done:
                return after
            shape = after
        return shape

    def _nearest(self, kappa_mid: float) -> Tethered:
        after = bisect_left(self._places, kappa_mid)
        beside = self._known[max(after - 1, 0) : after + 1]
        return min(beside, key=lambda known: abs(known.kappa_mid - kappa_mid))

    def _keep(self, shape: Tethered) -> None:
        place = bisect_left(self._places, shape.kappa_mid)
        self._places.insert(place, shape.kappa_mid)
        self._known.insert(place, shape)

    @staticmethod
    def _next(shape: Tethered, kappa_mid: float) -> Tethered | None:
        moved, pulled, _ = shape.slope
        gap = kappa_mid - shape.kappa_mid
        side = HalfSide(shape.side.adhesions, shape.side.z + gap * moved)
        guess = Tethered(side, shape.sigma, shape.beta, shape.force + gap * pulled)
        return corrected(guess, kappa_mid)


def _free_radius(sigma: float, beta: float) -> float:
    """Return the radius of the circle in balance without springs."""
    largest = float(np.cbrt(1 / sigma))
    return float(brentq(lambda r: sigma * r**3 + beta * r**2 - 1, 0.0, 2 * largest))
