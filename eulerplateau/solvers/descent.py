"""Descent to a minimum: trust region on the manifold of loops that keep their lengths.

Each step minimises the second-order model of tangent.py inside a trust region, is projected
back onto the rest lengths, and is accepted if the energy falls as the model promised.
Negative curvature is used, so the iteration leaves saddles; near a minimum it is Newton's
method and converges quadratically. Close to an equilibrium of a film with fixed weights
primal_dual.py takes over; what it comes to is kept only if it lies lower and is stable. On
large loops the model lives on a subspace of the tangent space (loop_model.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import CondensedEnergy, project_lengths
from eulerplateau.solvers.equilibrium import RESIDUAL_TOLERANCE, Equilibrium, Status
from eulerplateau.solvers.large_loops.subspace_model import lowest_modes, subspace_model
from eulerplateau.solvers.primal_dual import settle
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.second_variation import (
    LoopEnergy,
    TangentModel,
    tangent_model,
)
from eulerplateau.solvers.spectrum import Stability, stability
from eulerplateau.solvers.trust_region import trust_region_step

_FIRST_RADIUS = 0.05
_SMALLEST_RADIUS = 1e-12
_LARGEST_RADIUS = 0.5

# Below this residual the primal-dual iteration is tried, and believed if no loop vertex
# moves farther than this (in L).
_CLOSE = 1e-2
_NEAR = 0.1


@dataclass(frozen=True)
class State:
    """Where a descent has come to; `stability` where it has been asked for."""

    model: TangentModel
    radius: float
    iteration: int
    stability: Stability | None = None


@dataclass(frozen=True)
class Descent:
    """A descent of one energy: to its limit of iterations, shown to `observe`."""

    energy: CondensedEnergy
    max_iterations: int
    observe: Callable[[FloatArray], None] = lambda x_loop: None

    def run(self, x: FloatArray) -> tuple[State, Status]:
        """Descend from a loop (n_b, 3) that keeps its lengths while the energy holds."""
        state = State(_model(self.energy, x), _FIRST_RADIUS, 0)
        close = _CLOSE
        while state.iteration < self.max_iterations:
            if _at_rounding(state.model):
                found = stability_of(self.energy, state.model)
                state = replace(state, stability=found)
                if found.n_unstable == 0:
                    return state, Status.CONVERGED
            elif state.model.residual < close:
                # Once more only where much closer: near a saddle it would fail each time.
                close = 0.01 * state.model.residual
                settled = self.settled(
                    state.model.x, state.model.multipliers, state.iteration
                )
                if settled is not None:
                    return settled, Status.CONVERGED
            after = _advance(self.energy, state)
            if after is None:
                return state, Status.STALLED
            state = after
            self.observe(state.model.x)
            if not self.energy.holds(state.model.x):
                break
        return state, Status.ITERATION_LIMIT

    def settled(
        self, x: FloatArray, multipliers: FloatArray, iteration: int
    ) -> State | None:
        """Return the minimum that Newton's equations lead to from near by, if they do."""
        if not isinstance(self.energy, LoopEnergy) or not self.energy.dense:
            return None
        limit = self.max_iterations - iteration
        found = settle(self.energy, x, multipliers, limit, self.observe)
        if found is None:
            return None
        reached = project_lengths(self.energy.loop, found.x)
        if reached is None:
            return None
        moved = reached - x
        noise = _noise(self.energy, x, moved, found.multipliers)
        if self.energy.change(x, moved) > noise or float(np.abs(moved).max()) > _NEAR:
            return None
        model = tangent_model(self.energy, reached)
        spectrum = stability(model)
        if spectrum.n_unstable:
            return None
        return State(model, _FIRST_RADIUS, iteration + found.iterations, spectrum)


def _noise(
    energy: CondensedEnergy, x: FloatArray, moved: FloatArray, multipliers: FloatArray
) -> float:
    """Return the change of energy that rounding alone can show for a displacement.

    Rounding of the forces counts, and that of the positions by way of the edges' lengths.
    """
    eps = float(np.finfo(np.float64).eps)
    by_lengths = eps * float(np.abs(x).max() * np.abs(multipliers).sum())
    return 4 * (energy.force_rounding * float(np.abs(moved).sum()) + by_lengths)


def _model(
    energy: CondensedEnergy, x: FloatArray, before: TangentModel | None = None
) -> TangentModel:
    if isinstance(energy, LoopEnergy) and not energy.dense:
        return subspace_model(energy, x, before)
    return tangent_model(energy, x)


def stability_of(energy: CondensedEnergy, model: TangentModel) -> Stability:
    """Return the spectrum at an equilibrium, of a large loop the lowest part of it."""
    if isinstance(energy, LoopEnergy) and not energy.dense:
        return lowest_modes(energy, model)[0]
    return stability(model)


def _at_rounding(model: TangentModel) -> bool:
    """Whether the forces balance as well as double precision can tell."""
    return model.residual <= max(4 * model.rounding, 1e-13)


def _advance(energy: CondensedEnergy, state: State) -> State | None:
    """Return the state after one accepted step; None if no step lowers the energy."""
    model, radius = state.model, state.radius
    full = _newton_step(model, radius)
    while radius > _SMALLEST_RADIUS:
        step = _bounded_step(energy, model, radius) if full is None else full
        size = float(np.linalg.norm(step))
        promised = float(model.gradient @ step + 0.5 * step @ (model.hessian @ step))
        x = project_lengths(energy.loop, model.x + model.displacement(step))
        gained = _change(energy, model.x, x)
        if x is not None and gained is not None:
            moved = x - model.x
            noise = _noise(energy, model.x, moved, model.multipliers)
            if gained <= 0.1 * promised or (abs(gained) <= noise and -promised <= noise):
                grow = size > 0.8 * radius and gained < 0.75 * promised
                wider = min(2 * radius, _LARGEST_RADIUS) if grow else radius
                return State(_model(energy, x, model), wider, state.iteration + 1)
        radius, full = 0.25 * min(size, radius), None
    return None


def _change(
    energy: CondensedEnergy, x: FloatArray, after: FloatArray | None
) -> float | None:
    """Return the change of energy; None where there is no loop, or no film on it."""
    if after is None:
        return None
    try:
        return energy.change(x, after - x)
    except LinAlgError:
        return None


def _newton_step(model: TangentModel, radius: float) -> FloatArray | None:
    """Return the Newton step if the Hessian is positive definite and it fits."""
    try:
        step: FloatArray = -cho_solve(cho_factor(model.hessian), model.gradient)
    except LinAlgError:
        return None
    return step if float(np.linalg.norm(step)) <= radius else None


def _bounded_step(
    energy: CondensedEnergy, model: TangentModel, radius: float
) -> FloatArray:
    """Return the trust-region step, still along modes whose gain rounding would hide.

    A hexagon's saddle turns against its mesh almost for free: following that mode would
    walk round the circle of saddles for ever without gaining a measurable energy.
    """
    values, vectors = model.eigen
    slope = vectors.T @ model.gradient
    gain = np.abs(slope) + 0.5 * np.abs(values) * radius
    live = gain > 4 * energy.force_rounding
    if not live.any():
        return np.zeros_like(slope)
    step: FloatArray = vectors[:, live] @ trust_region_step(
        values[live], slope[live], radius
    )
    return step


def record(problem: Problem, state: State, load: float, status: Status) -> Equilibrium:
    """Return the equilibrium a descent has come to, or what there is to say about it."""
    x = problem.condensed.extend(state.model.x)
    result = problem.equilibrium(x, state.model.multipliers, load, status)
    return judged(replace(result, iterations=state.iteration), state.stability)


def judged(result: Equilibrium, found: Stability | None) -> Equilibrium:
    """Return a result with its stability, and the status that follows from it."""
    if found is None:
        return result
    # A stall with balanced forces is an equilibrium all the same, if it is a minimum; and
    # rounding that leaves forces unbalanced on a very fine loop is a stall, as is rounding
    # that leaves nobody able to say whether it is a minimum.
    certain = result.residual <= RESIDUAL_TOLERANCE and not found.blind
    if result.status is Status.STALLED and certain:
        minimum = found.n_unstable == 0
        result = replace(result, status=Status.CONVERGED if minimum else Status.SADDLE)
    elif result.status is Status.CONVERGED and not certain:
        result = replace(result, status=Status.STALLED)
    return replace(
        result,
        n_unstable=found.n_unstable,
        n_neutral=found.n_neutral,
        lowest_eigenvalue=found.lowest,
    )
