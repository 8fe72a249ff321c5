"""Newton on the loop: trust region on the manifold of loops that keep their lengths.

The film's interior is eliminated exactly (condensation.py), so an iterate is a loop. Each
step minimises the second-order model of tangent.py inside a trust region, is projected
back onto the rest lengths, and is accepted if the energy falls as the model promised.
Negative curvature is used, so the iteration leaves saddles; near a minimum it is Newton's
method and converges quadratically. Close to an equilibrium primal_dual.py takes over; what
it comes to is kept only if it lies lower and is stable. On large loops the model lives on a
subspace of the tangent space (loop_model.py), and a rough start is smoothed on a coarse
loop first.

The iteration ends where rounding begins. That of the positions alone unbalances the forces
by about eps / h^3 for edges of length h, relative to the largest: a few 1e-7 at 1,700 loop
vertices, 1e-5 at 3,800.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from eulerplateau.coarsening import coarsen
from eulerplateau.inextensible import close_with_lengths, project_lengths
from eulerplateau.loop_model import lowest_modes, subspace_model
from eulerplateau.mesh import FloatArray
from eulerplateau.primal_dual import settle
from eulerplateau.problem import Problem
from eulerplateau.solution import RESIDUAL_TOLERANCE, Equilibrium, Status
from eulerplateau.stability import Stability, stability
from eulerplateau.tangent import LoopEnergy, TangentModel, tangent_model
from eulerplateau.trust_region import trust_region_step

_FIRST_RADIUS = 0.05
_SMALLEST_RADIUS = 1e-12
_LARGEST_RADIUS = 0.5

# Below this residual the primal-dual iteration is tried, and believed if no loop vertex
# moves farther than this (in L).
_CLOSE = 1e-2
_NEAR = 0.1

# Up to this many loop vertices the whole tangent space is searched, beyond it a subspace;
# a rough start is then smoothed on a loop of as many.
DENSE_LOOP = 128


@dataclass(frozen=True)
class _State:
    model: TangentModel
    radius: float
    iteration: int
    stability: Stability | None = None


def solve(
    problem: Problem,
    x: FloatArray,
    multipliers: FloatArray,
    load: float,
    *,
    max_iterations: int = 500,
    observe: Callable[[FloatArray], None] = lambda x_loop: None,
) -> Equilibrium:
    """Return the minimum reached from x (n_v, 3), of which only the loop matters.

    Multipliers (n_b,) that belong to x save time; zeros are no harm. `observe` is shown
    the loop (n_b, 3) after every step.
    """
    started = time.perf_counter()
    energy = loop_energy(problem, load)
    x_loop = _start(energy, x[problem.loop_vertices], max_iterations)
    if x_loop is None:
        unknown = np.zeros(len(problem.loop_vertices))
        return problem.equilibrium(x, unknown, load, Status.STALLED)
    descent = _Descent(energy, max_iterations, observe)
    state = descent.settled(x_loop, multipliers, 0) if multipliers.any() else None
    status = Status.CONVERGED
    if state is None:
        state, status = descent.run(x_loop)
    balanced = state.model.residual <= RESIDUAL_TOLERANCE
    if state.stability is None and (balanced or len(x_loop) <= DENSE_LOOP):
        state = replace(state, stability=_stability(energy, state.model))
    found = _record(problem, state, load, status)
    return replace(found, seconds=time.perf_counter() - started)


def _start(energy: LoopEnergy, x: FloatArray, max_iterations: int) -> FloatArray | None:
    """Return a loop that keeps its lengths, near x (n_b, 3); None if there is none.

    A large loop with more energy in its roughness than in its shape is smoothed first, by
    minimising on a coarse one.
    """
    given = close_with_lengths(energy.loop, x)
    if len(x) <= DENSE_LOOP:
        return given
    coarse = coarsen(energy, DENSE_LOOP)
    nowhere = np.zeros_like(x)
    shape = close_with_lengths(coarse.energy.loop, coarse.restrict(x))
    if shape is None:
        return given
    smooth = close_with_lengths(energy.loop, coarse.prolong(shape))
    if given is not None and (
        smooth is None or energy.change(nowhere, given) < 2 * energy.change(nowhere, smooth)
    ):
        return given
    minimum = _Descent(coarse.energy, max_iterations).run(shape)[0].model.x
    smooth = close_with_lengths(energy.loop, coarse.prolong(minimum))
    return given if smooth is None else smooth


@dataclass(frozen=True)
class _Descent:
    """A descent of one energy: to its limit of iterations, shown to `observe`."""

    energy: LoopEnergy
    max_iterations: int
    observe: Callable[[FloatArray], None] = lambda x_loop: None

    def run(self, x: FloatArray) -> tuple[_State, Status]:
        """Descend from a loop (n_b, 3) that keeps its lengths."""
        state = _State(_model(self.energy, x), _FIRST_RADIUS, 0)
        close = _CLOSE
        while state.iteration < self.max_iterations:
            if _at_rounding(state.model):
                found = _stability(self.energy, state.model)
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
        return state, Status.ITERATION_LIMIT

    def settled(
        self, x: FloatArray, multipliers: FloatArray, iteration: int
    ) -> _State | None:
        """Return the minimum that Newton's equations lead to from near by, if they do."""
        if len(x) > DENSE_LOOP:
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
        return _State(model, _FIRST_RADIUS, iteration + found.iterations, spectrum)


def _noise(
    energy: LoopEnergy, x: FloatArray, moved: FloatArray, multipliers: FloatArray
) -> float:
    """Return the change of energy that rounding alone can show for a displacement.

    Rounding of the forces counts, and that of the positions by way of the edges' lengths.
    """
    eps = float(np.finfo(np.float64).eps)
    by_lengths = eps * float(np.abs(x).max() * np.abs(multipliers).sum())
    return 4 * (energy.force_rounding * float(np.abs(moved).sum()) + by_lengths)


def loop_energy(problem: Problem, load: float) -> LoopEnergy:
    """Return the condensed energy of a problem at a load."""
    return LoopEnergy(
        problem.loop,
        2 * problem.loop.bending_matrix,
        2 * load * problem.condensed.stiffness,
    )


def _model(
    energy: LoopEnergy, x: FloatArray, before: TangentModel | None = None
) -> TangentModel:
    if len(x) <= DENSE_LOOP:
        return tangent_model(energy, x)
    return subspace_model(energy, x, before)


def _stability(energy: LoopEnergy, model: TangentModel) -> Stability:
    if len(model.x) <= DENSE_LOOP:
        return stability(model)
    return lowest_modes(energy, model)[0]


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
            noise = _noise(energy, model.x, moved, model.multipliers)
            if gained <= 0.1 * promised or (abs(gained) <= noise and -promised <= noise):
                grow = size > 0.8 * radius and gained < 0.75 * promised
                wider = min(2 * radius, _LARGEST_RADIUS) if grow else radius
                return _State(_model(energy, x, model), wider, state.iteration + 1)
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


def _record(problem: Problem, state: _State, load: float, status: Status) -> Equilibrium:
    x = problem.condensed.extend(state.model.x)
    result = problem.equilibrium(x, state.model.multipliers, load, status)
    result = replace(result, iterations=state.iteration)
    found = state.stability
    if found is None:
        return result
    # A stall with balanced forces is an equilibrium all the same, if it is a minimum; and
    # rounding that leaves forces unbalanced on a very fine loop is a stall.
    balanced = result.residual <= RESIDUAL_TOLERANCE
    if status is Status.STALLED and balanced:
        minimum = found.n_unstable == 0
        result = replace(result, status=Status.CONVERGED if minimum else Status.SADDLE)
    elif status is Status.CONVERGED and not balanced:
        result = replace(result, status=Status.STALLED)
    return replace(
        result,
        n_unstable=found.n_unstable,
        n_neutral=found.n_neutral,
        lowest_eigenvalue=found.lowest,
    )
