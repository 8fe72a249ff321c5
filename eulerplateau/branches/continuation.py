"""Pseudo-arclength continuation of equilibria in the load, through folds.

A branch is a curve of loops x(s) and loads l(s). With the tangent model's gradient g,
Hessian H and b = dg/dl on the tangent space of the constraint, its direction (p, l') solves

    H p + b l' = 0,        |p|^2 + (w l')^2 = 1,

and each point is corrected inside the hyperplane normal to the last direction (Keller
1977). Stable or not makes no difference here: a root of the forces is sought, no minimum.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from eulerplateau.branches.control import Direction, StepControl
from eulerplateau.branches.family import Family
from eulerplateau.branches.point import (
    BranchPoint,
    correct,
    inner,
    make_direction,
    parameter_drift,
)

_EASY = 4  # corrections up to which the step may grow
_STRAIGHT = 0.8  # cosine of the largest turn from one point to the next
_RECENTRINGS = 4  # how often a film is made anew at a point, until its forces balance
_LEAST_LEAP = 1e-4  # arclength below which a leap is none, but a branch that turns


class LostError(ArithmeticError):
    """A step leads where it is not known what changes on the way: a shorter one may do."""


@dataclass(frozen=True)
class Kink:
    """A place where a branch goes on in another family.

    Attributes
    ----------
    before, after : the same equilibrium, where the branch comes to it and where it goes on
    what : in a word, what happens; empty where only how it is said changes
    error : what rounding in the margin can have moved the parameter by
    """

    before: BranchPoint
    after: BranchPoint
    what: str
    error: float


Kinks = Callable[[BranchPoint, BranchPoint, StepControl], tuple[BranchPoint, Kink | None]]


@dataclass(frozen=True)
class Place:
    """How far a branch has been followed.

    Attributes
    ----------
    step : float, arclength, of the next step if that can be corrected
    left : int, points that may still follow
    kink : where the branch has one there; it goes on at `point`
    """

    point: BranchPoint
    step: float
    left: int
    kink: Kink | None = None

    @property
    def end(self) -> BranchPoint:
        """The last point of the smooth piece that leads there."""
        return self.point if self.kink is None else self.kink.before


def never(before: BranchPoint, after: BranchPoint) -> bool:
    """Return that no step leaps."""
    return False


def smooth(
    before: BranchPoint, after: BranchPoint, control: StepControl
) -> tuple[BranchPoint, None]:
    """Return the latter point and no kink: of a family whose loops are not bounded."""
    return after, None


def follow(
    start: BranchPoint,
    control: StepControl,
    stop: Callable[[BranchPoint], bool] = lambda point: False,
    leaps: Callable[[BranchPoint, BranchPoint], bool] = never,
) -> Iterator[BranchPoint]:
    """Yield the points after `start` until the branch leaves the window or `stop` is true.

    Steps between points of which `leaps` is true are shortened. Ends early where no step,
    however short, can be corrected.
    """
    place: Place | None = Place(start, control.first_step, control.max_points)
    while place is not None and (place := next_place(place, control, leaps)) is not None:
        yield place.point
        if stop(place.point) or outside(place.point, control):
            return


def outside(point: BranchPoint, control: StepControl) -> bool:
    """Return whether a branch has left the window."""
    low, high = control.window
    return not low <= point.value <= high


def next_place(
    place: Place,
    control: StepControl,
    leaps: Callable[[BranchPoint, BranchPoint], bool] = never,
    kinks: Kinks = smooth,
) -> Place | None:
    """Return the next place on a branch; None if there is none, or there were enough.

    A step ends at the first of the `kinks` that the branch has.
    """
    if place.left == 0:
        return None
    point, step = place.point, place.step
    while (found := _stepped(point, step, control, leaps, kinks)) is None:
        step *= 0.5
        if step < control.smallest_step:
            return None
    after, kink = found
    if after.corrections <= _EASY:
        step = min(1.5 * step, control.largest_step)
    if kink is not None:
        after = kink.after
    return Place(recentred(after, control), step, place.left - 1, kink)


def _stepped(
    point: BranchPoint,
    step: float,
    control: StepControl,
    leaps: Callable[[BranchPoint, BranchPoint], bool],
    kinks: Kinks,
) -> tuple[BranchPoint, Kink | None] | None:
    """Return the point after a step, and the kink before it; None if none is reached."""
    after = advance(point, step, control)
    if after is None:
        return None
    try:
        after, kink = kinks(point, after, control)
    except LostError:
        return None
    end = after if kink is None else kink.before
    return None if step > _LEAST_LEAP and leaps(point, end) else (after, kink)


def advance(point: BranchPoint, step: float, control: StepControl) -> BranchPoint | None:
    """Return the branch point at arclength `step` from `point`; None if not corrected."""
    guess = point.x + step * point.direction.displacement
    value = point.value + step * point.direction.rate
    after = correct(point.family.steady(point.x), guess, value, point.direction, control)
    if after is None or not point.energy.reaches(point.x, after.x):
        return None
    # A step that turns sharply has landed on a branch that crosses this one.
    before = _kept(point, after, control)
    ahead = inner(after.model, before, after.direction, control)
    return None if ahead < _STRAIGHT else replace(after, arclength=point.arclength + step)


def _kept(point: BranchPoint, after: BranchPoint, control: StepControl) -> Direction:
    """Return the direction at `point`, as far as its motions are still free at `after`.

    A round loop's sliding is its rotation; once it is not it is taken out (motions.py).
    """
    model = after.model
    if len(point.model.gradient) == len(model.gradient):
        return point.direction
    coefficients = model.coefficients(point.direction.displacement)
    drift = parameter_drift(after.family, after.energy, model)
    return make_direction(model, coefficients, point.direction.rate, control, drift)


def recentred(point: BranchPoint, control: StepControl) -> BranchPoint:
    """Return the point in a family made anew at its loop, if the film has turned.

    A film that has left its plane on the way is released; one that cannot be is made anew
    until its forces balance.
    """
    if not point.energy.holds(point.x):
        point = _anew(point, point.family.near(point.x), control)
    if point.family.rests(point.model, point.value):
        return point
    point = released(point, control)
    for _ in range(_RECENTRINGS):
        if point.family.rests(point.model, point.value):
            break
        point = _anew(point, point.family.near(point.x), control)
    return point


def released(point: BranchPoint, control: StepControl) -> BranchPoint:
    """Return the point with its soap film a minimal surface, where that is curved."""
    return _anew(point, point.family.released(point.x), control)


def _anew(point: BranchPoint, family: Family, control: StepControl) -> BranchPoint:
    """Return the point in another family; itself if it is not found there."""
    if family is point.family:
        return point
    found = correct(family, point.x, point.value, point.direction, control)
    return point if found is None else replace(found, arclength=point.arclength)
