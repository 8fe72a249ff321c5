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
from functools import partial

import numpy as np
from scipy.linalg import LinAlgError
from scipy.optimize import brentq

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.family import Family
from eulerplateau.branches.locus_point import Course, LocusPoint, Motion, correct, trial
from eulerplateau.branches.point import BranchPoint, Direction, StepControl
from eulerplateau.branches.special import (
    FOLD,
    NO_PART,
    SpecialPoint,
    part_along,
    symmetry_at,
)
from eulerplateau.errors import SpecError
from eulerplateau.solvers import RESIDUAL_TOLERANCE, tangent_model

_EASY = 5  # corrections up to which the step may grow
_STRAIGHT = 0.8  # cosine of the largest turn from one point to the next
_PRECISION = 1e-12  # arclength to which special points are located
# Parts of the way between two points by which a singular one is passed.
_ASIDE = 0.0, 1e-9, 1e-6, 1e-4, 1e-3
_FIRST_LEAST = 4  # points before which a curve does not come back to its start


class Special(StrEnum):
    """What is special about a point of a curve of special points."""

    START = "start"
    CUSP = "cusp"
    NATURE = "super- to subcritical"
    MEETING = "fold meets bifurcation"
    DOUBLE = "another mode is lost"
    TURN = "turn"


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
            raise SpecError("locus.with", f"{_broken(special, second)}: {k} modes at once")
    elif k > 1:
        raise SpecError("locus.point", f"{k} modes are lost at once: no fold to follow")
    course = Course(second, controls, symmetric)
    place = Motion(point.x, np.array([point.value, value]))
    still, nothing = np.zeros_like(point.x), np.zeros(2)
    # A fold, or a bifurcation, is found at this second value; a cusp across its own mode.
    level = Motion(still, np.array([0.0, controls[1].unit]))
    across = Motion(modes[0], nothing)
    leaves = special.kind != FOLD and not symmetric
    normal = across if leaves else level
    found = None
    with suppress(LinAlgError):
        there = trial(course, point.family, place, modes).completed(normal, 0)
        found = correct(course, point.family, place, normal, modes, there.steepness)
    if found is None or found.model.residual > RESIDUAL_TOLERANCE:
        raise SpecError("locus.point", f"{special!r}: no such point found again")
    return replace(found, special=(Special.CUSP if leaves else Special.START))


def _broken(special: SpecialPoint, second: str) -> str:
    """Return which symmetry a second parameter takes from a bifurcation."""
    symmetry = ", ".join(special.breaks) or "symmetry of the branch"
    return f"{second} breaks what the bifurcation needs ({symmetry})"


def follow_locus(
    start: LocusPoint, stop: Callable[[LocusPoint], bool] = lambda point: False
) -> Iterator[LocusPoint]:
    """Yield the points of a curve from a start both ways, special ones among them.

    The last one each way says why the curve ends there. Arclength counts from the start,
    negative the second way. Where `stop` is true strands meet, and the curve ends.
    """
    yield start
    for way, first in ((1, start), (-1, start.reversed())):
        end = ""
        for point in _arm(first, stop):
            yield replace(point, arclength=way * point.arclength)
            end = point.end
        if end == End.CLOSED:
            return


def _arm(start: LocusPoint, stop: Callable[[LocusPoint], bool]) -> Iterator[LocusPoint]:
    """Yield the points after a start, in the direction it heads."""
    control = start.course.controls[0]
    before, step = start, control.first_step
    for number in range(control.max_points):
        after = None
        while after is None and step > control.smallest_step:
            after = _advance(before, step)
            step = step if after is not None else 0.5 * step
        if after is None:
            yield replace(before, special="", end=End.LOST)
            return
        yield from _special_points(before, after)
        end = End.STRANDS if stop(after) else _end(start, before, after, number)
        yield replace(after, end=end)
        if end:
            return
        if after.corrections <= _EASY:
            step = min(1.5 * step, control.largest_step)
        before = after


def _advance(before: LocusPoint, step: float) -> LocusPoint | None:
    """Return the point at arclength `step` from another; None if not corrected."""
    after = _from(before, before.place + before.direction * step, before)
    if after is None or not before.energy.reaches(before.model.x, after.model.x):
        return None
    if after.dot(before.direction, after.direction) < _STRAIGHT:
        return None
    if not after.energy.holds(after.model.x):
        near = replace(after, family=after.family.near(after.model.x))
        after = _from(near, after.place, after) or after
    return replace(after, arclength=before.arclength + step)


def _from(near: LocusPoint, guess: Motion, heading: LocusPoint) -> LocusPoint | None:
    """Return the point in the hyperplane through a guess, by what is known near by."""
    modes = [near.model.displacement(mode) for mode in near.modes.T]
    return correct(
        near.course, near.family, guess, heading.direction, modes, near.steepness
    )


def _end(start: LocusPoint, before: LocusPoint, after: LocusPoint, number: int) -> str:
    """Return why a curve ends at a point, or nothing."""
    course = after.course
    if not course.inside(after.values):
        return End.WINDOW
    if after.model.residual > RESIDUAL_TOLERANCE:
        return End.UNBALANCED
    if number >= _FIRST_LEAST and _passed(start, before, after):
        return End.CLOSED
    return End.ENOUGH if number + 1 == course.controls[0].max_points else ""


def _passed(start: LocusPoint, before: LocusPoint, after: LocusPoint) -> bool:
    """Return whether the start lies between two points of its curve."""
    way, there = after.place - before.place, start.place - before.place
    length = after.dot(way, way)
    part = after.dot(way, there) / length
    off = there - way * part
    near = after.dot(off, off) < 0.05**2 * length
    return 0 < part <= 1 and near and after.dot(way, start.direction) > 0


def _special_points(before: LocusPoint, after: LocusPoint) -> Iterator[LocusPoint]:
    """Yield what is special between two neighbouring points, in order of arclength."""
    found = []
    # Where a bifurcation leaves folds their curve starts from its cusp.
    known = before.special == Special.CUSP
    if not known and before.coefficient * after.coefficient < 0:
        point = _located(before, after, lambda point: point.coefficient)
        if point is not None:
            found.append((point, _nature(point)))
    turns = before.direction.rates[1] * after.direction.rates[1] < 0
    # At a cusp both parameters turn, as where folds are mirror images beyond.
    if (
        turns
        and not known
        and not any(kind in (Special.CUSP, Special.MEETING) for _, kind in found)
    ):
        point = _located(before, after, lambda point: float(point.direction.rates[1]))
        if point is not None:
            found.append((point, Special.TURN))
    ends = before.n_unstable, after.n_unstable
    for number in range(min(ends), max(ends)):
        point = _located(before, after, partial(_other, number))
        if point is not None:
            found.append((point, Special.DOUBLE))
    for point, kind in sorted(found, key=lambda pair: pair[0].arclength):
        yield replace(point, special=kind)


def _other(number: int, point: LocusPoint) -> float:
    """Return an eigenvalue of a mode that is not followed."""
    return float(point.others[number])


def _nature(point: LocusPoint) -> Special:
    """Return what it means that the coefficient vanishes."""
    if point.course.symmetric:
        return Special.NATURE
    course, mode = point.course, point.modes[:, 0]
    names = point.family.parameter, course.second
    parts = [
        part_along(point.energy, point.model, mode, name, unit)
        for name, unit in zip(names, course.units, strict=True)
    ]
    return Special.MEETING if max(parts) < NO_PART else Special.CUSP


def _located(
    before: LocusPoint, after: LocusPoint, test: Callable[[LocusPoint], float]
) -> LocusPoint | None:
    """Return the point between two others where a test vanishes; None if it is lost."""
    way = after.place - before.place
    reach = after.dot(before.direction, way)
    known: dict[float, LocusPoint] = {0.0: before, 1.0: after}

    def value(part: float) -> float:
        if part not in known:
            near = min(known, key=lambda other: abs(other - part))
            # Where another mode is lost, or folds end, the equations are singular.
            ways = (before.place + way * (part + aside) for aside in _ASIDE)
            tried = (_from(known[near], place, before) for place in ways)
            found = next((point for point in tried if point is not None), None)
            if found is None:
                raise ArithmeticError
            known[part] = found
        return test(known[part])

    try:
        root = brentq(value, 0.0, 1.0, xtol=_PRECISION / reach)
        value(root)
    except (ArithmeticError, ValueError):
        return None
    along = root * (after.arclength - before.arclength)
    return replace(known[root], arclength=before.arclength + along)
