"""An interval of a branch between two points, and where on it something vanishes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from eulerplateau.branches.brent import zero_between
from eulerplateau.branches.control import Hyperplane, StepControl
from eulerplateau.branches.family import Family
from eulerplateau.branches.point import NOISE, BranchPoint, along, correct

_PRECISION = 1e-14
# Part of an interval about what has been located there in which it is located again.
_ABOUT = 0.1
# How often a film is made anew at what has been located, until its forces balance.
_RENEWALS = 4
_ROUNDING = 4 * float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Interval:
    """An interval of a branch between two neighbouring points."""

    before: BranchPoint
    after: BranchPoint
    control: StepControl

    @property
    def length(self) -> float:
        """Arclength from one end to the other."""
        return self.after.arclength - self.before.arclength

    @property
    def crossing(self) -> range:
        """Numbers of the eigenvalues that change sign; rounding is no sign."""
        ends = self.before.stability, self.after.stability
        fewer, more = sorted(ends, key=lambda end: end.n_unstable)
        return range(fewer.n_unstable + fewer.n_neutral, more.n_unstable)

    def locate(
        self, test: Callable[[BranchPoint], float], tries: int | None = None
    ) -> BranchPoint | None:
        """Return the point where `test(point)` vanishes; None if it is lost.

        After so many `tries`, where they are limited, the nearest point so far.

        All points are corrected in hyperplanes normal to the direction at `before`, from
        a guess between known ones: at a bifurcation a point's own direction means nothing,
        and a long step could land on the other branch.
        """
        reach = along(self.before, self.after, self.control)
        points = {0.0: self.before, reach: self.after}

        def value(step: float) -> float:
            if step not in points:
                points[step] = self._between(points, step)
            return test(points[step])

        try:
            if value(0.0) * value(reach) > 0:
                return None
            root = zero_between(value, 0.0, reach, _PRECISION, tries=tries or 100)
            value(root)
        except ArithmeticError:
            return None
        return points[root]

    def zero(self, index: int) -> BranchPoint | None:
        """Return the point where an eigenvalue that changes sign does so; None if lost."""
        return self.locate(partial(eigenvalue, index, 0.0))

    def about(self, point: BranchPoint, family: Family) -> Interval | None:
        """Return the part about a point, in a family made anew there; None if lost."""
        ends = []
        for end in (self.before, self.after):
            x = point.x + _ABOUT * (end.x - point.x)
            value = point.value + _ABOUT * (end.value - point.value)
            found = correct(family, x, value, self.before.direction, self.control)
            if found is None:
                return None
            arclength = point.arclength + _ABOUT * (end.arclength - point.arclength)
            ends.append(replace(found, arclength=arclength))
        before, after = ends
        return Interval(before, after, self.control)

    def at_rest(
        self, locate: Callable[[Interval], BranchPoint | None]
    ) -> tuple[Interval, BranchPoint] | None:
        """Return what is located once forces balance there, and in which interval.

        A film is good near one shape: where that is too far, what is located has moved a
        little, and the film is made anew there. None if it is not located at all.
        """
        interval, point = self, locate(self)
        for _ in range(_RENEWALS):
            if point is None or point.family.rests(point.model, point.value):
                break
            part = self.about(point, point.family.near(point.x))
            again = None if part is None else locate(part)
            if part is None or again is None:
                break
            interval, point = part, again
        return None if point is None else (interval, point)

    def nearly_zero(self, index: int, level: float, tries: int) -> bool:
        """Whether an eigenvalue that changes sign is found at `level`, in so many tries."""
        near = self.locate(partial(eigenvalue, index, level), tries)
        return near is not None and abs(near.stability.eigenvalues[index]) <= level

    def rise(self, index: int) -> float:
        """Return by how much an eigenvalue rises, or falls, from one end to the other."""
        before, after = self.before.stability, self.after.stability
        return abs(float(after.eigenvalues[index] - before.eigenvalues[index]))

    def _between(self, points: dict[float, BranchPoint], step: float) -> BranchPoint:
        below = max(known for known in points if known < step)
        above = min(known for known in points if known > step)
        low, high = points[below], points[above]
        part = (step - below) / (above - below)
        guess = low.x + part * (high.x - low.x)
        value = low.value + part * (high.value - low.value)
        found = correct(
            self.before.family.steady(self.before.x),
            guess,
            value,
            self.before.direction,
            self.control,
            (NOISE, 0.0),
        )
        if found is None:
            raise ArithmeticError
        plane = Hyperplane(guess, value, self.before.direction, self.control)
        there: BranchPoint | None = found.family.settled(found, plane)
        if there is None:
            raise ArithmeticError
        return replace(there, arclength=self.before.arclength + step)

    def error(self, point: BranchPoint, index: int) -> float:
        """Return what rounding in an eigenvalue can have moved its zero by."""
        doubt = abs(point.stability.eigenvalues[index]) + point.stability.error_bound
        arclength = doubt * self.length / max(self.rise(index), doubt)
        # At a fold the parameter is stationary, elsewhere it changes with the arclength.
        moved = arclength * abs(point.direction.rate)
        return float(moved + _ROUNDING * self.control.scale(point.value))


def parameter_rate(level: float, point: BranchPoint) -> float:
    """Return how fast the parameter rises along the branch, as zero where below `level`."""
    rate = point.direction.rate
    return 0.0 if abs(rate) <= level else rate


def eigenvalue(index: int, level: float, point: BranchPoint) -> float:
    """Return an eigenvalue, as zero up to `level` and where rounding decides its sign.

    Closer to a bifurcation than that the corrector would follow rounding along the mode.
    """
    found = point.stability
    value = float(found.eigenvalues[index])
    return 0.0 if abs(value) <= max(level, found.error_bound) else value
