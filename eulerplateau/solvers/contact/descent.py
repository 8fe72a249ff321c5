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

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.interruption import heed
from eulerplateau.loop import Gaps, HeldGaps, LoopEnergy, Strands, passed
from eulerplateau.solvers.descent import (
    FIRST_RADIUS,
    LARGEST_RADIUS,
    SMALLEST_RADIUS,
    at_rounding,
    bounded_step,
    change_of_energy,
    noise_of,
)
from eulerplateau.solvers.equilibrium import Status
from eulerplateau.solvers.second_variation import TangentModel, stability, tangent_model

# A gap, in units of L, that is closed; one that is negative; and by which part of the
# diameter strands may overlap before they are pushed back.
CLOSED = 1e-10
_NEGATIVE = -1e-11
_DEEP = 0.25
# Rounds in which gaps are closed that the closing of others has made negative.
_ROUNDS = 6
# The residual below which it is asked whether strands pull, and what counts as pulling:
# so much of the largest tension, and what an unbalanced force would account for.
_ASKED = 1e-3
_PULLS = 1e-9
# How often the kind of a contact may be chosen anew.
_CHANGES = 6


@dataclass(frozen=True)
class Touching:
    """A loop with the gaps that are closed on it, and the model that keeps them."""

    model: TangentModel
    gaps: Gaps
    radius: float
    iteration: int

    @property
    def forces(self) -> FloatArray:
        """The forces (k,) with which strands push each other, alpha / L^2."""
        return -self.model.tensions[len(self.model.x) :]

    @property
    def uncertain(self) -> float:
        """What such a force can be off by, as far as forces do not balance."""
        tensions = self.model.tensions
        largest = float(np.abs(tensions).max())
        return largest * (_PULLS + len(tensions) * self.model.residual)


@dataclass(frozen=True)
class ContactDescent:
    """A descent of one energy, as solvers.descent.Descent; `energy` knows no contact."""

    energy: LoopEnergy
    strands: Strands
    max_iterations: int
    observe: Callable[[FloatArray], None] = lambda x_loop: None
    ends: Callable[[TangentModel], bool] = lambda model: False

    def run(self, x: FloatArray) -> tuple[Touching, Status]:
        """Descend from a loop (n, d) on which no strands overlap."""
        near, gaps = self.strands.near(x, CLOSED)
        state = self._at(x, near, FIRST_RADIUS, 0)
        changes = 0
        while state.iteration < self.max_iterations:
            heed()
            if (fewer := self._let_go(state)) is not None:
                state = fewer
                continue
            if at_rounding(state.model) and stability(state.model).n_unstable == 0:
                changed = self._chosen_anew(state) if changes < _CHANGES else None
                if changed is None:
                    return state, Status.CONVERGED
                state, changes = changed, changes + 1
                continue
            after = self._advance(state)
            if after is None:
                return state, Status.STALLED
            state = after
            self.observe(state.model.x)
            if not self.energy.holds(state.model.x) or self.ends(state.model):
                break
        return state, Status.ITERATION_LIMIT

    def held(self, gaps: Gaps) -> HeldGaps:
        """Return the constraint that keeps gaps closed."""
        return HeldGaps(self.energy.constraint, self.strands, gaps)

    def _at(self, x: FloatArray, gaps: Gaps, radius: float, iteration: int) -> Touching:
        gaps, _ = self.strands.at(x, gaps)
        energy = replace(self.energy, constraint=self.held(gaps))
        return Touching(tangent_model(energy, x), gaps, radius, iteration)

    def _let_go(self, state: Touching) -> Touching | None:
        """Return the state without the strands that pull at each other; None if none do."""
        if state.model.residual > _ASKED or not len(state.gaps):
            return None
        pushing = state.forces > -state.uncertain
        if pushing.all():
            return None
        kept = state.gaps[pushing]
        return self._at(state.model.x, kept, state.radius, state.iteration + 1)

    def _chosen_anew(self, state: Touching) -> Touching | None:
        """Return the state with each contact of the kind it is; None if all of them are.

        And with the gaps closed that are negative beside others.
        """
        if not len(state.gaps):
            return None
        wrong = self.strands.ill_chosen(state.model.x, state.gaps)
        if not wrong.any():
            return None
        kept = state.gaps[~wrong]
        near, _ = self.strands.near(state.model.x, CLOSED)
        gaps = kept.joined(near[self.strands.unlike(near, kept)])
        x = self.held(gaps).project(state.model.x)
        if x is None:
            return None
        return self._at(x, gaps, state.radius, state.iteration + 1)

    def _advance(self, state: Touching) -> Touching | None:
        """Return the state after one accepted step; None if no step lowers the energy."""
        model, radius = state.model, state.radius
        while radius > SMALLEST_RADIUS:
            step = model.newton_step(radius)
            if step is None:
                step = bounded_step(self.energy, model, radius)
            reached = self._reach(state, step.moved)
            if reached is not None:
                x, gaps, noise = reached
                gained = change_of_energy(self.energy, model.x, x)
                if gained is not None and (
                    gained <= 0.1 * step.promised
                    or (abs(gained) <= noise and -step.promised <= noise)
                ):
                    grow = step.size > 0.8 * radius and gained < 0.75 * step.promised
                    wider = min(2 * radius, LARGEST_RADIUS) if grow else radius
                    return self._at(x, gaps, wider, state.iteration + 1)
            stopped = self._stopped(state, step.moved)
            if stopped is not None:
                return stopped
            radius = 0.25 * min(step.size, radius)
        return None

    def _reach(
        self, state: Touching, moved: FloatArray
    ) -> tuple[FloatArray, Gaps, float] | None:
        """Return the loop that a step leads to, with the gaps that it closes.

        And the change of energy that rounding can show. None if strands would pass.
        """
        x, gaps = state.model.x, state.gaps
        after: FloatArray | None = x + moved
        for _ in range(_ROUNDS):
            after = self.held(gaps).project(after)
            if after is None or passed(x, after):
                return None
            new = self._overlaps(after, gaps)
            if new is None:
                return None
            if not len(new):
                noise = noise_of(self.energy, x, after - x, state.model.tensions)
                return after, gaps, noise
            gaps = gaps.joined(new)
        return None

    def _overlaps(self, x: FloatArray, gaps: Gaps) -> Gaps | None:
        """Return the places where strands overlap beside closed gaps; None if too far."""
        near, widths = self.strands.near(x, _NEGATIVE)
        new = self.strands.unlike(near, gaps)
        if new.any() and widths[new].min() < -_DEEP * self.strands.diameter:
            return None
        return near[new]

    def _stopped(self, state: Touching, moved: FloatArray) -> Touching | None:
        """Return the state where a step is stopped by strands that it would make overlap.

        At the first of them, which touch from there on. None if there are none, or if the
        energy does not fall on the way there.
        """
        x = state.model.x
        straight = self.held(state.gaps).project(x + moved)
        if straight is None or passed(x, straight):
            return None
        near, after = self.strands.near(straight, _NEGATIVE)
        chosen = self.strands.unlike(near, state.gaps)
        near, after = near[chosen], after[chosen]
        if not len(near):
            return None
        try:
            _, before = self.strands.at(x, near)
        except LinAlgError:
            return None
        parts = np.clip(before / (before - after), 0.0, 1.0)
        first = near[parts <= parts.min() * (1 + 1e-9)]
        gaps = state.gaps.joined(first)
        found = self.held(gaps).project(x + float(parts.min()) * moved)
        if found is None or passed(x, found):
            return None
        left = self._overlaps(found, gaps)
        if left is None or len(left):
            return None
        gained = change_of_energy(self.energy, x, found)
        noise = noise_of(self.energy, x, found - x, state.model.tensions)
        if gained is None or gained > max(noise, CLOSED * state.uncertain):
            return None
        return self._at(found, gaps, state.radius, state.iteration + 1)
