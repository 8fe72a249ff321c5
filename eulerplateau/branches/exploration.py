"""All branches that hang together: follow one, then those that leave it, and so on."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.continuation import Place, next_place, outside
from eulerplateau.branches.control import StepControl
from eulerplateau.branches.kinks import kink_between
from eulerplateau.branches.point import BranchPoint
from eulerplateau.branches.progress import KeptPoint, Lead, Progress
from eulerplateau.branches.special import (
    SpecialPoint,
    branches_from,
    contact_point,
    leaps,
    special_points,
)
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
    then : what the exploration has come to with this point; None before a step's last one
    """

    branch: int
    origin: int | None
    point: BranchPoint
    special: SpecialPoint | None = None
    number: int | None = None
    known: bool = False
    then: Progress | None = field(default=None, repr=False, compare=False)


def explore_from(
    start: BranchPoint, control: StepControl, limits: Limits, *, both_ways: bool = False
) -> Iterator[DiagramPoint]:
    """Yield the points of the branch through `start`, then of those that leave it.

    That branch is followed the way `start` heads, or `both_ways`, one after the other.
    """
    back = replace(start, direction=start.direction.reversed())
    starts = [start, back] if both_ways else [start]
    leads = [Lead(0, order, KeptPoint.of(at), None) for order, at in enumerate(starts)]
    return explore_on(Progress(tuple(leads), order=len(leads)), control, limits)


def explore_on(
    progress: Progress, control: StepControl, limits: Limits
) -> Iterator[DiagramPoint]:
    """Yield the points that follow what an exploration has come to."""
    while progress.here is not None or progress.leads:
        if progress.here is None:
            progress = yield from _begun(progress, control)
        else:
            progress = yield from _stepped(progress, progress.here, control, limits)


def _begun(
    progress: Progress, control: StepControl
) -> Generator[DiagramPoint, None, Progress]:
    """Yield the first point of the next branch; return the progress."""
    leads = list(progress.leads)
    lead = heapq.heappop(leads)
    then = replace(
        progress,
        leads=tuple(leads),
        origin=lead.origin,
        here=lead.start,
        before=lead.start,
        step=control.first_step,
        left=control.max_points,
    )
    yield DiagramPoint(progress.branch, lead.origin, lead.start.point, then=then)
    return then


def _stepped(
    progress: Progress, here: KeptPoint, control: StepControl, limits: Limits
) -> Generator[DiagramPoint, None, Progress]:
    """Yield the special points up to the next point, and that; return the progress."""
    point = before = here.again()
    if progress.before is not None and progress.before is not here:
        before = progress.before.again()
    place = Place(point, progress.step, progress.left)
    after = next_place(place, control, partial(leaps, control=control), kink_between)
    if after is None:
        return progress.ended()
    visited = partial(DiagramPoint, progress.branch, progress.origin)
    for special in _specials(before, after, control):
        number = _number(special, progress.met, control)
        known = number < len(progress.met)
        if not known:
            progress = _with(special, progress, control, limits)
        then = progress.ended() if special.arrived else None
        yield visited(special.point, special, number, known, then)
        if then is not None:
            return then
    then = replace(
        progress, here=KeptPoint.of(after.point), step=after.step, left=after.left
    )
    stability = after.point.stability
    # Where rounding hides an eigenvalue's sign, the next point decides: of this branch,
    # which beyond a kink has other modes.
    sure = not stability.n_neutral or before.stability.n_neutral
    if sure or after.kink is not None:
        then = replace(then, before=then.here)
    unstable = stability.n_unstable > limits.unstable_modes
    if unstable or limits.stop(after.point) or outside(after.point, control):
        then = then.ended()
    yield visited(after.point, then=then)
    return then


def _specials(
    before: BranchPoint, after: Place, control: StepControl
) -> Iterator[SpecialPoint]:
    """Yield the special points on the way to a place, and its kink if something happens."""
    yield from special_points(before, after.end, control)
    if after.kink is not None and after.kink.what:
        yield contact_point(after.kink)


def _with(
    special: SpecialPoint, progress: Progress, control: StepControl, limits: Limits
) -> Progress:
    """Return the progress with a special point that is new, and the branches from it."""
    number, leads = len(progress.met), list(progress.leads)
    met = *progress.met, (_loop(special), special.point.value)
    order = progress.order
    if len(met) <= limits.special_points:
        for first in branches_from(special, control):
            lead = Lead(special.n_unstable, order, KeptPoint.of(first), number)
            heapq.heappush(leads, lead)
            order += 1
    return replace(progress, met=met, leads=tuple(leads), order=order)


def _number(
    special: SpecialPoint, met: Sequence[tuple[FloatArray, float]], control: StepControl
) -> int:
    """Return the number of a special point, the next free one if it is new."""
    for number, (x, value) in enumerate(met):
        near = abs(special.point.value - value) < _SAME_VALUE * control.scale(value)
        if near and loop_distance(_loop(special), x) < _SAME_LOOP:
            return number
    return len(met)


def _loop(special: SpecialPoint) -> FloatArray:
    """Return the loop (n, d) at a special point, as it lies in space."""
    return special.point.family.positions(special.point.x)
