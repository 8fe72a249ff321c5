"""Newton on the loop: trust region on the manifold of loops that keep their lengths.

The film's interior is eliminated exactly (condensation.py), so an iterate is a loop. Each
step minimises the second-order model of tangent.py inside a trust region, is projected
back onto the rest lengths, and is accepted if the energy falls as the model promised.
Negative curvature is used, so the iteration leaves saddles; near a minimum it is Newton's
method and converges quadratically.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from eulerplateau.inextensible import close_with_lengths, project_lengths
from eulerplateau.mesh import FloatArray
from eulerplateau.problem import Problem
from eulerplateau.solution import RESIDUAL_TOLERANCE, Equilibrium, Status
from eulerplateau.stability import Stability, stability
from eulerplateau.tangent import LoopEnergy, TangentModel, tangent_model
from eulerplateau.trust_region import trust_region_step

_FIRST_RADIUS = 0.05
_SMALLEST_RADIUS = 1e-12
_LARGEST_RADIUS = 0.5


@dataclass(frozen=True)
class _State:
    model: TangentModel
    radius: float
    iteration: int


def solve(
    problem: Problem,
    x: FloatArray,
    multipliers: FloatArray,
    load: float,
    *,
    max_iterations: int = 500,
) -> Equilibrium:
    """Return the minimum reached from x (n_v, 3), of which only the loop matters.

    The multipliers (n_b,) of the start are not needed: each step finds its own.
    """
    started = time.perf_counter()
    energy = loop_energy(problem, load)
    x_loop = close_with_lengths(problem.loop, x[problem.loop_vertices])
    if x_loop is None:
        unknown = np.zeros(len(problem.loop_vertices))
        return problem.equilibrium(x, unknown, load, Status.STALLED)
    state = _State(tangent_model(energy, x_loop), _FIRST_RADIUS, 0)
    status, found = Status.ITERATION_LIMIT, None
    while state.iteration < max_iterations:
        if _at_rounding(state.model):
            found = stability(state.model)
            if found.n_unstable == 0:
                status = Status.CONVERGED
                break
        after = _advance(energy, state)
        if after is None:
            status = Status.STALLED
            break
        state = after
    return _finish(problem, state, load, status, found, time.perf_counter() - started)


def loop_energy(problem: Problem, load: float) -> LoopEnergy:
    """Return the condensed energy of a problem at a load."""
    return LoopEnergy(
        problem.loop,
        2 * problem.loop.bending_matrix,
        2 * load * problem.condensed.stiffness,
    )


def _at_rounding(model: TangentModel) -> bool:
    """Whether the forces balance as well as double precision can tell."""
    return model.residual <= max(4 * model.rounding, 1e-13)


def _advance(energy: LoopEnergy, state: _State) -> _State | None:
    """Return the state after one accepted step; None if no step lowers the energy."""
    model, radius = state.model, state.radius
    full = _newton_step(model, radius)
    while radius > _SMALLEST_RADIUS:
        step = _bounded_step(energy, model, radius) if full is None else full
        size = float(np.linalg.norm(step))
        promised = float(model.gradient @ step + 0.5 * step @ (model.hessian @ step))
        x = project_lengths(energy.loop, model.x + model.displacement(step))
        if x is not None:
            moved = x - model.x
            gained = energy.change(model.x, moved)
            noise = 4 * energy.force_rounding * float(np.abs(moved).sum())
            if gained <= 0.1 * promised or (abs(gained) <= noise and -promised <= noise):
                grow = size > 0.8 * radius and gained < 0.75 * promised
                wider = min(2 * radius, _LARGEST_RADIUS) if grow else radius
                return _State(tangent_model(energy, x), wider, state.iteration + 1)
        radius, full = 0.25 * min(size, radius), None
    return None


def _newton_step(model: TangentModel, radius: float) -> FloatArray | None:
    """Return the Newton step if the Hessian is positive definite and it fits."""
    try:
        step: FloatArray = -cho_solve(cho_factor(model.hessian), model.gradient)
    except LinAlgError:
        return None
    return step if float(np.linalg.norm(step)) <= radius else None


def _bounded_step(energy: LoopEnergy, model: TangentModel, radius: float) -> FloatArray:
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


def _finish(
    problem: Problem,
    state: _State,
    load: float,
    status: Status,
    found: Stability | None,
    seconds: float,
) -> Equilibrium:
    x = problem.condensed.extend(state.model.x)
    found = found or stability(state.model)
    result = problem.equilibrium(x, state.model.multipliers, load, status)
    # A stall with balanced forces is an equilibrium all the same, if it is a minimum.
    if status is Status.STALLED and result.residual <= RESIDUAL_TOLERANCE:
        balanced = found.n_unstable == 0
        result = replace(result, status=Status.CONVERGED if balanced else Status.SADDLE)
    return replace(
        result,
        iterations=state.iteration,
        seconds=seconds,
        n_unstable=found.n_unstable,
        lowest_eigenvalue=found.lowest,
    )
