"""Descent of a loop whose strands touch: by the gaps that are closed, on which it slides.

Every loop on the way is one on which no strands overlap, and the energy falls from one to
the next. A step keeps the gaps that are closed. Where it would make others overlap, it is
the one of a quadratic program that tells which gaps to close, and which to open
(program.py); where strands pull at each other they are let go. It ends where the
forces balance, all strands that touch push, and no other gap is negative.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

from eulerplateau.arrays import FloatArray
from eulerplateau.interruption import heed
from eulerplateau.loop import Gaps, LoopEnergy, Strands
from eulerplateau.solvers.acceptance import (
    SMALLEST_RADIUS,
    accepted,
    at_rounding,
    bounded_step,
    change_of_energy,
    noise_of,
)
from eulerplateau.solvers.contact.keeping import CHANGES, Keeping, Touching
from eulerplateau.solvers.contact.program import CLOSED
from eulerplateau.solvers.contact.steps import Steps
from eulerplateau.solvers.equilibrium import Status
from eulerplateau.solvers.second_variation import NewtonStep, TangentModel, stability
from eulerplateau.solvers.trust_region import FIRST_RADIUS

# Gaps of less than so many diameters are looked at when a step is made.
_REACH = 1.0


class LastStage(Protocol):
    """What becomes of a loop at rest: everywhere.Everywhere."""

    def settled(self, state: Touching) -> tuple[Touching, bool]:
        """Return what it comes to, and whether that is a minimum."""

    def again(self, state: Touching, x: FloatArray) -> Touching | None:
        """Return the minimum near x (n, d) of another energy's; None if there is none."""


@dataclass(frozen=True)
class ContactDescent:
    """A descent of one energy, as solvers.descent.Descent; `energy` knows no contact.

    Where it has come to rest the `last` stage goes on, if there is one.
    """

    energy: LoopEnergy
    strands: Strands
    max_iterations: int
    observe: Callable[[FloatArray], None] = lambda x_loop: None
    ends: Callable[[TangentModel], bool] = lambda model: False
    last: LastStage | None = None

    def run(self, x: FloatArray, before: Touching | None = None) -> tuple[Touching, Status]:
        """Descend from a loop (n, d) on which no strands overlap.

        Or from where one has come to `before`, of a film made elsewhere.
        """
        state = self._begun(x, before)
        while state.iteration < self.max_iterations:
            heed()
            if at_rounding(state.model) and stability(state.model).n_unstable == 0:
                other = self.keeping.mended(state)
                if other is None:
                    if self.last is None:
                        return state, Status.CONVERGED
                    state, settles = self.last.settled(state)
                    return state, Status.CONVERGED if settles else Status.UNRESOLVED
                state = other
                continue
            after = self._advance(state) or self.keeping.cleared_between(state)
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
        before = replace(before, iteration=0)
        if self.last is not None and before.changes >= CHANGES:
            settled = self.last.again(before, x)
            if settled is not None:
                return settled
        state = self.keeping.moved(before, x, before.gaps, FIRST_RADIUS)
        return replace(state, iteration=0)

    @cached_property
    def keeping(self) -> Keeping:
        """How gaps are kept closed."""
        return Keeping(self.energy, self.strands)

    def _advance(self, state: Touching) -> Touching | None:
        """Return the state after one accepted step; None if no step lowers the energy."""
        radius = state.radius
        near = self._near(state)
        steps = Steps(self.energy, self.strands, state.model, state.gaps, near)
        while radius > SMALLEST_RADIUS:
            step, gaps = _within(steps, radius)
            reached = self._reached(state, step, gaps, radius)
            if reached is not None:
                return reached
            radius = 0.25 * min(step.size, radius)
        return None

    def _reached(
        self, state: Touching, step: NewtonStep, gaps: Gaps, radius: float
    ) -> Touching | None:
        """Return the state that a step leads to, closing gaps; None if not accepted."""
        x = state.model.x
        found = self.keeping.cleared(x, x + step.moved, gaps, state.beside)
        if found is None:
            return None
        after, gaps = found
        gained = change_of_energy(self.energy, x, after)
        noise = noise_of(self.energy, x, after - x, state.model.tensions)
        wider = None if gained is None else accepted(step, gained, noise, radius)
        if gained is None or wider is None:
            return None
        moved = self.keeping.moved(state, after, gaps, wider)
        return replace(moved, risen=max(state.risen, gained))

    def _near(self, state: Touching) -> Gaps:
        """Return gaps that are closed, and others that are near behind them."""
        x, reach = state.model.x, _REACH * self.strands.diameter
        near, _ = self.strands.near(x, reach, state.beside)
        held, _ = self.strands.at(x, state.gaps)
        return held.joined(near[self.strands.unlike(near, held)])


def _within(steps: Steps, radius: float) -> tuple[NewtonStep, Gaps]:
    """Return the step of at most such a radius, with the gaps that it closes.

    It keeps those of the state; if strands overlap then to first order, it is that of the
    program.
    """
    model, gaps = steps.model, steps.gaps
    step = model.newton_step(radius)
    if step is None:
        step = bounded_step(steps.energy, model, radius)
    if len(steps.near) > len(gaps) and steps.overlaps(step.moved):
        return steps.programmed(radius) or (step, gaps)
    return step, gaps
