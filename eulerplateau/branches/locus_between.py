"""What is special on a curve of special points between two neighbours, and where it is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from enum import StrEnum
from functools import partial

from eulerplateau.branches.brent import zero_between
from eulerplateau.branches.control import Motion
from eulerplateau.branches.locus_point import LocusPoint
from eulerplateau.branches.normal_form import NO_PART, part_along

# Arclength to which special points are located, and those where a fourth derivative, by
# differences, vanishes: beyond that its sign is rounding's.
_PRECISION, _ROUGHLY = 1e-11, 1e-8
# Parts of the way between two points by which a singular one is passed.
_ASIDE = 0.0, 1e-9, 1e-6, 1e-4, 1e-3


class Special(StrEnum):
    """What is special about a point of a curve of special points."""

    START = "start"
    CUSP = "cusp"
    NATURE = "super- to subcritical"
    MEETING = "fold meets bifurcation"
    DOUBLE = "another mode is lost"
    TURN = "turn"


class Resolution:
    """How well a curve's loops are resolved: here as they are, whatever stands for them."""

    def resolved(self, point: LocusPoint) -> LocusPoint:
        """Return the same point with as many unknowns as it needs, or itself."""
        return point

    def carried(self, motion: Motion, old: LocusPoint, new: LocusPoint) -> Motion:
        """Return what a motion in the unknowns of one point is in those of another."""
        return motion


def special_points(before: LocusPoint, after: LocusPoint) -> Iterator[LocusPoint]:
    """Yield what is special between two neighbouring points, in order of arclength."""
    found = []
    # Where a bifurcation leaves folds their curve starts from its cusp.
    known = before.special == Special.CUSP
    if not known and before.coefficient * after.coefficient < 0:
        precision = _ROUGHLY if before.course.symmetric else _PRECISION
        point = _located(before, after, lambda point: point.coefficient, precision)
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


def between(
    before: LocusPoint, after: LocusPoint, part: float, way: Motion
) -> tuple[Motion, Motion]:
    """Return place and steepness part of the way, along a direction, between two points.

    By Hermite's cubic through both, and linearly.
    """
    gap = after.place - before.place
    reach = before.dot(way, gap)
    slopes = [it.direction * (reach / it.dot(way, it.direction)) for it in (before, after)]
    rest = 1 - part
    place = before.place + gap * (part**2 * (3 - 2 * part))
    place += slopes[0] * (part * rest**2) - slopes[1] * (part**2 * rest)
    return place, before.steepness * rest + after.steepness * part


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
    before: LocusPoint,
    after: LocusPoint,
    test: Callable[[LocusPoint], float],
    precision: float = _PRECISION,
) -> LocusPoint | None:
    """Return the point between two others where a test vanishes; None if it is lost."""
    way = after.place - before.place
    reach = after.dot(before.direction, way)
    known: dict[float, LocusPoint] = {0.0: before, 1.0: after}

    def value(part: float) -> float:
        if part not in known:
            near = known[min(known, key=lambda other: abs(other - part))]
            low = max(other for other in known if other < part)
            high = min(other for other in known if other > part)
            inner = (part - low) / (high - low)
            guess, steepness = between(known[low], known[high], inner, before.direction)
            near = replace(near, steepness=steepness)
            # Where another mode is lost, or folds end, the equations are singular.
            places = (guess + way * aside for aside in _ASIDE)
            tried = (near.next_to(place, before.direction) for place in places)
            found = next((point for point in tried if point is not None), None)
            if found is None:
                raise ArithmeticError
            known[part] = found
        return test(known[part])

    try:
        if value(0.0) * value(1.0) > 0:
            return None
        root = zero_between(value, 0.0, 1.0, precision / reach)
        value(root)
    except ArithmeticError:
        return None
    along = root * (after.arclength - before.arclength)
    return replace(known[root], arclength=before.arclength + along)
