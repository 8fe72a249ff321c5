"""Descent of a loop whose strands touch: by the gaps that are closed, on which it slides.

Every loop on the way is one on which no strands overlap, and the energy falls from one to
the next. A step keeps the gaps that are closed. Where it would close others they are
closed from there on; where strands pull at each other they are let go. It ends where the
forces balance, all strands that touch push, and no other gap is negative.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.interruption import heed
from eulerplateau.loop import ALONG, NO_GAPS, Gaps, HeldGaps, LoopEnergy, Strands, passed
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
# Times a step is halved in search of where strands that stop it begin to touch.
_HALVINGS = 16
# The residual below which it is asked whether strands pull, and what counts as pulling:
# so much of the largest tension, and what an unbalanced force would account for.
_ASKED = 1e-3
_PULLS = 1e-9
# By which part of the diameter strands may overlap between vertices at which they are held
# along each other; and how often that is mended, or strands that part are held at points.
_BETWEEN = 1e-3
_CHANGES = 8


@dataclass(frozen=True)
class Touching:
    """A loop with the gaps that are closed on it, and the model that keeps them.

    At places of `laid` strands touched at a point on the way, and lay along each other.
    """

    model: TangentModel
    gaps: Gaps
    laid: Gaps
    radius: float
    iteration: int

    @property
    def beside(self) -> Gaps:
        """Places where strands lie along each other, or did so on the way."""
        return self.laid.joined(self.gaps[~self.gaps.slides])

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

    def run(self, x: FloatArray, before: Touching | None = None) -> tuple[Touching, Status]:
        """Descend from a loop (n, d) on which no strands overlap.

        Or from where one has come to `before`, of a film made elsewhere.
        """
        if before is None:
            near, _ = self.strands.near(x, CLOSED)
            state = self._at(x, near, NO_GAPS, FIRST_RADIUS, 0)
        else:
            state = self._at(x, before.gaps, before.laid, FIRST_RADIUS, 0)
        changes = 0
        while state.iteration < self.max_iterations:
            heed()
            if (fewer := self._let_go(state)) is not None:
                state = fewer
                continue
            if changes < _CHANGES and (other := self._crossing(state)) is not None:
                state, changes = other, changes + 1
                continue
            if at_rounding(state.model) and stability(state.model).n_unstable == 0:
                other = None
                if changes < _CHANGES:
                    other = self._parted(state) or self._laid_evenly(state)
                if other is None:
                    return state, Status.CONVERGED
                state, changes = other, changes + 1
                continue
            after = self._advance(state) or self._let_go(state, np.inf)
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

    def _at(
        self, x: FloatArray, gaps: Gaps, laid: Gaps, radius: float, iteration: int
    ) -> Touching:
        """Return the state on a loop with these gaps, those of one place only once.

        Strands that come to lie along each other are held there, and touch at no point.
        """
        along = self.strands.laid_along(x, gaps)
        if along.any():
            # Where they were before: along each other they are nearest anywhere.
            laid = laid.joined(gaps[along])
            gaps = replace(gaps, slides=gaps.slides & ~along)
        gaps, _ = self.strands.at(x, gaps)
        gaps = gaps[self.strands.distinct(gaps)]
        energy = replace(self.energy, constraint=self.held(gaps))
        return Touching(tangent_model(energy, x), gaps, laid, radius, iteration)

    def _with(self, state: Touching, x: FloatArray, gaps: Gaps, radius: float) -> Touching:
        return self._at(x, gaps, state.laid, radius, state.iteration + 1)

    def _let_go(self, state: Touching, most: float = _ASKED) -> Touching | None:
        """Return the state without the strands that pull at each other; None if none do.

        It is not asked where forces are unbalanced by more than `most`.
        """
        if state.model.residual > most or not len(state.gaps):
            return None
        certain = state.uncertain if most < np.inf else 0.0
        pushing = state.forces >= -certain
        if pushing.all():
            return None
        return self._with(state, state.model.x, state.gaps[pushing], state.radius)

    def _crossing(self, state: Touching) -> Touching | None:
        """Return the state with strands touching at points that no longer lie along.

        None if they do so nowhere. The energy may rise by a force times the tiny gap that
        is closed.
        """
        x, gaps = state.model.x, state.gaps
        crossing = self.strands.crossing(x, gaps)
        if not crossing.any():
            return None
        kept, changed = gaps[~crossing], gaps[crossing]
        laid = state.laid[self.strands.unlike(state.laid, changed, ALONG)]
        points, _ = self.strands.at(x, replace(changed, slides=crossing[crossing]))
        after = kept.joined(points[self.strands.distinct(points)])
        closed = self._closed(x, after)
        if closed is None:
            return None
        return self._at(*closed, laid, state.radius, state.iteration + 1)

    def _parted(self, state: Touching) -> Touching | None:
        """Return the state with points where strands overlap between two vertices' gaps.

        None if they do so nowhere, or by so little that an edge's length accounts for it.
        """
        x, gaps = state.model.x, state.gaps
        near, _ = self.strands.near(x, -_BETWEEN * self.strands.diameter)
        points = near[near.slides]
        points = points[self.strands.unlike(points, gaps[gaps.slides])]
        if not len(points):
            return None
        kept = gaps.slides | self.strands.unlike(gaps, points, 1.05)
        after = gaps[kept].joined(points)
        closed = self._closed(x, after)
        return None if closed is None else self._with(state, *closed, state.radius)

    def _laid_evenly(self, state: Touching) -> Touching | None:
        """Return the state with strands held along each other at even places, else None."""
        after = self.strands.evenly(state.gaps, state.forces)
        closed = None if after is None else self._closed(state.model.x, after)
        if closed is None:
            return None
        x, gaps = closed
        radius, iteration = state.radius, state.iteration + 1
        return self._at(x, gaps, NO_GAPS, radius, iteration)

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
                    return self._with(state, x, gaps, wider)
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
        x, after, gaps = state.model.x, state.model.x + moved, state.gaps
        for _ in range(_ROUNDS):
            closed = self._closed(after, gaps)
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

    def _closed(self, x: FloatArray, gaps: Gaps) -> tuple[FloatArray, Gaps] | None:
        """Return the loop next to x with gaps closed, and them: those that met count once.

        None if they cannot be.
        """
        for _ in range(len(gaps) + 1):
            found = self.held(gaps).project(x)
            if found is None:
                return None
            try:
                after, _ = self.strands.at(found, gaps)
            except LinAlgError:
                return None
            distinct = self.strands.distinct(after)
            if distinct.all():
                return found, gaps
            gaps = gaps[distinct]
        return None

    def _amended(self, x: FloatArray, gaps: Gaps, beside: Gaps) -> Gaps | None:
        """Return the gaps to be closed where strands overlap: the same where they do not.

        None if they overlap too far.
        """
        near, widths = self.strands.near(x, _NEGATIVE, beside)
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
            straight = self._closed(x + part * moved, state.gaps)
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
        closed = self._closed(straight, amended)
        if closed is None or len(closed[1]) < len(amended):
            return None
        found, gaps = closed
        if not self._is_free(state, found, gaps):
            return None
        gained = change_of_energy(self.energy, x, found)
        noise = noise_of(self.energy, x, found - x, state.model.tensions)
        if gained is None or gained > max(noise, CLOSED * state.uncertain):
            return None
        return self._with(state, found, gaps, state.radius)
