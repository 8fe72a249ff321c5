"""What is special on a curve of special points between two neighbours, and where it is."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import partial

import numpy as np
from scipy.linalg import LinAlgError
from scipy.optimize import brentq

from eulerplateau.branches.control import Motion
from eulerplateau.branches.locus_point import LocusPoint, correct
from eulerplateau.branches.normal_form import NO_PART, part_along

_PRECISION = 1e-11  # arclength to which special points are located
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


@dataclass(frozen=True)
class Ahead:
    """Where a curve goes on from a point, as far as it turned between the ones before.

    By the directions of up to three (Adams and Bashforth 1883): what none of them has in
    it, as rigid motions, no step adds.

    Attributes
    ----------
    reach : float, the way to the point from the one before, or 0
    turned, steeper : how direction and steepness change, by arclength, on that way
    bent, bowed : how these do, from the way before
    """

    point: LocusPoint
    reach: float
    turned: Motion
    steeper: Motion
    bent: Motion
    bowed: Motion

    @classmethod
    def straight(cls, point: LocusPoint) -> Ahead:
        """Return what is known of a first point alone."""
        still = point.direction * 0.0
        return cls(point, 0.0, still, still, still, still)

    def then(self, point: LocusPoint) -> Ahead:
        """Return what is known of the next point."""
        before, way = self.point, point.direction
        reach = point.dot(way, point.place - before.place)
        turned = way - before.direction * (1 / point.dot(way, before.direction))
        turned, steeper = (
            change * (1 / reach) for change in (turned, point.steepness - before.steepness)
        )
        if self.reach == 0:
            return Ahead(point, reach, turned, steeper, way * 0.0, way * 0.0)
        both = 1 / (reach + self.reach)
        bent, bowed = (turned - self.turned) * both, (steeper - self.steeper) * both
        return Ahead(point, reach, turned, steeper, bent, bowed)

    def reached(self, step: float) -> LocusPoint | None:
        """Return the point at arclength `step` from there; None if it is not corrected."""
        point, beyond = self.point, step + self.reach
        bend = step**2 * (step / 3 + self.reach / 2)
        guess = point.place + point.direction * step + self.turned * (0.5 * step**2)
        steepness = point.steepness + self.steeper * step + self.bowed * (step * beyond)
        near = replace(point, steepness=steepness)
        found = corrected(near, guess + self.bent * bend, point)
        with suppress(LinAlgError):
            return found if found is None or np.isfinite(found.coefficient) else None
        return None


def corrected(near: LocusPoint, guess: Motion, heading: LocusPoint) -> LocusPoint | None:
    """Return the point in the hyperplane through a guess, by what is known near by."""
    modes = [near.model.displacement(mode) for mode in near.modes.T]
    return correct(
        near.course, near.family, guess, heading.direction, modes, near.steepness
    )


def special_points(before: LocusPoint, after: LocusPoint) -> Iterator[LocusPoint]:
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
            tried = (corrected(known[near], place, before) for place in ways)
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
