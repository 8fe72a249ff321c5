"""Films of fixed weights: one constant matrix for all coordinates, and what it is good for.

Close to an equilibrium Newton's method on positions and tensions together takes over
(primal_dual.py); of large loops the second variation is looked at on a subspace
(large_loops/), and a rough start is smoothed on a coarse loop first.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Loop, LoopEnergy, close_with_lengths
from eulerplateau.mesh import Shape
from eulerplateau.solvers.descent import Descent, record
from eulerplateau.solvers.equilibrium import (
    RESIDUAL_TOLERANCE,
    Equilibrium,
    Stability,
    Status,
)
from eulerplateau.solvers.large_loops.coarse_start import coarsen
from eulerplateau.solvers.large_loops.subspace_model import lowest_modes, subspace_model
from eulerplateau.solvers.models import DenseModels, Models, Settled
from eulerplateau.solvers.primal_dual import settle
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.second_variation import TangentModel

# Up to this many loop vertices the whole tangent space is searched, beyond it a subspace;
# a rough start is then smoothed on a loop of as many.
DENSE_LOOP = 128


@dataclass(frozen=True)
class QuadraticModels(DenseModels):
    """The whole tangent space, and Newton's method on positions and tensions near by."""

    loop: Loop

    @cached_property
    def matrix(self) -> FloatArray:
        """A (n_b, n_b), the energy's constant second derivative."""
        return self.energy.hessian(np.zeros((len(self.loop.rest_lengths), 3)))

    def settle(
        self,
        x: FloatArray,
        tensions: FloatArray,
        limit: int,
        observe: Callable[[FloatArray], None],
    ) -> Settled | None:
        """Return the equilibrium next to x (n_b, 3), if Newton's method comes to one."""
        return settle(self.energy, self.loop, self.matrix, x, tensions, limit, observe)


@dataclass(frozen=True)
class SubspaceModels:
    """A subspace of the tangent space of a large loop at a time."""

    energy: LoopEnergy
    loop: Loop

    @cached_property
    def matrix(self) -> FloatArray:
        """A (n_b, n_b), the energy's constant second derivative."""
        return self.energy.hessian(np.zeros((len(self.loop.rest_lengths), 3)))

    @property
    def always_classified(self) -> bool:
        """Whether the spectrum is known wherever a descent ends: it costs too much."""
        return False

    def at(self, x: FloatArray, before: TangentModel | None = None) -> TangentModel:
        """Return the model at a loop (n_b, 3)."""
        return subspace_model(self.energy, self.loop, self.matrix, x, before)

    def spectrum(self, model: TangentModel) -> Stability:
        """Return the lowest eigenvalues: every one that is not stable, and one more."""
        return lowest_modes(self.loop, self.matrix, model)[0]

    def modes(self, model: TangentModel, count: int) -> FloatArray:
        """Return as many modes (3 n_b, m) as are unstable or neutral, and one more."""
        return lowest_modes(self.loop, self.matrix, model)[1][:, :count]

    def settle(
        self,
        x: FloatArray,
        tensions: FloatArray,
        limit: int,
        observe: Callable[[FloatArray], None],
    ) -> Settled | None:
        """Return None: a model's Newton step is as good as it gets."""
        return None


def quadratic_models(loop: Loop, energy: LoopEnergy) -> Models:
    """Return how an energy of fixed weights is looked at, by the size of its loop."""
    if len(loop.rest_lengths) <= DENSE_LOOP:
        return QuadraticModels(energy, loop)
    return SubspaceModels(energy, loop)


def search(
    problem: Problem,
    start: Shape,
    tensions: FloatArray | None,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a film with fixed weights comes to; None if no loop is near the start."""
    film = problem.film.of_loop(start)
    models = quadratic_models(problem.loop, film.energy(problem.loop, load))
    x = _start(problem.loop, models, start.x_loop, max_iterations)
    if x is None:
        return None
    descent = Descent(models, max_iterations, observe)
    state = None if tensions is None else descent.settled(x, tensions, 0)
    status = Status.CONVERGED
    if state is None:
        state, status = descent.run(x)
    balanced = state.model.residual <= RESIDUAL_TOLERANCE
    if state.stability is None and (balanced or models.always_classified):
        state = replace(state, stability=models.spectrum(state.model))
    return record(problem, film, state, load, status)


def _start(
    loop: Loop, models: Models, x: FloatArray, max_iterations: int
) -> FloatArray | None:
    """Return a loop that keeps its lengths, near x (n_b, 3); None if there is none.

    A large loop with more energy in its roughness than in its shape is smoothed first, by
    minimising on a coarse one.
    """
    given = close_with_lengths(loop, x)
    if len(x) <= DENSE_LOOP:
        return given
    energy = models.energy
    coarse = coarsen(loop, energy, DENSE_LOOP)
    nowhere = np.zeros_like(x)
    shape = close_with_lengths(coarse.loop, coarse.restrict(x))
    if shape is None:
        return given
    smooth = close_with_lengths(loop, coarse.prolong(shape))
    if given is not None and (
        smooth is None or energy.change(nowhere, given) < 2 * energy.change(nowhere, smooth)
    ):
        return given
    descent = Descent(quadratic_models(coarse.loop, coarse.energy), max_iterations)
    minimum = descent.run(shape)[0].model.x
    smooth = close_with_lengths(loop, coarse.prolong(minimum))
    return given if smooth is None else smooth
