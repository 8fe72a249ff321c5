"""The load, the number of lobes and the size of a film whose outline was measured.

Orthogonal distances of the points from the centreline, or from its parallel at half the
line's diameter, are fitted by least squares. The interval of the load is that of the
profile of the sum of squares, which rises by q^2 V / (J'J)^-1: V is the variance of the
amplitude where noise is alike along the outline (noise.py), q Student's quantile. Those of
size and surface tension are to first order, in their logarithms.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import exp, inf, log, sqrt

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares
from scipy.special import fdtri, stdtrit

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.checks import finite, points as checked_points, whole_number
from eulerplateau.exact.estimates import Estimate
from eulerplateau.exact.outline.curves import LARGEST, C, Lobes
from eulerplateau.exact.outline.least import EXACT, ROUGH, Found, least
from eulerplateau.exact.outline.noise import Noise
from eulerplateau.exact.outline.starts import (
    counter_clockwise,
    racket_start,
    round_start,
    starts,
)
from eulerplateau.exact.planar import LOBES
from eulerplateau.exact.profiles import Box, Profile

_FEWEST = 16
# Noise below this part of the size is rounding.
_ROUNDING = 1e-13
# What is left of another curve's outline: few changes of side, however many points there
# are, or points farther off than a tracing, over the line's length across.
_FEW_SIDES, _SIDES_PER_POINT, _FAR = 8, 0.2, 0.02


@dataclass(frozen=True)
class OutlineFit:
    """What an outline says of its film.

    Attributes
    ----------
    lobes : int; None of a circle and of a racket
    sigma_hat : Estimate of the load; of a circle 0 to an upper bound; None of a racket
    size : Estimate of L, of a racket of (EI / sigma)^(1/3), in the unit of the points
    strength : Estimate of sigma / alpha, in that unit to the power of -3
    noise : of the points: their deviation, and along which length it is alike
    level : of the intervals
    curve : (m, 2), the fitted line of which the points are: centre or outer edge
    arc, distances : (n,), where on it the points lie, and how far outwards of it
    """

    lobes: int | None
    sigma_hat: Estimate | None
    size: Estimate
    strength: Estimate
    noise: Noise
    level: float
    curve: FloatArray = field(repr=False, compare=False)
    arc: FloatArray = field(repr=False, compare=False)
    distances: FloatArray = field(repr=False, compare=False)

    @property
    def is_circle(self) -> bool:
        """Whether the outline cannot be told from a circle."""
        return self.sigma_hat is not None and self.lobes is None

    @property
    def is_exact(self) -> bool:
        """Whether the points lie on the line but for rounding."""
        return bool(np.abs(self.distances).max() <= _ROUNDING * self._across)

    @property
    def is_misfit(self) -> bool:
        """Whether what is left of the points is no noise: they are of another curve.

        They lie on one side of the line over an eighth of it, again and again, or their
        deviation is 2 % of what it measures across.
        """
        if self.is_exact:
            return False
        sides = np.count_nonzero(np.diff(np.sign(self.distances)))
        few = sides <= min(_FEW_SIDES, _SIDES_PER_POINT * len(self.distances))
        return bool(few or self._deviation > _FAR * self._across)

    def is_farther_than(self, other: OutlineFit) -> bool:
        """Whether the same points lie much nearer to another fit."""
        return not self.is_exact and self._deviation > sqrt(2) * other._deviation

    @property
    def _deviation(self) -> float:
        return float(np.sqrt(np.mean(self.distances**2)))

    @property
    def _across(self) -> float:
        return float(np.ptp(self.curve, axis=0).max())


def fit_outline(
    points: ArrayLike,
    lobes: int | None = None,
    diameter: float | None = None,
    level: float = 0.95,
) -> OutlineFit:
    """Fit a planar film to the points (n, 2) of its outline, in their order round it.

    Parameters
    ----------
    points : (n, 2)
        In any unit, place and orientation, evenly spaced or not; the last may be the first.
    lobes : int, by default the likeliest number
    diameter : float, in the unit of the points
        Of the line, where they lie on its outer edge; by default they lie on its centre.
    level : float, of the intervals

    Raises
    ------
    SpecError
        If an argument is wrong, or the points are too few.
    """
    _check_level(level)
    measured, unit = _measured(points)
    measured = counter_clockwise(measured)
    offset = _offset(diameter, unit)
    if lobes is not None:
        lobes = whole_number("lobes", lobes, LOBES[0], LOBES[-1])
    rough = [least(s, measured, offset, ROUGH) for s in starts(measured, offset, lobes)]
    best = min(rough, key=lambda one: one.cost).refined()
    circle = _circle(measured, offset, best)
    told = _told(best, circle, level, len(LOBES) if lobes is None else 1)
    if not told and best.curves.n != 2:
        best = least(round_start(2, measured, offset), measured, offset, EXACT)
    return _lobed(best, unit, level, told)


def fit_racket(
    points: ArrayLike, diameter: float | None = None, level: float = 0.95
) -> OutlineFit:
    """Fit a racket's head to points (n, 2) that run from one strand round it to the other.

    Arguments are those of `fit_outline`, and so is what is raised.
    """
    _check_level(level)
    measured, unit = _measured(points)
    x, y = (measured - (measured[0] + measured[-1]) / 2).T
    if float(x[:-1] @ y[1:] - y[:-1] @ x[1:]) < 0:
        measured = measured[::-1]
    offset = _offset(diameter, unit)
    found = least(racket_start(measured), measured, offset, EXACT)
    noise = found.noise
    size = _logarithmic(found.theta[0] + log(unit), noise.covariance[0, 0], noise, level)
    # sigma / alpha = 2 sigma / EI.
    strength = Estimate(*(2 * side**-3 for side in (size.value, size.high, size.low)))
    return OutlineFit(None, None, size, strength, *_rest(found, unit, level))


def _check_level(level: float) -> None:
    if not 0 < level < 1:
        raise SpecError("level", f"found {level:g}; should lie between 0 and 1")


def _measured(given: ArrayLike) -> tuple[FloatArray, float]:
    """Return points in a unit in which they are of order one, and that unit; SpecError."""
    x = checked_points("points", given, (2,))
    if len(x) > 1 and np.array_equal(x[0], x[-1]):
        x = x[:-1]
    keep = np.concatenate([[True], (np.diff(x, axis=0) != 0).any(axis=1)])
    x = x[keep]
    if len(x) < _FEWEST:
        raise SpecError("points", f"found {len(x)} different; should be {_FEWEST} or more")
    unit = float(np.ptp(x, axis=0).max())
    return x / unit, unit


def _offset(diameter: float | None, unit: float) -> float:
    return 0.0 if diameter is None else finite("diameter", diameter) / 2 / unit


def _circle(measured: FloatArray, offset: float, best: Found[Lobes]) -> float:
    """Return the sum of squares of a circle."""
    log_size, *place, _ = best.theta[best.curves.numbers :]

    def distances(u: FloatArray) -> FloatArray:
        return np.asarray(np.hypot(*(measured - u[:2]).T) - u[2])

    first = [*place, exp(log_size) / 2 / np.pi + offset]
    found = least_squares(distances, first, method="lm", xtol=EXACT, ftol=EXACT)
    return 2 * float(found.cost)


def _rise(found: Found[Lobes], noise: Noise) -> float:
    """Return by how much the sum of squares rises where the amplitude errs by its error."""
    size = exp(found.theta[1])
    rise = float(noise.covariance[0, 0] / found.spread[0, 0])
    return max(rise, (_ROUNDING * size) ** 2)


def _told(found: Found[Lobes], circle: float, level: float, tried: int) -> bool:
    """Return whether lobes can be told from a circle with noise, so many having been tried.

    They have two unknowns more: an amplitude and an angle.
    """
    noise = found.noise
    gained = (circle - found.cost) / _rise(found, noise) / 2
    return gained > float(fdtri(2, noise.dof, 1 - (1 - level) / tried))


def _lobed(found: Found[Lobes], unit: float, level: float, told: bool) -> OutlineFit:
    """Return what a fitted film of lobes says, or a circle that could be one."""
    curves, noise = found.curves, found.noise
    quantile = float(stdtrit(noise.dof, (1 + level) / 2))
    low, high = _amplitudes(found, quantile**2 * _rise(found, noise))
    amplitude = float(found.theta[0])
    loads = [curves.load(a) if a > 0 else 0.0 for a in (amplitude, low, high)]
    size = _logarithmic(found.theta[1] + log(unit), noise.covariance[1, 1], noise, level)
    load = Estimate(*loads) if told else Estimate(0.0, 0.0, loads[2])
    return OutlineFit(
        curves.n if told else None,
        load,
        size,
        _strength(load, size, amplitude, noise.covariance),
        *_rest(found, unit, level),
    )


def _amplitudes(found: Found[Lobes], rise: float) -> tuple[float, float]:
    """Return the ends of the amplitude's interval, 0 and infinite where there is none."""
    count = len(found.theta)
    low, high = np.full(count, -inf), np.full(count, inf)
    low[0], high[0] = 0.0, sqrt(LARGEST)

    def model(thetas: FloatArray) -> tuple[FloatArray, FloatArray]:
        matched = [found.matching.at(theta) for theta in thetas]
        return np.array([m.distances for m in matched]), np.array(
            [m.slopes for m in matched]
        )

    box = Box(low, high)
    profile = Profile(model, box, box, found.theta, found.cost)
    ((first, last),) = profile.ends([0], rise, found.spread, found.theta[None])
    return max(float(first), 0.0), float(last)


def _strength(
    load: Estimate, size: Estimate, amplitude: float, covariance: FloatArray
) -> Estimate:
    """Return sigma / alpha = load / size^3; its interval is that of the load, rescaled.

    By as much as the logarithm errs more, or less, than the load's: both err together.
    """
    value, cube = load.value / size.value**3, size.value**3
    if not load.low > 0 or not load.high < inf:
        return Estimate(value, load.low / cube, load.high / cube)
    # Of log load by the amplitude, and of -3 log size.
    by = np.array([2 * amplitude / (1 + amplitude**2), -3.0])
    together = by @ covariance[:2, :2] @ by / (by[0] ** 2 * covariance[0, 0])
    low, high = (
        value * exp(sqrt(together) * log(end / load.value)) for end in (load.low, load.high)
    )
    return Estimate(value, low, high)


def _logarithmic(logarithm: float, variance: float, noise: Noise, level: float) -> Estimate:
    """Return a number and its interval by the variance of its logarithm."""
    reach = float(stdtrit(noise.dof, (1 + level) / 2)) * sqrt(max(variance, 0.0))
    return Estimate(exp(logarithm), exp(logarithm - reach), exp(logarithm + reach))


def _rest(
    found: Found[C], unit: float, level: float
) -> tuple[Noise, float, FloatArray, FloatArray, FloatArray]:
    """Return what fits of all curves say, in the unit of the points."""
    noise, matched = found.noise, found.matching.at(found.theta)
    size = exp(found.theta[found.curves.numbers]) * unit
    deviation, length = noise.deviation * unit, noise.length * unit
    return (
        replace(noise, deviation=deviation, length=length),
        level,
        found.line() * unit,
        matched.t * size,
        matched.distances * unit,
    )
