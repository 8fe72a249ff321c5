"""Curves of folds, and of bifurcations that a symmetry keeps, in two parameters.

Each point is corrected inside the hyperplane normal to the last direction (locus_point.py),
through turns of the curve in either parameter. What is special on the way is located like
a bifurcation on a branch, between two points. Where the second parameter breaks the
symmetry that a bifurcation lives on, it does not persist: the folds that it leaves pass
through it, as a cusp, and these are followed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from enum import StrEnum

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.control import Direction, Motion, StepControl
from eulerplateau.branches.family import Family
from eulerplateau.branches.locus_ahead import Ahead
from eulerplateau.branches.locus_between import Resolution, Special, special_points
from eulerplateau.branches.locus_point import Course, LocusPoint, correct, trial
from eulerplateau.branches.normal_form import NO_PART, part_along
from eulerplateau.branches.point import BranchPoint
from eulerplateau.branches.special import (
    FOLD,
    SpecialPoint,
    symmetry_at,
)
from eulerplateau.errors import SpecError
from eulerplateau.solvers import RESIDUAL_TOLERANCE, tangent_model

# Corrections up to which the step may grow, and beyond which it is too long: one that ends
# next to a singular point is not taken, a shorter one passes that.
_EASY, _HARD = 5, 10
_STRAIGHT = 0.8  # cosine of the largest turn from one point to the next
_AS_IT_IS = Resolution()
_FIRST_LEAST = 4  # points before which a curve does not come back to its start

# Where a curve began, and its direction there.
Home = tuple[Motion, ...]


class End(StrEnum):
    """Why a curve ends."""

    WINDOW = "leaves the window"
    LOST = "no further point found"
    STRANDS = "strands meet"
    UNBALANCED = "symmetry is lost"
    CLOSED = "comes back to its start"
    ENOUGH = "enough points"


def special_at(family: Family, x: FloatArray, value: float, kind: str) -> SpecialPoint:
    """Return a special point of a kind, as branches have them, from its loop (n, d)."""
    model = tangent_model(family.energy(value), x)
    values, vectors = model.eigen
    index = int(np.abs(values).argmin())
    mode = model.displacement(vectors[:, index])
    point = BranchPoint(family, model, value, Direction(np.zeros_like(x), 1.0), 0.0, 0)
    return SpecialPoint(
        kind=kind,
        point=point,
        mode=mode,
        eigenvalue=float(values[index]),
        error=0.0,
        n_unstable=index,
        multiplicity=1,
        symmetry=symmetry_at(point, mode),
    )


def locus_start(
    special: SpecialPoint,
    second: str,
    value: float,
    controls: tuple[StepControl, StepControl],
) -> LocusPoint:
    """Return the first point of the curve that a special point is on.

    Where the second parameter breaks the symmetry that a bifurcation lives on it is one of
    the folds that this leaves; `course.symmetric` says which.

    Parameters
    ----------
    special : a fold or a bifurcation of a branch
    second, value : the second parameter, and its value there
    controls : how the branch was followed, and window, unit, least value of the second

    Raises
    ------
    SpecError : where neither is to be followed
    """
    point, k = special.point, special.multiplicity
    values, vectors = point.model.eigen
    lost = vectors[:, np.sort(np.argsort(np.abs(values))[:k])]
    modes = [point.model.displacement(mode) for mode in lost.T]
    symmetric = special.kind != FOLD
    if symmetric:
        unit = controls[1].unit
        parts = [
            part_along(point.energy, point.model, mode, second, unit) for mode in lost.T
        ]
        symmetric = max(parts) < NO_PART
        if not symmetric and k > 1:
            lost_to = f"{second} breaks what the bifurcation needs"
            names = ", ".join(_broken(special, second))
            raise SpecError("locus.with", f"{lost_to} ({names}): {k} modes at once")
    elif k > 1:
        raise SpecError("locus.point", f"{k} modes are lost at once: no fold to follow")
    leaves = special.kind != FOLD and not symmetric
    needs = _broken(special, second) if leaves else special.breaks
    course = Course(second, controls, symmetric, needs)
    place = Motion(point.x, np.array([point.value, value]))
    still, nothing = np.zeros_like(point.x), np.zeros(2)
    # A fold, or a bifurcation, is found at this second value; a cusp across its own mode.
    level = Motion(still, np.array([0.0, controls[1].unit]))
    across = Motion(modes[0], nothing)
    normal = across if leaves else level
    found = None
    with suppress(LinAlgError):
        there = trial(course, point.family, place, modes).completed(normal, 0)
        found = correct(course, point.family, place, normal, modes, there.steepness)
    if found is None or found.model.residual > RESIDUAL_TOLERANCE:
        raise SpecError("locus.point", f"{special!r}: no such point found again")
    return replace(found, special=(Special.CUSP if leaves else Special.START))


def _broken(special: SpecialPoint, second: str) -> tuple[str, ...]:
    """Return which symmetries of a bifurcation a second parameter's pull breaks.

    Of those that its mode breaks; all of these where a mesh has none of them exactly.
    """
    point = special.point
    pull = point.model.slope(point.energy.rate(second, point.x))
    pulled = symmetry_at(point, point.model.displacement(pull)).breaks
    both = tuple(name for name in special.breaks if name in pulled)
    return both or special.breaks or ("symmetry of the branch",)


def follow_locus(
    start: LocusPoint,
    stop: Callable[[LocusPoint], bool] = lambda point: False,
    resolution: Resolution = _AS_IT_IS,
) -> Iterator[LocusPoint]:
    """Yield the points of a curve from a start both ways, special ones among them.

    The last one each way says why the curve ends there. Arclength counts from the start,
    negative the second way. Where `stop` is true strands meet, and the curve ends.
    """
    start = resolution.resolved(start)
    yield start
    for way, first in ((1, start), (-1, start.reversed())):
        end = ""
        for point in _arm(first, stop, resolution):
            yield replace(point, arclength=way * point.arclength)
            end = point.end
        if end == End.CLOSED:
            return


def _arm(
    start: LocusPoint, stop: Callable[[LocusPoint], bool], resolution: Resolution
) -> Iterator[LocusPoint]:
    """Yield the points after a start, in the direction it heads."""
    control = start.course.controls[0]
    home: Home = start.place, start.direction
    before, step, ahead = start, control.first_step, Ahead.of(start)
    for number in range(control.max_points):
        after = None
        while after is None and step > control.smallest_step:
            after = _advance(ahead, step)
            step = step if after is not None else 0.5 * step
        if after is None:
            yield replace(before, special="", end=End.LOST)
            return
        yield from special_points(before, after)
        end = End.STRANDS if stop(after) else _end(home, before, after, number)
        yield replace(after, end=end)
        if end:
            return
        if after.corrections <= _EASY:
            step = min(1.5 * step, control.largest_step)
        ahead, before = ahead.then(after), resolution.resolved(after)
        if before is not after:
            ahead = Ahead.of(before)
            home = tuple(resolution.carried(motion, after, before) for motion in home)


def _advance(ahead: Ahead, step: float) -> LocusPoint | None:
    """Return the point at arclength `step` from another; None if not corrected."""
    before, after = ahead.point, ahead.reached(step)
    if after is None or after.corrections > _HARD:
        return None
    if not before.energy.reaches(before.model.x, after.model.x):
        return None
    if after.dot(before.direction, after.direction) < _STRAIGHT:
        return None
    if not after.energy.holds(after.model.x):
        near = replace(after, family=after.family.near(after.model.x))
        after = near.next_to(after.place, after.direction) or after
    return replace(after, arclength=before.arclength + step)


def _end(home: Home, before: LocusPoint, after: LocusPoint, number: int) -> str:
    """Return why a curve ends at a point, or nothing."""
    course = after.course
    if not course.inside(after.values):
        return End.WINDOW
    if after.model.residual > RESIDUAL_TOLERANCE:
        return End.UNBALANCED
    if number >= _FIRST_LEAST and _passed(home, before, after):
        return End.CLOSED
    return End.ENOUGH if number + 1 == course.controls[0].max_points else ""


def _passed(home: Home, before: LocusPoint, after: LocusPoint) -> bool:
    """Return whether the start lies between two points of its curve."""
    place, direction = home
    way, there = after.place - before.place, place - before.place
    length = after.dot(way, way)
    part = after.dot(way, there) / length
    off = there - way * part
    near = after.dot(off, off) < 0.05**2 * length
    return 0 < part <= 1 and near and after.dot(way, direction) > 0
