"""Points of a branch at which strands along each other are kept apart everywhere.

A branch is followed with strands held once an edge where they lie along each other, so that
it has few kinks; in between they overlap. What is recorded of it is the point next to
that on which no gap is negative, by the exchange of solvers.contact.everywhere. There a
minimum is sought; here forces balance with each set of places, across the branch, so that
the parameter is free to move: at folds too, and whatever the index.

Loaded only for loops that have a diameter.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Protocol, cast

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.contact import Contact
from eulerplateau.branches.control import Direction, StepControl
from eulerplateau.branches.family import Family
from eulerplateau.branches.gap_bounds import Touch
from eulerplateau.branches.point import BranchPoint, correct, inner
from eulerplateau.film import FilmOfLoop
from eulerplateau.interruption import heed
from eulerplateau.loop import NO_GAPS, Gaps, from_one_strand
from eulerplateau.solvers import Everywhere, Problem, TangentModel, Touching, sharpened
from eulerplateau.solvers.descent import at_rounding
from eulerplateau.solvers.equilibrium import SOFTEST_BENDING

# Steps of the exchange; and times that a film is made anew until its forces balance.
_STEPS, _MADE_ANEW = 60, 4


class FilmOnLoop(Family, Protocol):
    """A family of films on a loop with a diameter: a film_family.FilmFamily of one."""

    @property
    def film(self) -> FilmOfLoop:
        """The film, good near one shape."""

    @property
    def contact(self) -> object:
        """Which gaps are closed: a Contact."""

    def at(self, value: float) -> tuple[Problem, float]:
        """Return the problem and its load at a value of the parameter."""

    def on(self, film: FilmOfLoop, contact: Contact | None = None) -> FilmOnLoop:
        """Return the family of another film, or with other gaps closed."""

    def rests(self, model: TangentModel, value: float) -> bool:
        """Return whether forces balance there."""


def apart_everywhere(point: BranchPoint, way: Direction) -> BranchPoint:
    """Return the point next to one of a film's branch at which strands overlap nowhere.

    It lies in the hyperplane through that normal to a way. The point itself if none is
    found.
    """
    if _contact(point.family).touch.gaps.slides.all():
        return point
    return _Across(point, way).settled() or point


@dataclass(frozen=True)
class _At(Touching):
    """A point of a branch, as what an exchange changes."""

    point: BranchPoint = field(kw_only=True)

    @property
    def keeps(self) -> Everywhere:
        """What keeps strands apart there."""
        family = cast(FilmOnLoop, self.point.family)
        problem, load = family.at(self.point.value)
        strands = _contact(family).bounds(problem.loop).strands
        return Everywhere(family.film.energy(problem.loop, load), strands, at_rounding)


@dataclass(frozen=True)
class _Across:
    """The hyperplane through a point of a branch normal to a way."""

    point: BranchPoint
    way: Direction

    def settled(self) -> BranchPoint | None:
        """Return the point in it at which no gap is negative, and nothing pulls."""
        state, known = _at(self.point), NO_GAPS
        for _ in range(_STEPS):
            heed()
            keeps = state.keeps
            overlaps = keeps.overlaps(state)
            if not len(overlaps) and keeps.pushes(state):
                return self._sharpened(state).point
            known = keeps.together(known, overlaps)
            after = self._exchanged(state, known)
            if after is None:
                break
            state = after
        return None

    def _exchanged(self, state: _At, known: Gaps) -> _At | None:
        """Return the state with what a step of the program closes, of all known."""
        keeps, x = state.keeps, state.model.x
        own = from_one_strand(keeps.strands.knots, state.gaps)
        try:
            led = keeps.closing(state, _stiff(state), keeps.together(own, known))
        except LinAlgError:
            return None
        if led is None:
            return None
        near, gaps = led
        # What closes in on a point may be two all the same.
        sets = chain(keeps.fewer(keeps.points(x, gaps)), keeps.fewer(gaps))
        found = (self._resting(state.point, near, some) for some in sets)
        return next((each for each in found if each is not None), None)

    def _sharpened(self, state: _At) -> _At:
        """Return the state with places where strands are nearest, if they are found."""

        def rest(x: FloatArray, gaps: Gaps) -> _At | None:
            return self._resting(state.point, x, gaps)

        return sharpened(state.keeps.strands, state, rest) or state

    def _resting(self, near: BranchPoint, x: FloatArray, gaps: Gaps) -> _At | None:
        """Return the state at which forces balance with gaps closed, next to a loop (n, d).

        The film is made anew there until they do.
        """
        family = cast(FilmOnLoop, near.family)
        touch = Touch(gaps, ~gaps.slides)
        family = family.on(family.film, replace(_contact(family), touch=touch))
        value = near.value
        for _ in range(_MADE_ANEW):
            found = self._corrected(family, x, value)
            if found is None or family.rests(found.model, found.value):
                break
            x, value = found.x, found.value
            family = family.on(family.film.renewed(x))
        return None if found is None else _at(found)

    def _corrected(self, family: Family, x: FloatArray, value: float) -> BranchPoint | None:
        """Return the point of a family in the hyperplane next to a loop; None if lost."""
        point, control = self.point, self._control
        size = np.sqrt(inner(point.model, self.way, self.way, control))
        way = Direction(self.way.displacement / size, self.way.rate / size)
        off = Direction(x - point.x, value - point.value)
        back = inner(point.model, way, off, control)
        x, value = x - back * way.displacement, value - back * way.rate
        with suppress(LinAlgError):
            found = correct(family, x, value, way, control)
            # Overlaps are parts of a diameter: what lies farther is another film.
            if found is not None and np.abs(found.x - point.x).max() < self._diameter:
                return replace(found, arclength=point.arclength)
        return None

    @property
    def _diameter(self) -> float:
        return _at(self.point).keeps.strands.diameter

    @property
    def _control(self) -> StepControl:
        value = self.point.value
        return StepControl((value, value), unit=max(abs(value), 1.0), least=-np.inf)


def _at(point: BranchPoint) -> _At:
    """Return a point of a branch as a state."""
    gaps = _contact(point.family).touch.gaps
    state = _At(point.model, gaps, NO_GAPS, radius=0.0, iteration=0, point=point)
    gaps, _ = state.keeps.strands.at(point.x, gaps)
    return replace(state, gaps=gaps)


def _stiff(state: _At) -> TangentModel:
    """Return the model of a state that keeps lengths only, stiff along its softest modes.

    Closing gaps makes it move along none that is unstable, or about to be.
    """
    loose, (values, vectors) = state.keeps.loose(state), state.model.eigen
    soft = values < SOFTEST_BENDING
    modes = (state.model.displacement(each) for each in vectors[:, soft].T)
    columns = np.array([loose.coefficients(mode) for mode in modes])
    more = (SOFTEST_BENDING - values[soft])[:, None] * columns
    return replace(loose, hessian=loose.hessian + columns.T @ more)


def _contact(family: Family) -> Contact:
    contact = cast(FilmOnLoop, family).contact
    assert isinstance(contact, Contact)
    return contact
