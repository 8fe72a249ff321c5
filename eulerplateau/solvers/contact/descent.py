"""Descent of a loop whose strands touch: by the gaps that are closed, on which it slides.

Every loop on the way is one on which no strands overlap, and the energy falls from one to
the next. A step keeps the gaps that are closed. Where it would close others they are
closed from there on; where strands pull at each other they are let go. It ends where the
forces balance, all strands that touch push, and no other gap is negative.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

from eulerplateau.arrays import FloatArray
from eulerplateau.interruption import heed
from eulerplateau.loop import NEGATIVE, Gaps, LoopEnergy, Strands, passed
from eulerplateau.solvers.contact.keeping import Keeping, Touching
from eulerplateau.solvers.descent import (
    FIRST_RADIUS,
    SMALLEST_RADIUS,
    accepted,
    at_rounding,
    bounded_step,
    change_of_energy,
    noise_of,
)
from eulerplateau.solvers.equilibrium import Status
from eulerplateau.solvers.second_variation import TangentModel, stability

# A gap, in units of L, that is closed, and by which part of the diameter strands may
# overlap before they are pushed back.
CLOSED = 1e-10
_DEEP = 0.25
# Rounds in which gaps are closed that the closing of others has made negative.
_ROUNDS = 6
# Times a step is halved in search of where strands that stop it begin to touch.
_HALVINGS = 16


@dataclass(frozen=True)
class ContactDescent:
    """A descent of one energy, as solvers.descent.Descent; `energy` knows no contact."""

    energy: LoopEnergy
    strands: Strands
    max_iterations: int
    observe: Callable[[FloatArray], None] = lambda x_loop: None
    ends: Callable[[TangentModel], bool] = lambda model: False

    def run(self, x: FloatArray, before: Touching | None = None) -> tuple[Touching, Status]:
        """Descend from a loop (n, d) on which no strands overlap.

        Or from where one has come to `before`, of a film made elsewhere.
        """
        state = self._begun(x, before)
        while state.iteration < self.max_iterations:
            heed()
            other = self.keeping.let_go(state) or self.keeping.crossing(state)
            if other is not None:
                state = other
                continue
            if at_rounding(state.model) and stability(state.model).n_unstable == 0:
                other = self.keeping.mended(state)
                if other is None:
                    return state, Status.CONVERGED
                state = other
                continue
            after = self._advance(state) or self.keeping.let_go(state, stuck=True)
            if after is None:
                return state, Status.STALLED
            state = after
            self.observe(state.model.x)
            if not self.energy.holds(state.model.x) or self.ends(state.model):
                break
        return state, Status.ITERATION_LIMIT

    def _begun(self, x: FloatArray, before: Touching | None) -> Touching:
        if before is None:
            return self.keeping.at(x, self.strands.near(x, CLOSED)[0], FIRST_RADIUS)
        state = self.keeping.moved(before, x, before.gaps, FIRST_RADIUS)
        return replace(state, iteration=0)

    @cached_property
    def keeping(self) -> Keeping:
        """How gaps are kept closed."""
        return Keeping(self.energy, self.strands)

    def _advance(self, state: Touching) -> Touching | None:
        """Return the state after one accepted step; None if no step lowers the energy."""
        model, radius = state.model, state.radius
        while radius > SMALLEST_RADIUS:
            step = model.newton_step(radius)
            if step is None:
                step = bounded_step(self.energy, model, radius)
            reached = self.reach(state, step.moved)
            if reached is not None:
                x, gaps, noise = reached
                gained = change_of_energy(self.energy, model.x, x)
                wider = None if gained is None else accepted(step, gained, noise, radius)
                if wider is not None:
                    return self.keeping.moved(state, x, gaps, wider)
            stopped = self._stopped(state, step.moved)
            if stopped is not None:
                return stopped
            radius = 0.25 * min(step.size, radius)
        return None

    def reach(
        self, state: Touching, moved: FloatArray
    ) -> tuple[FloatArray, Gaps, float] | None:
        """Return the loop that a step leads to, with the gaps that it closes.

        And the change of energy that rounding can show. None if strands would pass.
        """
        x, after, gaps = state.model.x, state.model.x + moved, state.gaps
        for _ in range(_ROUNDS):
            closed = self.keeping.closed(after, gaps)
            if closed is None or passed(x, closed[0]):
                return None
            after, gaps = closed
            amended = self._amended(after, gaps, state.beside)
            if amended is None:
                return None
            if amended is gaps:
                noise = noise_of(self.energy, x, after - x, state.model.tensions)
                return after, gaps, noise
            gaps = amended
        return None

    def _amended(self, x: FloatArray, gaps: Gaps, beside: Gaps) -> Gaps | None:
        """Return the gaps to be closed where strands overlap: the same where they do not.

        None if they overlap too far.
        """
        near, widths = self.strands.near(x, NEGATIVE, beside)
        held, _ = self.strands.at(x, gaps)
        new = self.strands.unlike(near, held)
        if not new.any():
            return gaps
        if widths[new].min() < -_DEEP * self.strands.diameter:
            return None
        return gaps.joined(near[new])

    def _stopped(self, state: Touching, moved: FloatArray) -> Touching | None:
        """Return the state where a step is stopped by strands that it would make overlap.

        They touch from there on. None if there are none, or if the energy does not fall on
        the way there.
        """
        x, free, stopped, part = state.model.x, 0.0, 1.0, 1.0
        for _ in range(_HALVINGS):
            straight = self.keeping.closed(x + part * moved, state.gaps)
            found = None if straight is None else self._stopped_at(state, *straight)
            if found is not None:
                return found
            if straight is not None and self._is_free(state, *straight):
                if part == 1.0:
                    return None
                free = part
            else:
                stopped = part
            part = 0.5 * (free + stopped)
        return None

    def _is_free(self, state: Touching, x: FloatArray, gaps: Gaps) -> bool:
        """Return whether no strands overlap on a loop that a step has led to."""
        if passed(state.model.x, x):
            return False
        return self._amended(x, gaps, state.beside) is gaps

    def _stopped_at(
        self, state: Touching, straight: FloatArray, gaps: Gaps
    ) -> Touching | None:
        """Return the state where strands touch that overlap on a loop, if that is lower."""
        x = state.model.x
        amended = (
            None if passed(x, straight) else self._amended(straight, gaps, state.beside)
        )
        if amended is None or amended is gaps:
            return None
        closed = self.keeping.closed(straight, amended)
        if closed is None or len(closed[1]) < len(amended):
            return None
        found, gaps = closed
        if not self._is_free(state, found, gaps):
            return None
        gained = change_of_energy(self.energy, x, found)
        noise = noise_of(self.energy, x, found - x, state.model.tensions)
        if gained is None or gained > max(noise, CLOSED * state.uncertain):
            return None
        return self.keeping.moved(state, found, gaps)
