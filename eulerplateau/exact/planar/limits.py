"""The loads at which an n-lobed film buckles, touches itself, and touches along a line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import inf

import numpy as np
from scipy.optimize import brentq

from eulerplateau.exact.checks import whole_number
from eulerplateau.exact.planar.buckled import sigma_buckling
from eulerplateau.exact.planar.contact import (
    WIDEST,
    Touching,
    at_first_contact,
    at_line_contact,
)
from eulerplateau.exact.planar.thickness import checked_diameter, is_too_thick

LOBES = range(2, 13)

_EXACT = 4 * np.finfo(np.float64).eps


@dataclass(frozen=True)
class Thresholds:
    """The loads sigma L^3 / alpha at which the n-lobed film changes its regime.

    Infinite where the loop's curvature exceeds 2/d before.
    """

    lobes: int
    sigma_buckling: float
    sigma_contact: float
    sigma_line_contact: float


def thresholds(lobes: int, diameter: float | None = None) -> Thresholds:
    """Return the thresholds of the film with n lobes (paper, tab:contact).

    Parameters
    ----------
    lobes : int
        n, from 2 to 12.
    diameter : float, optional
        That of the loop, in L, above 0 and at most 0.1; by default it has no thickness.

    Returns
    -------
    Thresholds
        Tensions sigma L^3 / alpha, to 12 digits or more.

    Raises
    ------
    SpecError
        If an argument is no such number.
    """
    return thresholds_of(checked_lobes(lobes), checked_diameter(diameter))


def checked_lobes(lobes: int) -> int:
    """Return a number of lobes from 2 to 12; SpecError for anything else."""
    return whole_number("lobes", lobes, LOBES[0], LOBES[-1])


@lru_cache(maxsize=256)
def thresholds_of(lobes: int, diameter: float) -> Thresholds:
    """Return the thresholds of checked numbers; a diameter of 0 is none."""
    return Thresholds(
        lobes,
        sigma_buckling(lobes),
        _load(at_first_contact, lobes, diameter),
        _load(at_line_contact, lobes, diameter),
    )


def _load(shape: Callable[[int, float], Touching], lobes: int, diameter: float) -> float:
    """Return the load at which a loop of this diameter has a shape given by its width."""

    def too_thick(width: float) -> float:
        size: float = shape(lobes, width).lobe.sigma ** (1 / 3)
        return width / size - diameter

    if too_thick(WIDEST) <= 0:
        return inf
    width = brentq(too_thick, 0.0, WIDEST, xtol=1e-300, rtol=_EXACT)
    parts = shape(lobes, width)
    if is_too_thick(parts.kappa_max, parts.kappa_min, diameter):
        return inf
    return parts.lobe.sigma
