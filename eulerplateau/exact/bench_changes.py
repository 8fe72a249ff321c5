"""The loads at which a loop of thin line, welded straight or not at all, changes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from eulerplateau.exact.conformal import lobes_twist
from eulerplateau.exact.planar import planar_film, thresholds


class Twist(Enum):
    """Whether a line's twist escapes, its ends turning freely in each other, or is held."""

    FREE = "untwisting"
    WELDED = "welded"


@dataclass(frozen=True)
class Changes:
    """Loads sigma_hat at which a loop that was welded straight, of thin line, changes.

    Attributes
    ----------
    buckles : the disk becomes two lobes in their plane
    jumps : two lobes become a pinched eight, if the line's twist escapes
    touches, touches_along_a_line : the two lobes' sides, if it does not
    """

    buckles: float
    jumps: float
    touches: float
    touches_along_a_line: float


def changes() -> Changes:
    """Return the loads at which a loop changes, to ten digits."""
    flat = thresholds(2)
    return Changes(
        flat.sigma_buckling, lobes_twist(), flat.sigma_contact, flat.sigma_line_contact
    )


EIGHT = "eight"


def state(load: float, twist: Twist) -> str:
    """Return what a film of two lobes has come to when its load has risen to this.

    A regime of planar films, or "eight", the pinched figure eight. A line that is welded
    straight and isotropic, its C/B being 2/3 or more, leaves the plane at no load
    (docs/welded-loop.md).
    """
    if twist is Twist.FREE and load > lobes_twist():
        return EIGHT
    return str(planar_film(2, load).regime.value)
