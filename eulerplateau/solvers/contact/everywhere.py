"""Strands that lie along each other, kept apart between the places they are held at too.

Held at one place an edge they overlap between two places, most of all near the end of a
stretch: a force stands there, and no place does. So where the gap is least in between it is
held as well, and places are let go at which strands would pull, until no gap is negative.
That is an exchange method for infinitely many inequalities (Hettich and Kortanek 1993,
section 7), each step of it one of the quadratic program.

What this comes to is the least energy of loops on which no gap is negative, whatever places
it began with. Its own are as many, or fewer, and nearer to each other at the ends.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.interruption import heed
from eulerplateau.loop import Gaps, LoopEnergy, Strands, from_one_strand, with_gaps_held
from eulerplateau.solvers.contact.keeping import CHANGES, Touching
from eulerplateau.solvers.contact.program import Program
from eulerplateau.solvers.second_variation import (
    TangentModel,
    loosened,
    stability,
    tangent_model,
)
from eulerplateau.solvers.trust_region import FIRST_RADIUS

# By which part of the diameter strands may overlap at places that are not held. One is not
# held beside another that is nearer than this, in edges.
OVERLAP = 1e-6
_BESIDE = 0.02
# Places no farther from each other than that, in edges, and from no others, are a point.
_POINT = 0.3
# Where a loop slides far along itself before it rests, its places wander as far.
_STEPS = 200
# With places held where they are Newton's method leads astray if these have far to wander:
# its step is one of the program's if forces balance so many times worse after it.
_ASTRAY = 10.0
# Places that cannot be closed at once hang together: of those within so many edges of one
# before them, it alone is held.
_TOGETHER = (0.0, 0.1, 0.3, 1.0)


@dataclass(frozen=True)
class Everywhere:
    """How strands are kept apart everywhere; `at_rest` says where forces balance."""

    energy: LoopEnergy
    strands: Strands
    at_rest: Callable[[TangentModel], bool]

    def settled(self, state: Touching) -> Touching | None:
        """Return the minimum next to a state near rest on which no strands overlap.

        None if none is found.
        """
        state = replace(state, changes=CHANGES)
        known = self._overlaps(state)
        found = self._from_one_strand(state) if len(known) else state
        for _ in range(_STEPS):
            heed()
            if found is None:
                break
            overlaps = self._overlaps(found)
            if not len(overlaps) and self.at_rest(found.model) and self._pushes(found):
                return found if stability(found.model).n_unstable == 0 else None
            known = known.joined(overlaps[self.strands.unlike(overlaps, known, _BESIDE)])
            found = self._after_step(found, known, closes=len(overlaps) > 0)
        return None

    def again(self, state: Touching, x: FloatArray) -> Touching | None:
        """Return what one that was settled, by another energy, comes to from near there."""
        found = self._at(state, x, state.gaps)
        return None if found is None else self.settled(found)

    def _from_one_strand(self, state: Touching) -> Touching | None:
        """Return the state with stretches held from one strand each."""
        gaps = from_one_strand(self.strands.knots, state.gaps)
        if np.array_equal(gaps.s, state.gaps.s):
            return state
        return self._at(state, state.model.x, gaps)

    def _pushes(self, state: Touching) -> bool:
        return bool((state.forces >= -state.uncertain).all())

    def _overlaps(self, state: Touching) -> Gaps:
        """Return the places where strands overlap most, that are not held."""
        low = self.strands.nearest(state.model.x, -OVERLAP * self.strands.diameter)
        low = low[self.strands.unlike(low, state.gaps, _BESIDE)]
        return from_one_strand(self.strands.knots, low, state.gaps[~state.gaps.slides])

    def _after_step(self, state: Touching, known: Gaps, *, closes: bool) -> Touching | None:
        """Return the state after a step; if need be it closes gaps and lets go of others.

        known : places where strands have overlapped on the way, and may again
        """
        x, gaps = state.model.x, state.gaps
        try:
            newton = state.model.newton_step(FIRST_RADIUS)
            if newton is not None and not closes and self._pushes(state):
                found = self._at(state, x + newton.moved, gaps)
                most = _ASTRAY * state.model.residual
                if found is not None and found.model.residual <= most:
                    return found
            others = known[self.strands.unlike(known, gaps, _BESIDE)]
            led = self._closing(state, gaps.joined(others))
            return None if led is None else self._at(state, *led)
        except LinAlgError:
            return None

    def _closing(self, state: Touching, gaps: Gaps) -> tuple[FloatArray, Gaps] | None:
        """Return the loop (n, d) that a step of the program leads to, and what it closes.

        gaps : those of the state, and others behind them
        """
        x, strands = state.model.x, self.strands
        held = with_gaps_held(self.energy, strands, state.gaps)
        loose = loosened(self.energy, held, state.model)
        gaps, widths = strands.at(x, gaps)
        rows = loose.coordinates.slope(strands.between(x, gaps).jacobian().T).T
        closed = np.arange(len(gaps)) < len(state.gaps)
        program = Program(loose.gradient, loose.hessian, widths, rows, closed)
        found = program.step(FIRST_RADIUS)
        if found is None:
            return None
        coefficients, closes = found
        return x + loose.displacement(coefficients), self._points(x, gaps[closes])

    def _points(self, x: FloatArray, gaps: Gaps) -> Gaps:
        """Return gaps with one that slides for places that close in on a point."""
        contact, chosen = self.strands.contacts(gaps), np.ones(len(gaps), dtype=bool)
        for number in np.unique(contact[~gaps.slides]):
            own = contact == number
            first = np.flatnonzero(own)[0]
            only = np.arange(len(gaps)) == first
            point = replace(gaps[only], slides=only[only])
            short = not self.strands.unlike(gaps[own], gaps[only], _POINT).any()
            if short and not self.strands.laid_along(x, point)[0]:
                chosen &= ~own | only
                gaps = replace(gaps, slides=gaps.slides | only)
        return gaps[chosen]

    def _at(self, state: Touching, near: FloatArray, gaps: Gaps) -> Touching | None:
        """Return the state on the loop next to that, with gaps closed, or most of them."""
        for edges in _TOGETHER:
            with suppress(LinAlgError):
                some = gaps[self.strands.distinct(gaps, edges)]
                found = self._closed(state, near, some)
                if found is not None:
                    return found
        return None

    def _closed(self, state: Touching, near: FloatArray, gaps: Gaps) -> Touching | None:
        """Return the state on the loop next to that, all gaps closed; None without one."""
        held = with_gaps_held(self.energy, self.strands, gaps)
        x = held.constraint.project(near)
        if x is None or not self.energy.holds(x):
            return None
        model = tangent_model(held, x)
        gaps, _ = self.strands.at(x, gaps)
        return replace(state, model=model, gaps=gaps, iteration=state.iteration + 1)
