"""The least squares of an outline beside one kind of curve."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import exp, inf
from typing import Generic

import numpy as np
from scipy.optimize import least_squares

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.outline.curves import C, rotation
from eulerplateau.exact.outline.matching import Matching
from eulerplateau.exact.outline.noise import Noise, estimate
from eulerplateau.exact.outline.starts import Start

EXACT, ROUGH = 1e-15, 1e-4
_EVALUATIONS = 60


@dataclass(frozen=True)
class Found(Generic[C]):
    """A least-squares fit; the points are in a unit in which they are of order one."""

    matching: Matching[C]
    theta: FloatArray
    cost: float

    def refined(self) -> Found[C]:
        """Return the fit to rounding."""
        return _squares(self.matching, self.theta, EXACT)

    @property
    def curves(self) -> C:
        """The kind of curve."""
        return self.matching.curves

    @cached_property
    def spread(self) -> FloatArray:
        """The inverse (p, p) of J'J."""
        slopes = self.matching.at(self.theta).slopes
        return np.asarray(np.linalg.inv(slopes.T @ slopes), dtype=np.float64)

    @cached_property
    def noise(self) -> Noise:
        """The noise of the distances that are left."""
        matched = self.matching.at(self.theta)
        size = exp(self.theta[self.curves.numbers])
        period = size if self.curves.closed else inf
        return estimate(matched.distances, matched.slopes, matched.t * size, period)

    def line(self) -> FloatArray:
        """Return the fitted line (m, 2), in the unit of the points of the matching."""
        count = self.curves.numbers
        log_size, *place, angle = self.theta[count:]
        t = self.matching.near
        grid = np.linspace(t.min(), t.max(), 600)
        if self.curves.closed:
            grid = np.linspace(0.0, 1.0, 601)
        found = self.curves.curve(self.theta[:count]).points(grid)
        outwards = np.stack([np.sin(found.angle), -np.cos(found.angle)], -1)
        x = exp(log_size) * found.x + self.matching.offset * outwards
        return np.asarray(x @ rotation(angle).T + place)


def least(
    start: Start[C], measured: FloatArray, offset: float, accuracy: float
) -> Found[C]:
    """Return the least sum of squares reached from a start."""
    matching = Matching(measured, start.curves, start.near, offset)
    return _squares(matching, start.unknowns, accuracy)


def _squares(matching: Matching[C], theta: FloatArray, accuracy: float) -> Found[C]:
    """Return the least squares reached from unknowns (p,).

    Feet are sought anew about where the fit has put them.
    """
    found = least_squares(
        lambda u: matching.at(u).distances,
        theta,
        jac=lambda u: matching.at(u).slopes,
        method="lm",
        x_scale="jac",
        xtol=accuracy,
        ftol=accuracy,
        gtol=accuracy,
        max_nfev=_EVALUATIONS,
    )
    theta, cost = found.x, 2 * float(found.cost)
    theta, t = matching.curves.settled(theta, matching.at(theta).t)
    return Found(matching.followed(t), theta, cost)
