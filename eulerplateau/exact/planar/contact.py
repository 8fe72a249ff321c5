"""Loops that touch themselves: in one point per lobe, or along a line.

At the contact of a lobe's two sides the tangent lies along the lobe's axis, at half a
diameter d from it, so that a half lobe turns by pi/2 from its tip to the contact; the
force's normal component jumps, its tangential one, kappa^2 - beta, is sigma d / 2 there
(eq. point-of-contact, which has d = 0). Beyond the contact follows, for n >= 3, an arc of
the central loop, of the same sigma and beta.

A lobe is described up to its size by two numbers: its `width` d sigma^(1/3), and the
`phase` psi of its contact: kappa = mean + amplitude cos psi, pi at the minimum of kappa.
With psi the load rises monotonically, from the first contact (psi = pi for n = 2, less for
n >= 3) to the onset of line contact, where kappa is zero a second time, on its way up.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import acos, cbrt, cos, pi, sqrt

import numpy as np
from scipy.optimize import brentq

from eulerplateau.exact.planar.elastica import Elastica

_EXACT = 4 * np.finfo(np.float64).eps
# Every lobe that touches and is wider than this is bent more sharply than 2 / d.
WIDEST = 1.5
_LARGEST_AMPLITUDE = 50.0
# Films of one load and diameter ask for the same lobes more than once.
_remembered = lru_cache(maxsize=64)


@dataclass(frozen=True)
class Touching:
    """A half lobe in contact: from tip to contact, and on to the central arc's middle.

    `neck_length` counts from the contact to the minimum of kappa of `neck`; for n = 2
    there is no central loop: `neck` is None and `neck_length` 0.
    """

    lobe: Elastica
    lobe_length: float
    neck: Elastica | None
    neck_length: float

    @property
    def kappa_max(self) -> float:
        """The curvature at the tip."""
        return self.lobe.mean + self.lobe.amplitude

    @property
    def kappa_min(self) -> float:
        """The least curvature of lobe and neck."""
        lowest = self.lobe.mean - self.lobe.amplitude
        if self.lobe_length < self.lobe.half_period:
            lowest = float(self.lobe.curvature(self.lobe_length))
        if self.neck is not None:
            lowest = min(lowest, self.neck.mean - self.neck.amplitude)
        return lowest

    @property
    def shear_jump(self) -> float:
        """The jump of the force 2 kappa' across the curved parts' ends at the contact.

        It is the point force on this strand of n >= 3 lobes, half of that for n = 2.
        """
        before = float(self.lobe.slope(self.lobe_length))
        if self.neck is None:
            return 2 * before
        beyond = float(self.neck.slope(self.neck.half_period - self.neck_length))
        return 2 * (before - beyond)

    def scaled(self, size: float) -> Touching:
        """Return the similar half lobe `size` times as large."""
        neck = None if self.neck is None else self.neck.scaled(size)
        return Touching(
            self.lobe.scaled(size), self.lobe_length * size, neck, self.neck_length * size
        )


def touching(n: int, phase: float, width: float = 0.0) -> Touching:
    """Return the half lobe of a loop of length 1 whose contact is at `phase`."""
    lobe = _lobe(phase, width)
    length = lobe.arc_length(phase)
    kappa = lobe.mean + lobe.amplitude * cos(phase)
    return _of_length_one(n, lobe, length, kappa, width)


@_remembered
def at_first_contact(n: int, width: float = 0.0) -> Touching:
    """Return the half lobe of the buckled loop that first touches itself."""
    return touching(n, first_contact_phase(n, width), width)


@_remembered
def at_line_contact(n: int, width: float = 0.0) -> Touching:
    """Return the half lobe at the onset of line contact, where kappa = 0."""
    phase = line_contact_phase(width)
    lobe = _straight_lobe(phase, width)
    return _of_length_one(n, lobe, lobe.arc_length(phase), 0.0, width)


@_remembered
def first_contact_phase(n: int, width: float = 0.0) -> float:
    """Return the phase at which the lobes of the buckled loop first touch themselves.

    For n >= 3 it is at least the lowest phase that is searched: where there is a thickness
    and the first contact is below, both lobes are bent more sharply than 2 / d.
    """
    if n == 2:
        return pi

    def closes(phase: float) -> float:
        return _lobe(phase, width).half_turn - pi / n

    # The phase falls with n and with the width. At the lowest one kappa is still negative
    # up to WIDEST; the lobe is thick from a width of 0.6 on, and has n > 12 below.
    lowest = max(2.25 - width / 2, 1.95)
    if closes(lowest) >= 0:
        return lowest
    return float(brentq(closes, lowest, pi, xtol=1e-15, rtol=_EXACT))


@_remembered
def line_contact_phase(width: float = 0.0) -> float:
    """Return the phase of a lobe's contact at the onset of line contact, for every n."""

    def turns_too_far(phase: float) -> float:
        lobe = _straight_lobe(phase, width)
        return float(lobe.turning(lobe.arc_length(phase))) - pi / 2

    return float(brentq(turns_too_far, 3.5, 4.3, xtol=1e-15, rtol=_EXACT))


def touching_at(n: int, sigma_hat: float, width: float = 0.0) -> Touching:
    """Return the half lobe in point contact at `sigma_hat`, between the two thresholds."""

    def too_soft(phase: float) -> float:
        return touching(n, phase, width).lobe.sigma / sigma_hat - 1

    low, high = first_contact_phase(n, width), line_contact_phase(width)
    # At the ends rounding may leave no change of sign.
    if too_soft(low) >= 0:
        return at_first_contact(n, width)
    if too_soft(high) <= 0:
        return at_line_contact(n, width)
    return touching(n, brentq(too_soft, low, high, xtol=1e-15, rtol=_EXACT), width)


def _of_length_one(
    n: int, lobe: Elastica, length: float, kappa: float, width: float
) -> Touching:
    neck, neck_length = (None, 0.0) if n == 2 else _neck(n, lobe.sigma, kappa, width)
    half = Touching(lobe, length, neck, neck_length)
    return half.scaled(1 / (2 * n * (length + neck_length)))


def _touching_lobe(phase: float, amplitude: float, width: float) -> Elastica:
    """Return the elastica with mean 1 and kappa^2 - beta = sigma d / 2 at `phase`."""
    x = cos(phase)
    thin = amplitude * (amplitude - 4 * x - 2 * amplitude * x**2)
    return Elastica(1.0, amplitude, thin + _thickening(thin, amplitude, width))


def _straight_lobe(phase: float, width: float) -> Elastica:
    """Return the elastica with mean 1, kappa = 0 and beta = -sigma d / 2 at `phase`."""
    amplitude = -1 / cos(phase)
    thin = 2 + amplitude**2
    return Elastica(1.0, amplitude, thin + _thickening(thin, amplitude, width))


def _thickening(thin: float, amplitude: float, width: float) -> float:
    """Return what a width adds to imaginary2, which is `thin` at the same phase without it.

    With u^3 = sigma it is width u^2, and u^3 - width u^2 / 2 = sigma without a width; v =
    1/u is the one real root of a cubic equation without quadratic term (Cardano).
    """
    sigma = (thin + amplitude**2) / 2
    third, half = width / (6 * sigma), 1 / (2 * sigma)
    root = cbrt(half + sqrt(half**2 + third**3))
    return width / (root - third / root) ** 2


def _lobe(phase: float, width: float) -> Elastica:
    """Return the elastica of mean 1 that touches, turned by pi/2, at `phase`."""

    def turns_too_far(amplitude: float) -> float:
        lobe = _touching_lobe(phase, amplitude, width)
        return float(lobe.turning(lobe.arc_length(phase))) - pi / 2

    x = cos(phase)
    # From kappa just above zero to just before imaginary2 = 0 (without a width).
    lowest, highest = -0.99 / x, _LARGEST_AMPLITUDE
    if 2 * x * x > 1:
        highest = min(highest, -4 * x / (2 * x * x - 1) * (1 - 1e-4))
    amplitude = brentq(turns_too_far, lowest, highest, xtol=1e-15, rtol=_EXACT)
    return _touching_lobe(phase, amplitude, width)


def _neck(n: int, sigma: float, kappa: float, width: float) -> tuple[Elastica, float]:
    """Return the central arc and half its length, from curvature `kappa` to the minimum.

    Its tension is `sigma`, its beta is kappa^2 - sigma d / 2, and its half turns by pi/n -
    pi/2. The turning grows in size with the depth of the minimum, from 0 to pi/2.
    """
    size = sigma ** (1 / 3)
    beta = kappa**2 - width * size**2 / 2

    def half_arc(lowest: float) -> tuple[Elastica, float]:
        arc = _arc_with_minimum(lowest, sigma, beta)
        phase = acos(max((kappa - arc.mean) / arc.amplitude, -1.0))
        return arc, arc.half_period - arc.arc_length(phase)

    def turns_too_little(lowest: float) -> float:
        arc, length = half_arc(lowest)
        before = float(arc.turning(arc.half_period - length))
        return arc.half_turn - before - (pi / n - pi / 2)

    shallow, deep = kappa - 1e-9 * size, kappa - 100 * size
    return half_arc(brentq(turns_too_little, shallow, deep, xtol=1e-15, rtol=_EXACT))


def _arc_with_minimum(lowest: float, sigma: float, beta: float) -> Elastica:
    """Return the elastica of given sigma and beta whose curvature falls to `lowest`."""

    def too_much(mean: float) -> float:
        return mean * (2 * mean**2 - 2 * mean * lowest + lowest**2 - beta) - sigma

    highest = (sigma / 2) ** (1 / 3)
    mean = brentq(too_much, 0.0, 1.001 * highest, xtol=1e-300, rtol=_EXACT)
    amplitude = mean - lowest
    return Elastica(mean, amplitude, 2 * (mean**2 - beta) + amplitude**2)
