"""The loads at which a loop of thin line, welded straight or not at all, changes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from eulerplateau.exact.conformal import lobes_twist, quick_opening_load_by_width
from eulerplateau.exact.planar import TooThickError, planar_film
from eulerplateau.exact.planar.buckled import sigma_buckling
from eulerplateau.exact.planar.limits import contacts


class Twist(Enum):
    """Whether a line's twist escapes, its ends turning freely in each other, or is held."""

    FREE = "untwisting"
    WELDED = "welded"


@dataclass(frozen=True)
class Changes:
    """Loads sigma_hat at which a loop of a line changes; infinite where it is too thick.

    Attributes
    ----------
    buckles : the disk becomes two lobes in their plane
    jumps : two lobes become a pinched eight, if the line's twist escapes
    touches, touches_along_a_line : the two lobes' sides, if it does not
    opens : an eight whose strands touch opens again, unloaded, if the line's twist escapes;
        NaN where that is not known: of a line without a thickness, or one that is thinner
        or thicker than those whose films are known
    """

    buckles: float
    jumps: float
    touches: float
    touches_along_a_line: float
    opens: float


def changes(width: float = 0.0) -> Changes:
    """Return the loads at which loops of a line change, to ten digits; `opens` to six.

    `width` is the line's diameter in units of (alpha / sigma)^(1/3), of any length.
    """
    return Changes(
        sigma_buckling(2),
        lobes_twist(),
        *contacts(2, width),
        quick_opening_load_by_width(width),
    )


EIGHT, TOO_THICK = "eight", "too_thick"


def state(load: float, twist: Twist, diameter: float | None = None) -> str:
    """Return what a film of two lobes has come to when its load has risen to this.

    A regime of planar films; "eight", the pinched figure eight; or "too_thick". A line that
    is welded straight and isotropic, its C/B being 2/3 or more, stays in its plane at least
    until it touches (docs/welded-loop.md). `diameter` is the line's, in units of the
    length. Raises SpecError for one that is more than a tenth of it.
    """
    if twist is Twist.FREE and load > lobes_twist():
        return EIGHT
    try:
        return str(planar_film(2, load, diameter).regime.value)
    except TooThickError:
        return TOO_THICK
