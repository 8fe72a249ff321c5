"""Loops without contact: n equal lobes, from the threshold to the first contact."""

from __future__ import annotations

from decimal import Decimal
from math import expm1, log1p, pi, sqrt

import numpy as np
from scipy.optimize import brentq

from eulerplateau.exact.planar.elastica import Elastica

# 16 pi^3 to more digits than a double holds: the distance to the threshold is what
# counts close above it.
_SIXTEEN_PI_CUBED = Decimal("496.10042688479712280762104107362232")
# Relative amplitude up to which the expansion about the circle is used.
_SMALL = 0.1
_NODES = np.cos(np.arange(32) * (2 * pi / 32))
_EXACT = 4 * np.finfo(np.float64).eps


def sigma_buckling(n: int) -> float:
    """Return 16 pi^3 (n^2 - 1), where the circle gets n lobes (eq. critical-sigma)."""
    return float(_SIXTEEN_PI_CUBED * (n * n - 1))


def excess(n: int, sigma_hat: float) -> float:
    """Return sigma / sigma_buckling - 1, correctly rounded."""
    return float(Decimal(sigma_hat) / (_SIXTEEN_PI_CUBED * (n * n - 1)) - 1)


def buckled(n: int, sigma_hat: float, imaginary2: float) -> Elastica:
    """Return the n-lobed loop without contact, of length 1, at `sigma_hat`.

    `imaginary2` is a lower bound of (imaginary2 / mean^2) of the answer; along the branch
    this number falls from 4 (n^2 - 1) at the threshold, while the amplitude has a fold.
    """
    above = excess(n, sigma_hat)
    # The leading order of the expansion, sigma / sigma_b - 1 = (3 / 8 n^2) amplitude^2.
    amplitude = 2 * n * sqrt(2 * above / 3)
    if amplitude < _SMALL:
        return _close_to_circle(n, above, amplitude)

    def too_stiff(candidate: float) -> float:
        return _closed(n, candidate).sigma / sigma_hat - 1

    # imaginary2 falls as (5/2 - 3/2n^2) amplitude^2: here the amplitude is below _SMALL.
    highest = 4 * (n * n - 1) - _SMALL**2
    return _closed(n, brentq(too_stiff, imaginary2, highest, xtol=1e-14, rtol=_EXACT))


def _closed(n: int, imaginary2: float) -> Elastica:
    """Return the closed n-lobed elastica of length 1 with the given imaginary2 / mean^2."""

    def turns_too_far(amplitude: float) -> float:
        return Elastica(1.0, amplitude, imaginary2).half_turn - pi / n

    most = 1.0
    while turns_too_far(most) > 0:
        most *= 2
    amplitude = brentq(turns_too_far, _SMALL / 10, most, xtol=1e-15, rtol=_EXACT)
    shape = Elastica(1.0, amplitude, imaginary2)
    return shape.scaled(1 / (2 * n * shape.half_period))


def _close_to_circle(n: int, above: float, guess: float) -> Elastica:
    """Return the loop of relative excess `above`; `guess` is roughly its amplitude."""
    if above == 0:
        return _expanded(n, 0.0)[0]

    def too_far(amplitude: float) -> float:
        return _expanded(n, amplitude)[1] / above - 1

    amplitude = brentq(too_far, 0.9 * guess, 1.1 * guess, xtol=1e-300, rtol=_EXACT)
    return _expanded(n, amplitude)[0]


def _expanded(n: int, amplitude: float) -> tuple[Elastica, float]:
    """Return the closed elastica of relative `amplitude` and its excess.

    With kappa = mean (1 + amplitude cos psi) the arc length and the turning of a period
    are means over psi of (1 + x)^(-1/2), x = (4 amplitude cos psi + ...) / D and
    D = 4 + imaginary2, which the trapezoidal rule sums to rounding. What is computed are
    their small differences from the circle's, not the numbers themselves.
    """
    d = 4.0 * n * n
    while True:
        x = (4 * amplitude * _NODES + (amplitude * _NODES) ** 2) / d
        deviation = np.expm1(-0.5 * np.log1p(x))
        length = float(deviation.mean())
        turning = length + amplitude * float((_NODES * deviation).mean())
        growth = turning * (2 + turning)
        before, d = d, 4 * n * n * (1 + growth)
        if abs(d - before) <= _EXACT * d:
            break
    stretch = log1p(length) - log1p(turning)
    lowest = 4.0 * (n * n - 1)
    detuning = 4 * n * n * growth
    above = expm1(3 * stretch + log1p((detuning + amplitude**2) / lowest))
    mean = 2 * pi * (1 + expm1(stretch))
    shape = Elastica(mean, mean * amplitude, mean**2 * (lowest + detuning))
    return shape, above
