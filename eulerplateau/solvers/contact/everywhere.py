"""Strands that lie along each other, kept apart between the places they are held at too.

Held at one place an edge they overlap between two places, most of all near the end of a
stretch: a force stands there, and no place does. So where the gap is least in between it is
held as well, and places are let go at which strands would pull, until no gap is negative
by more than a millionth of the diameter.
That is an exchange method for infinitely many inequalities (Hettich and Kortanek 1993,
section 7), each step of it one of the quadratic program that lowers the merit function
(merit.py), or Newton's. Near the minimum a place slides with where the gap is least, and
nothing overlaps after a step (their section 7.3, local reduction); but for strands so close
along each other that this may be anywhere.

What this comes to is the least energy of loops on which no gap is negative, whatever places
it began with. Its own are nearer to each other at the ends.
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
from eulerplateau.solvers.acceptance import SMALLEST_RADIUS
from eulerplateau.solvers.contact.keeping import CHANGES, Touching
from eulerplateau.solvers.contact.merit import LITTLE, Merit
from eulerplateau.solvers.contact.steps import Steps
from eulerplateau.solvers.second_variation import (
    NewtonStep,
    TangentModel,
    stability,
    tangent_model,
)
from eulerplateau.solvers.trust_region import FIRST_RADIUS

# By which part of the diameter strands may overlap at the end, and by which they do on the
# way so that places are looked at there. Places nearer than this, in edges, are one.
OVERLAP = 1e-6
_SEEN = 1e-9
_SAME = 0.01
# Places where strands are nearest are looked at if their gap is below so many diameters.
_NEAR = 0.1
# A place slides where strands are nearest within so many edges, by less than so much of the
# diameter nearer, if within an edge from there they spread by more: where they spread less
# it cannot be told where that is, nor need it be, and one that slid stays where it is if
# they come to spread by less than that part of it. Others nearer than that do not count
# beside it, and those that slide to places nearer than the last are one.
_SLIDES = 0.3
_NEARER = 1e-5
_STAYS = 0.5
_ONE = 0.02
# Where a loop slides far along itself before it rests, its places wander as far.
_STEPS = 400
# Places that cannot be closed at once hang together: of those within so many edges of one
# before them, it alone is held.
_TOGETHER = (0.0, 0.1, 0.3, 1.0)


@dataclass(frozen=True)
class Everywhere:
    """How strands are kept apart everywhere; `at_rest` says where forces balance."""

    energy: LoopEnergy
    strands: Strands
    at_rest: Callable[[TangentModel], bool]

    def settled(self, state: Touching) -> tuple[Touching, bool]:
        """Return what steps lead to from a state near rest, and whether it is a minimum.

        If so no strands overlap on it, and all that touch push.
        """
        state = replace(state, changes=CHANGES)
        known = self._overlaps(state.model.x, state.gaps)
        if len(known):
            state = self._from_one_strand(state)
        merit = Merit(self.energy, self.strands)
        for _ in range(_STEPS):
            heed()
            if self._rests(state):
                return state, stability(state.model).n_unstable == 0
            merit = merit.above(state.forces)
            known = self._with(known, self._overlaps(state.model.x, state.gaps))
            try:
                after = self._advance(state, known, merit)
            except LinAlgError:
                break
            if after is None:
                break
            state, known = after
        return state, False

    def again(self, state: Touching, x: FloatArray) -> Touching | None:
        """Return what one that was settled, by another energy, comes to from near there."""
        closed = self._closed(x, state.gaps)
        if closed is None:
            return None
        state, settles = self.settled(self._made(state, *closed))
        return state if settles else None

    def _from_one_strand(self, state: Touching) -> Touching:
        """Return the state with stretches held from one strand each, if they can be."""
        gaps = from_one_strand(self.strands.knots, state.gaps)
        if np.array_equal(gaps.s, state.gaps.s):
            return state
        closed = self._closed(state.model.x, gaps)
        return state if closed is None else self._made(state, *closed)

    def _rests(self, state: Touching) -> bool:
        """Return whether forces balance and only push, and no strands overlap."""
        least = self.strands.smallest_gap(state.model.x, 0.0)
        clear = least >= -OVERLAP * self.strands.diameter
        return clear and self.at_rest(state.model) and _pushes(state)

    def _overlaps(self, x: FloatArray, gaps: Gaps) -> Gaps:
        """Return the places where strands overlap most, beside those that are held."""
        return self._least(x, gaps, -_SEEN)

    def _least(self, x: FloatArray, gaps: Gaps, reach: float) -> Gaps:
        """Return where else gaps are least, and below so many diameters."""
        low = self.strands.nearest(x, reach * self.strands.diameter)
        low = low[self.strands.unlike(low, gaps, _SAME)]
        return from_one_strand(self.strands.knots, low, gaps[~gaps.slides])

    def _with(self, known: Gaps, others: Gaps) -> Gaps:
        return known.joined(others[self.strands.unlike(others, known, _SAME)])

    def _advance(
        self, state: Touching, known: Gaps, merit: Merit
    ) -> tuple[Touching, Gaps] | None:
        """Return the state after a step that lowers the merit function; None without one.

        Or the energy, if it keeps its places and strands hardly overlap then: where these
        hang together the merit function sees overlaps that do not count.

        known : places where strands have overlapped on the way, and may again; returned
            with those where they would have after steps that were not taken
        """
        x, radius, steps = state.model.x, FIRST_RADIUS, self._steps(state, known)
        while radius > SMALLEST_RADIUS:
            led = self._led(state, steps, radius)
            if led is None:
                return None
            (step, gaps), more = led, known
            near, slide = x + step.moved, self._sliding(x, gaps)
            # Where two places come to be one neither can slide.
            closed = self._closed(near, slide) or self._closed(near, gaps)
            if closed is not None:
                dearer = steps.dearer(step)
                gained = merit.gained(state.model, step, dearer, closed[0], radius)
                if gained is None and gaps is state.gaps:
                    gained = merit.eased(state.model, step, closed[0], radius)
                if gained is not None:
                    risen = max(state.risen, gained)
                    return replace(self._made(state, *closed), risen=risen), known
                more = self._with(known, self._overlaps(*closed))
            if len(more) > len(known):
                known, steps = more, self._steps(state, more)
            else:
                radius = 0.25 * min(step.size, radius)
        return None

    def _steps(self, state: Touching, known: Gaps) -> Steps:
        """Return the steps from a state, that close gaps where they are least, or known."""
        x, gaps = state.model.x, state.gaps
        least = self._least(x, gaps, _NEAR)
        known = known[self.strands.unlike(known, gaps[gaps.slides], _SLIDES)]
        near = self._with(gaps.joined(least), known)
        near, _ = self.strands.at(x, near)
        return Steps(self.energy, self.strands, state.model, gaps, near)

    def _led(
        self, state: Touching, steps: Steps, radius: float
    ) -> tuple[NewtonStep, Gaps] | None:
        """Return the step of at most such a radius, and the gaps to close after it."""
        step, little = state.model.newton_step(radius), LITTLE * self.strands.diameter
        if step is None or not _pushes(state) or steps.overlaps(step.moved, little):
            return steps.programmed(radius)
        return step, state.gaps

    def _sliding(self, x: FloatArray, gaps: Gaps) -> Gaps:
        """Return gaps, of which those slide that are nearly where strands are nearest."""
        _, widths = self.strands.at(x, gaps)
        least, low = self.strands.downhill(x, gaps)
        edge = self.strands.loop.rest_lengths.mean()
        little = _NEARER * self.strands.diameter
        near = (np.abs(least.s - gaps.s) < _SLIDES * edge) & (widths - low < little)
        spread = 0.5 * self.strands.parting(x, gaps) * edge**2
        slides = (spread > np.where(gaps.slides, _STAYS * little, little)) & near
        s, t = np.where(slides, least.s, gaps.s), np.where(slides, least.t, gaps.t)
        gaps = Gaps(s, t, slides)
        return gaps[self.strands.distinct(gaps, _ONE)]

    def _closed(self, near: FloatArray, gaps: Gaps) -> tuple[FloatArray, Gaps] | None:
        """Return the loop next to that with gaps closed, or most of them, and which."""
        for edges in _TOGETHER:
            some = gaps[self.strands.distinct(gaps, edges)]
            with suppress(LinAlgError):
                held = with_gaps_held(self.energy, self.strands, some)
                x = held.constraint.project(near)
                if x is None:
                    continue
                some, _ = self.strands.at(x, some)
                if self.strands.distinct(some, _SAME).all():
                    return x, some
        return None

    def _made(self, state: Touching, x: FloatArray, gaps: Gaps) -> Touching:
        """Return the state on a loop on which gaps are closed."""
        model = tangent_model(with_gaps_held(self.energy, self.strands, gaps), x)
        return replace(state, model=model, gaps=gaps, iteration=state.iteration + 1)


def _pushes(state: Touching) -> bool:
    return bool((state.forces >= -state.uncertain).all())
