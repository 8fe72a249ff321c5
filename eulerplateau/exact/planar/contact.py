"""Loops that touch themselves: in one point per lobe, or along a line.

At the contact of a lobe's two sides the tangent lies on the lobe's axis, so that a half
lobe turns by pi/2 from its tip to the contact; the force's normal component jumps, its
tangential one, kappa^2 - beta, vanishes there (eq. point-of-contact). Beyond the contact
follows, for n >= 3, an arc of the central loop, of the same sigma and beta.

A lobe is described up to its size by the `phase` psi of its contact: kappa = mean +
amplitude cos psi, pi at the minimum of kappa. With psi the load rises monotonically, from
the first contact (psi = pi for n = 2, less for n >= 3) to the onset of line contact, where
kappa is zero a second time, on its way up.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import acos, cos, pi

import numpy as np
from scipy.optimize import brentq

from eulerplateau.exact.planar.elastica import Elastica

_EXACT = 4 * np.finfo(np.float64).eps
# Where the phase of the first contact is sought for n = 3 ... 12; it falls with n.
_LOWEST_PHASE = 2.25
_LARGEST_AMPLITUDE = 50.0


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

    def scaled(self, size: float) -> Touching:
        """Return the similar half lobe `size` times as large."""
        neck = None if self.neck is None else self.neck.scaled(size)
        return Touching(
            self.lobe.scaled(size), self.lobe_length * size, neck, self.neck_length * size
        )


def touching(n: int, phase: float) -> Touching:
    """Return the half lobe of a loop of length 1 whose contact is at `phase`."""
    lobe = _lobe(phase)
    length = lobe.arc_length(phase)
    kappa = lobe.mean + lobe.amplitude * cos(phase)
    return _of_length_one(n, lobe, length, kappa)


@cache
def at_first_contact(n: int) -> Touching:
    """Return the half lobe of the buckled loop that first touches itself."""
    return touching(n, first_contact_phase(n))


@cache
def at_line_contact(n: int) -> Touching:
    """Return the half lobe at the onset of line contact, where kappa = beta = 0."""
    phase = line_contact_phase()
    lobe = _straight_lobe(phase)
    return _of_length_one(n, lobe, lobe.arc_length(phase), 0.0)


@cache
def first_contact_phase(n: int) -> float:
    """Return the phase at which the lobes of the buckled loop first touch themselves."""
    if n == 2:
        return pi

    def closes(phase: float) -> float:
        return _lobe(phase).half_turn - pi / n

    return float(brentq(closes, _LOWEST_PHASE, pi, xtol=1e-15, rtol=_EXACT))


@cache
def line_contact_phase() -> float:
    """Return the phase of a lobe's contact at the onset of line contact, for every n."""

    def turns_too_far(phase: float) -> float:
        lobe = _straight_lobe(phase)
        return float(lobe.turning(lobe.arc_length(phase))) - pi / 2

    return float(brentq(turns_too_far, 3.5, 4.3, xtol=1e-15, rtol=_EXACT))


def touching_at(n: int, sigma_hat: float) -> Touching:
    """Return the half lobe in point contact at `sigma_hat`, between the two thresholds."""

    def too_soft(phase: float) -> float:
        return touching(n, phase).lobe.sigma / sigma_hat - 1

    low, high = first_contact_phase(n), line_contact_phase()
    # At the ends rounding may leave no change of sign.
    if too_soft(low) >= 0:
        return at_first_contact(n)
    if too_soft(high) <= 0:
        return at_line_contact(n)
    return touching(n, brentq(too_soft, low, high, xtol=1e-15, rtol=_EXACT))


def _of_length_one(n: int, lobe: Elastica, length: float, kappa: float) -> Touching:
    neck, neck_length = (None, 0.0) if n == 2 else _neck(n, lobe.sigma, kappa)
    half = Touching(lobe, length, neck, neck_length)
    return half.scaled(1 / (2 * n * (length + neck_length)))


def _touching_lobe(phase: float, amplitude: float) -> Elastica:
    """Return the elastica with mean 1 and kappa^2 = beta at `phase`."""
    x = cos(phase)
    return Elastica(1.0, amplitude, amplitude * (amplitude - 4 * x - 2 * amplitude * x**2))


def _straight_lobe(phase: float) -> Elastica:
    """Return the elastica with mean 1 and kappa = beta = 0 at `phase`."""
    amplitude = -1 / cos(phase)
    return Elastica(1.0, amplitude, 2 + amplitude**2)


def _lobe(phase: float) -> Elastica:
    """Return the elastica of mean 1 that touches, turned by pi/2, at `phase`."""

    def turns_too_far(amplitude: float) -> float:
        lobe = _touching_lobe(phase, amplitude)
        return float(lobe.turning(lobe.arc_length(phase))) - pi / 2

    x = cos(phase)
    # From kappa just above zero to just before imaginary2 = 0.
    lowest, highest = -0.99 / x, _LARGEST_AMPLITUDE
    if 2 * x * x > 1:
        highest = min(highest, -4 * x / (2 * x * x - 1) * (1 - 1e-4))
    amplitude = brentq(turns_too_far, lowest, highest, xtol=1e-15, rtol=_EXACT)
    return _touching_lobe(phase, amplitude)


def _neck(n: int, sigma: float, kappa: float) -> tuple[Elastica, float]:
    """Return the central arc and half its length, from curvature `kappa` to the minimum.

    Its tension is `sigma`, its beta is kappa^2, and its half turns by pi/n - pi/2. The
    turning grows in size with the depth of the minimum, from 0 to pi/2.
    """

    def half_arc(lowest: float) -> tuple[Elastica, float]:
        arc = _arc_with_minimum(lowest, sigma, kappa**2)
        phase = acos(max((kappa - arc.mean) / arc.amplitude, -1.0))
        return arc, arc.half_period - arc.arc_length(phase)

    def turns_too_little(lowest: float) -> float:
        arc, length = half_arc(lowest)
        before = float(arc.turning(arc.half_period - length))
        return arc.half_turn - before - (pi / n - pi / 2)

    size = sigma ** (1 / 3)
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
