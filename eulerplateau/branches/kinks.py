"""Where a branch has a kink: what bounds its loops changes there, as strands that touch.

Between kinks a branch is smooth, and so are its bounds' margins, none of which is negative.
A kink is where the first of them vanishes. Beyond it another family of energies is good,
with other gaps closed: there are two ways on in that, and bounds are kept to along one.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from itertools import product
from operator import methodcaller
from typing import Protocol, cast

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.between import Interval
from eulerplateau.branches.continuation import Kink, LostError
from eulerplateau.branches.control import Hyperplane, StepControl
from eulerplateau.branches.family import Family
from eulerplateau.branches.point import BranchPoint, correct, point_on

# Margins down to this are rounding's; and what rounding leaves of one.
_ROUNDING, _MARGIN = 1e-9, 1e-12
# Tries after which a margin is as near to zero as what strands overlap by lets it be; and
# when it is located again near there, where it is all but linear.
_TRIES, _AGAIN = 10, 6
# Arclength below which a kink is the one a branch has just left; and those after which it
# is looked at whether bounds are kept to: the next kink may be near.
_LEFT = 1e-8
_PROBES = 1e-4, 1e-5, 1e-6, 1e-7


class BoundedFamily(Family, Protocol):
    """A family whose energies have bounds with margins."""

    def beyond(self, point: BranchPoint, which: int) -> tuple[Family, str]:
        """Return the family that is good beyond a point where one of its margins vanishes.

        And what happens there, in a word; nothing where only how it is said changes.
        """


def margins(point: BranchPoint) -> FloatArray:
    """Return by how much a point keeps to its bounds (k,)."""
    return point.energy.bounds.margins(point.x, point.model.tensions)


def kink_between(
    before: BranchPoint, after: BranchPoint, control: StepControl
) -> tuple[BranchPoint, Kink | None]:
    """Return what stands for the latter of two points, and the first kink between them.

    None where there is none. Raises LostError where a shorter step is needed to tell.
    """
    plane = Hyperplane(after.x, after.value, before.direction, control)
    there = after.family.settled(after, plane)
    if there is None:
        raise LostError
    broken = np.flatnonzero(margins(there) < -_ROUNDING)
    if not len(broken):
        return there, None
    interval = Interval(before, there, control)
    found = [(_located(interval, int(which)), int(which)) for which in broken]
    point, which = min(found, key=lambda pair: pair[0].arclength)
    interval, point = _again(interval, point, which)
    family, what = cast(BoundedFamily, point.family).beyond(point, which)
    on = _gone_on(point, family, control)
    return there, Kink(point, on, what, _error(interval, point, which))


def _located(interval: Interval, which: int) -> BranchPoint:
    found = interval.locate(partial(_margin, which), _TRIES)
    if found is None or found.arclength - interval.before.arclength < _LEFT:
        raise LostError
    return found


def _again(
    interval: Interval, point: BranchPoint, which: int
) -> tuple[Interval, BranchPoint]:
    """Return it located again, the film made anew there, and the part that was done in."""
    part = interval.about(point, point.family.near(point.x))
    locate = methodcaller("locate", partial(_margin, which), _AGAIN)
    found = None if part is None else part.at_rest(locate)
    if found is None:
        raise LostError
    return found


def _error(interval: Interval, point: BranchPoint, which: int) -> float:
    """Return what rounding can have moved the parameter by where a margin vanishes."""
    rise = abs(_margin(which, interval.after) - _margin(which, interval.before))
    arclength = (abs(_margin(which, point)) + _MARGIN) / rise * interval.length
    eps = 4 * float(np.finfo(np.float64).eps)
    return abs(point.direction.rate) * arclength + eps * interval.control.scale(point.value)


def _margin(which: int, point: BranchPoint) -> float:
    return float(margins(point)[which])


def _gone_on(point: BranchPoint, family: Family, control: StepControl) -> BranchPoint:
    """Return the point in another family, headed where bounds are kept to.

    Raises LostError where that is neither way.
    """
    there = point_on(family, point.x, point.value, point.direction, control)
    if there is None:
        raise LostError
    ways = there.direction, there.direction.reversed()
    for probe, way in product(_PROBES, ways):
        guess = there.x + probe * way.displacement
        near = correct(family, guess, there.value + probe * way.rate, way, control)
        if near is not None and (margins(near) >= -_ROUNDING).all():
            return replace(there, direction=way, arclength=point.arclength)
    raise LostError
