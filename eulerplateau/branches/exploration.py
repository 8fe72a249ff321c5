"""All branches that hang together: follow one, then those that leave it, and so on."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import count

from eulerplateau.branches.continuation import follow
from eulerplateau.branches.point import BranchPoint, StepControl
from eulerplateau.branches.special import SpecialPoint, branches_from, leaps, special_points
from eulerplateau.branches.symmetry import loop_distance

# Two special points are one if their values agree to this (relative) and their loops to
# this (in L): far above the precision of either, far below what tells branches apart.
_SAME_VALUE = 1e-6
_SAME_LOOP = 1e-3


@dataclass(frozen=True)
class Limits:
    """Where an exploration ends.

    Attributes
    ----------
    special_points : int, new branches start from the first so many only
    unstable_modes : int, a branch is left where it has more
    stop : predicate on branch points that ends the branch it is on
    """

    special_points: int = 8
    unstable_modes: int = 3
    stop: Callable[[BranchPoint], bool] = lambda point: False


@dataclass(frozen=True)
class DiagramPoint:
    """A point of a branch; `special` is set where it is a fold or a bifurcation.

    Attributes
    ----------
    branch : int, counted from 0
    origin : int or None, the number of the special point the branch starts from
    number : int or None, of the special point; a known one keeps its number
    """

    branch: int
    origin: int | None
    point: BranchPoint
    special: SpecialPoint | None = None
    number: int | None = None
    known: bool = False


@dataclass(order=True, frozen=True)
class _Lead:
    """A branch to follow: those from more stable points first, then as found."""

    n_unstable: int
    order: int
    start: BranchPoint = field(compare=False)
    origin: int | None = field(compare=False)


def explore_from(
    start: BranchPoint, control: StepControl, limits: Limits, *, both_ways: bool = False
) -> Iterator[DiagramPoint]:
    """Yield the points of the branch through `start`, then of those that leave it.

    That branch is followed the way `start` heads, or `both_ways`, one after the other.
    """
    order = count()
    leads = [_Lead(0, next(order), start, None)]
    if both_ways:
        back = replace(start, direction=start.direction.reversed())
        leads.append(_Lead(0, next(order), back, None))
    found: list[SpecialPoint] = []
    for branch in count():
        if not leads:
            return
        lead = heapq.heappop(leads)
        for visited in _trace(lead, branch, control, limits, found):
            yield visited
            special = visited.special
            if special is None or visited.known or len(found) > limits.special_points:
                continue
            for first in branches_from(special, control):
                heapq.heappush(
                    leads, _Lead(special.n_unstable, next(order), first, visited.number)
                )


def _trace(
    lead: _Lead,
    branch: int,
    control: StepControl,
    limits: Limits,
    found: list[SpecialPoint],
) -> Iterator[DiagramPoint]:
    """Yield one branch; special points not met before are added to `found`."""
    yield DiagramPoint(branch, lead.origin, lead.start)
    before = lead.start
    leap = partial(leaps, control=control)
    for after in follow(lead.start, control, limits.stop, leap):
        for special in special_points(before, after, control):
            number = _number(special, found)
            known = number < len(found)
            if not known:
                found.append(special)
            yield DiagramPoint(branch, lead.origin, special.point, special, number, known)
            if special.arrived:
                return
        yield DiagramPoint(branch, lead.origin, after)
        if after.stability.n_unstable > limits.unstable_modes:
            return
        # Where rounding hides an eigenvalue's sign, the next point decides.
        if not after.stability.n_neutral or before.stability.n_neutral:
            before = after


def _number(special: SpecialPoint, found: list[SpecialPoint]) -> int:
    """Return the number of a special point, the next free one if it is new."""
    for number, other in enumerate(found):
        near = abs(special.point.value / other.point.value - 1) < _SAME_VALUE
        if near and loop_distance(special.point.x, other.point.x) < _SAME_LOOP:
            return number
    return len(found)
