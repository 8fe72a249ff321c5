"""Points of a branch at which strands along each other are kept apart everywhere.

A step is taken with strands held where they touched, and beyond it they overlap beside
those places. What it comes to is the point next to that on which no gap is negative
(exchange.py), across the branch: the parameter is free to move, so that there is one at
folds too, and whatever the index.

Loaded only for loops that have a diameter.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, Protocol, cast

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.control import Direction, Hyperplane, StepControl
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

    def near(self, x: FloatArray) -> Closed:
        """Return the gaps of the kind, and at the places, they should be at x (n, d)."""


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
    value = point.value
    control = StepControl((value, value), unit=max(abs(value), 1.0), least=-np.inf)
    across = _Anew(point, Hyperplane(point.x, value, way, control))
    state: _At | None = _at(point, None)
    if not _family(point).rests(point.model, value):
        state = across.rest(point.x, _closed(_family(point)).gaps)
    found = None if state is None else without_overlaps(state, across.rest)
    return point if found is None else found.point


def contacts_settled(point: BranchPoint, plane: Hyperplane) -> BranchPoint | None:
    """Return the point of a hyperplane next to one, no strands overlapping in contacts.

    These stay as they are, though they pull, and others may overlap: where they do so
    first, branches have their kinks. None if none is found. See apart_everywhere.
    """
    across = _Across(point, plane, _closed(_family(point)).gaps)
    found = without_overlaps(_at(point, across.within), across.rest)
    if found is None:
        return None
    x, closed = found.model.x, _closed(_family(found.point))
    placed = closed.near(x)
    if len(placed.gaps) != len(closed.gaps):
        found = across.rest(x, placed.gaps)
    return None if found is None else found.point


@dataclass(frozen=True)
class _At(Held):
    """A point of a branch, as what an exchange changes."""

    point: BranchPoint = field(kw_only=True)


@dataclass(frozen=True)
class _Across:
    """Points of a hyperplane near one of a branch.

    within : as of Held
    """

    point: BranchPoint
    plane: Hyperplane
    within: Gaps | None = None

    def rest(self, x: FloatArray, gaps: Gaps) -> _At | None:
        """Return the state in it at rest next to a loop (n, d), with gaps closed."""
        found = self._corrected(self._closing(gaps), x, self.point.value)
        return None if found is None else _at(found, self.within)

    def _closing(self, gaps: Gaps) -> FilmOnLoop:
        """Return the point's family with gaps closed."""
        family = _family(self.point)
        return family.on(family.film, _closed(family).with_closed(gaps))

    def _corrected(self, family: Family, x: FloatArray, value: float) -> BranchPoint | None:
        """Return the point of a family in the hyperplane next to a loop; None if lost."""
        point, plane = self.point, self.plane
        problem, _ = _family(point).at(value)
        far = _FAR * _closed(_family(point)).strands_on(problem.loop).diameter
        way, control = plane.way, plane.control
        size = np.sqrt(inner(point.model, way, way, control))
        way = Direction(way.displacement / size, way.rate / size)
        off = Direction(x - plane.x, value - plane.value)
        back = inner(point.model, way, off, control)
        x, value = x - back * way.displacement, value - back * way.rate
        with suppress(LinAlgError):
            found = correct(family, x, value, way, control)
            if found is not None and np.abs(found.x - point.x).max() < far:
                return replace(found, arclength=point.arclength)
        return None


@dataclass(frozen=True)
class _Anew(_Across):
    """The same of films that are made anew until forces balance."""

    def rest(self, x: FloatArray, gaps: Gaps) -> _At | None:
        """Return the state in it at rest next to a loop (n, d), with gaps closed."""
        family, value = self._closing(gaps), self.point.value
        for _ in range(_MADE_ANEW):
            found = self._corrected(family, x, value)
            if found is None or family.rests(found.model, found.value):
                break
            x, value = found.x, found.value
            family = family.on(family.film.renewed(x))
        return None if found is None else _at(found, self.within)


def _at(point: BranchPoint, within: Gaps | None) -> _At:
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
        within=within,
    )


def _family(point: BranchPoint) -> FilmOnLoop:
    return cast(FilmOnLoop, point.family)


def _closed(family: FilmOnLoop) -> Closed:
    closed: Closed = family.contact
    return closed
