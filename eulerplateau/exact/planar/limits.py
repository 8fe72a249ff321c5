"""The loads at which an n-lobed film buckles, touches itself, and touches along a line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import inf

import numpy as np
from scipy.optimize import brentq

from eulerplateau.exact.checks import checked_diameter, whole_number
from eulerplateau.exact.planar.buckled import sigma_buckling
from eulerplateau.exact.planar.contact import (
    WIDEST,
    Touching,
    at_first_contact,
    at_line_contact,
)
from eulerplateau.exact.planar.thickness import is_too_thick

LOBES = range(2, 13)

_CONTACTS = at_first_contact, at_line_contact
_EXACT = 4 * np.finfo(np.float64).eps


@dataclass(frozen=True)
class Thresholds:
    """The loads sigma L^3 / alpha at which the n-lobed film changes its regime.

    That of a contact is infinite where the loop's curvature would exceed 2/d there.
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
    lobes = checked_lobes(lobes)
    diameter = 0.0 if diameter is None else checked_diameter(diameter)
    return Thresholds(
        lobes,
        sigma_buckling(lobes),
        _onset(at_first_contact, lobes, diameter),
        _onset(at_line_contact, lobes, diameter),
    )


def contacts(lobes: int, width: float) -> tuple[float, float]:
    """Return the loads of both contacts for a diameter of `width` (alpha / sigma)^(1/3).

    As a line has it whose loops of all lengths are asked for; infinite as in Thresholds.
    """
    first, line = (_contact(shape, lobes, width) for shape in _CONTACTS)
    return first, line


def checked_lobes(lobes: int) -> int:
    """Return a number of lobes from 2 to 12; SpecError for anything else."""
    return whole_number("lobes", lobes, LOBES[0], LOBES[-1])


@lru_cache(maxsize=256)
def _onset(shape: Callable[[int, float], Touching], lobes: int, diameter: float) -> float:
    """Return the load at which a loop of this diameter has a shape given by its width."""

    def too_wide(width: float) -> float:
        size: float = shape(lobes, width).lobe.sigma ** (1 / 3)
        return width / size - diameter

    if too_wide(WIDEST) <= 0:
        return inf
    return _contact(shape, lobes, brentq(too_wide, 0.0, WIDEST, xtol=1e-300, rtol=_EXACT))


def _contact(shape: Callable[[int, float], Touching], lobes: int, width: float) -> float:
    """Return the load at which a loop has a shape given by its width."""
    if width > WIDEST:
        return inf
    parts = shape(lobes, width)
    diameter = width / parts.lobe.sigma ** (1 / 3)
    too_thick = is_too_thick(parts.kappa_max, parts.kappa_min, diameter)
    return inf if too_thick else parts.lobe.sigma
