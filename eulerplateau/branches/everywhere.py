"""Points of a branch at which strands along each other are kept apart everywhere.

A branch is followed with strands held once an edge where they lie along each other, so that
it has few kinks; in between they overlap. What is recorded of it is the point next to
that on which no gap is negative (exchange.py), across the branch: the parameter is free to
move, so that there is one at folds too, and whatever the index.

Loaded only for loops that have a diameter.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, cast

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.control import Direction, StepControl
from eulerplateau.branches.exchange import Held, without_overlaps
from eulerplateau.branches.family import Family
from eulerplateau.branches.point import BranchPoint, correct, inner
from eulerplateau.film import FilmOfLoop
from eulerplateau.loop import NO_GAPS, Gaps, Loop, Strands
from eulerplateau.solvers import TangentModel

# Times that a film is made anew until its forces balance; and how far a point may be moved,
# in diameters: overlaps are small parts of one, and what lies farther is another film.
_MADE_ANEW, _FAR = 4, 0.2


class Closed(Protocol):
    """Which gaps are closed: a contact.Contact."""

    @property
    def gaps(self) -> Gaps:
        """They themselves."""

    def strands_on(self, loop: Loop) -> Strands:
        """Return the strands of a loop, whatever its diameter."""

    def with_closed(self, gaps: Gaps) -> Closed:
        """Return the same with other gaps closed."""


class OnLoop(Protocol):
    """What a family knows of its loop: a solvers.Problem."""

    @property
    def loop(self) -> Loop:
        """The loop."""


class FilmOnLoop(Family, Protocol):
    """A family of films on a loop with a diameter: a film_family.FilmFamily of one."""

    @property
    def film(self) -> FilmOfLoop:
        """The film, good near one shape."""

    @property
    def contact(self) -> Any:
        """Which gaps are closed: Closed; nothing of a loop without a diameter."""

    def at(self, value: float) -> tuple[OnLoop, float]:
        """Return the problem and its load at a value of the parameter."""

    def on(self, film: FilmOfLoop, contact: Any = None) -> FilmOnLoop:
        """Return the family of another film, or with other gaps closed."""

    def rests(self, model: TangentModel, value: float) -> bool:
        """Return whether forces balance there."""


def apart_everywhere(point: BranchPoint, way: Direction) -> BranchPoint:
    """Return the point next to one of a film's branch at which strands overlap nowhere.

    It lies in the hyperplane through that normal to a way. The point itself if none is
    found.
    """
    state = _at(point)
    across = _Across(point, way, _FAR * state.strands.diameter)
    found = without_overlaps(state, across.rest)
    return point if found is None else found.point


@dataclass(frozen=True)
class _At(Held):
    """A point of a branch, as what an exchange changes."""

    point: BranchPoint = field(kw_only=True)


@dataclass(frozen=True)
class _Across:
    """The hyperplane through a point of a branch normal to a way, up to so far from it."""

    point: BranchPoint
    way: Direction
    far: float

    def rest(self, x: FloatArray, gaps: Gaps) -> _At | None:
        """Return the state in it at rest next to a loop (n, d), with gaps closed.

        The film is made anew there until forces balance.
        """
        family, value = _family(self.point), self.point.value
        family = family.on(family.film, _closed(family).with_closed(gaps))
        for _ in range(_MADE_ANEW):
            found = self._corrected(family, x, value)
            if found is None or family.rests(found.model, found.value):
                break
            x, value = found.x, found.value
            family = family.on(family.film.renewed(x))
        return None if found is None else _at(found)

    def _corrected(self, family: Family, x: FloatArray, value: float) -> BranchPoint | None:
        """Return the point of a family in the hyperplane next to a loop; None if lost."""
        point, unit = self.point, max(abs(self.point.value), 1.0)
        control = StepControl((value, value), unit=unit, least=-np.inf)
        size = np.sqrt(inner(point.model, self.way, self.way, control))
        way = Direction(self.way.displacement / size, self.way.rate / size)
        off = Direction(x - point.x, value - point.value)
        back = inner(point.model, way, off, control)
        x, value = x - back * way.displacement, value - back * way.rate
        with suppress(LinAlgError):
            found = correct(family, x, value, way, control)
            if found is not None and np.abs(found.x - point.x).max() < self.far:
                return replace(found, arclength=point.arclength)
        return None


def _at(point: BranchPoint) -> _At:
    """Return a point of a branch as a state."""
    family = _family(point)
    problem, load = family.at(point.value)
    strands = _closed(family).strands_on(problem.loop)
    gaps, _ = strands.at(point.x, _closed(family).gaps)
    return _At(
        point.model,
        gaps,
        NO_GAPS,
        radius=0.0,
        iteration=0,
        strands=strands,
        energy=family.film.energy(problem.loop, load),
        point=point,
    )


def _family(point: BranchPoint) -> FilmOnLoop:
    return cast(FilmOnLoop, point.family)


def _closed(family: FilmOnLoop) -> Closed:
    closed: Closed = family.contact
    return closed
