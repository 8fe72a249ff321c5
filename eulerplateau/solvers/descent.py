"""Descent to a minimum: trust region on the manifold of loops that keep their constraint.

Each step minimises a second-order model (models.py) inside a trust region, is projected
back onto the constraint, and is accepted if the energy falls as the model promised.
Negative curvature is used, so the iteration leaves saddles; near a minimum it is Newton's
method and converges quadratically. Where there is a short cut to the equilibrium next to a
loop, what it comes to is kept only if it lies lower and is stable.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.interruption import heed
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers.acceptance import (
    SMALLEST_RADIUS,
    accepted,
    at_rounding,
    bounded_step,
    change_of_energy,
    noise_of,
)
from eulerplateau.solvers.equilibrium import Stability, Status
from eulerplateau.solvers.models import Model, Models
from eulerplateau.solvers.trust_region import FIRST_RADIUS

# Below this residual the primal-dual iteration is tried, and believed if no loop vertex
# moves farther than this (in L).
_CLOSE = 1e-2
_NEAR = 0.1


@dataclass(frozen=True)
class State:
    """Where a descent has come to; `stability` where it has been asked for."""

    model: Model
    radius: float
    iteration: int
    stability: Stability | None = None


@dataclass(frozen=True)
class Descent:
    """A descent of one energy: to its limit of iterations, shown to `observe`.

    It may end before, at a loop of which `ends` says so.
    """

    models: Models
    max_iterations: int
    observe: Callable[[FloatArray], None] = lambda x_loop: None
    ends: Callable[[Model], bool] = lambda model: False

    @property
    def energy(self) -> LoopEnergy:
        """The energy."""
        return self.models.energy

    def run(self, x: FloatArray, near: Model | None = None) -> tuple[State, Status]:
        """Descend from a loop (n, d) that keeps its constraint while the energy holds.

        near : a model of a loop near by, and nearly of the same energy
        """
        state = State(self.models.at(x, near), FIRST_RADIUS, 0)
        close = _CLOSE
        while state.iteration < self.max_iterations:
            heed()
            if at_rounding(state.model):
                found = self.models.spectrum(state.model)
                state = replace(state, stability=found)
                if found.n_unstable == 0:
                    return state, Status.CONVERGED
            elif state.model.residual < close:
                # Once more only where much closer: near a saddle it would fail each time.
                close = 0.01 * state.model.residual
                settled = self.settled(state.model.x, state.model.tensions, state.iteration)
                if settled is not None:
                    return settled, Status.CONVERGED
            after = self._advance(state)
            if after is None:
                return state, Status.STALLED
            state = after
            self.observe(state.model.x)
            if not self.energy.holds(state.model.x) or self.ends(state.model):
                break
        return state, Status.ITERATION_LIMIT

    def settled(self, x: FloatArray, tensions: FloatArray, iteration: int) -> State | None:
        """Return the minimum that a short cut leads to from near by, if there is one."""
        limit = self.max_iterations - iteration
        found = self.models.settle(x, tensions, limit, self.observe)
        if found is None:
            return None
        reached = self.energy.constraint.project(found.x)
        if reached is None:
            return None
        moved = reached - x
        noise = noise_of(self.energy, x, moved, found.tensions)
        if self.energy.change(x, moved) > noise or float(np.abs(moved).max()) > _NEAR:
            return None
        model = self.models.at(reached)
        spectrum = self.models.spectrum(model)
        if spectrum.n_unstable:
            return None
        return State(model, FIRST_RADIUS, iteration + found.iterations, spectrum)

    def _advance(self, state: State) -> State | None:
        """Return the state after one accepted step; None if no step lowers the energy."""
        energy, model, radius = self.energy, state.model, state.radius
        while radius > SMALLEST_RADIUS:
            step = model.newton_step(radius)
            if step is None:
                step = bounded_step(energy, model.dense, radius)
            reached = energy.constraint.project(model.x + step.moved)
            gained = change_of_energy(energy, model.x, reached)
            if reached is not None and gained is not None:
                moved = reached - model.x
                noise = noise_of(energy, model.x, moved, model.tensions)
                wider = accepted(step, gained, noise, radius)
                if wider is not None:
                    # To the last bit where the change was asked for: a film is known there.
                    after = self.models.at(model.x + moved, model)
                    return State(after, wider, state.iteration + 1)
            radius = 0.25 * min(step.size, radius)
        return None
