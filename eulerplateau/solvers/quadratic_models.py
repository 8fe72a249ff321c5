"""How the energy of a film with fixed weights is looked at: one matrix for all coordinates.

Close to an equilibrium Newton's method on positions and tensions together is a short cut
(primal_dual.py); of large loops the second variation is looked at on a subspace
(large_loops/).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Loop, LoopEnergy
from eulerplateau.solvers.equilibrium import Settled, Stability
from eulerplateau.solvers.models import DenseModels, Model, Models
from eulerplateau.solvers.primal_dual import settle
from eulerplateau.solvers.second_variation import TangentModel

# Up to this many loop vertices the whole tangent space is searched, beyond it a subspace;
# a rough start is then smoothed on a loop of as many.
DENSE_LOOP = 128


@dataclass(frozen=True)
class _OneMatrix(DenseModels):
    """Models of an energy with one constant second derivative for all coordinates."""

    loop: Loop

    @cached_property
    def matrix(self) -> FloatArray:
        """A (n_b, n_b), the energy's constant second derivative."""
        return self.energy.hessian(np.zeros((len(self.loop.rest_lengths), 3)))


@dataclass(frozen=True)
class QuadraticModels(_OneMatrix):
    """The whole tangent space, and Newton's method on positions and tensions near by."""

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
class SubspaceModels(_OneMatrix):
    """A subspace of the tangent space of a large loop, loaded where there is one."""

    @property
    def always_classified(self) -> bool:
        """Whether the spectrum is known wherever a descent ends: it costs too much."""
        return False

    def at(self, x: FloatArray, before: Model | None = None) -> TangentModel:
        """Return the model at a loop (n_b, 3)."""
        from eulerplateau.solvers.large_loops.subspace_model import subspace_model

        near = None if before is None else before.dense
        return subspace_model(self.energy, self.loop, self.matrix, x, near)

    def spectrum(self, model: Model) -> Stability:
        """Return the lowest eigenvalues: every one that is not stable, and one more."""
        return self._lowest(model)[0]

    def modes(self, model: Model, count: int) -> FloatArray:
        """Return as many modes (3 n_b, m) as are unstable or neutral, and one more."""
        return self._lowest(model)[1][:, :count]

    def _lowest(self, model: Model) -> tuple[Stability, FloatArray]:
        from eulerplateau.solvers.large_loops.subspace_model import lowest_modes

        return lowest_modes(self.loop, self.matrix, model.dense)


def quadratic_models(loop: Loop, energy: LoopEnergy) -> Models:
    """Return how the energy of a film of fixed weights is looked at.

    By the size of its loop, and by whether that resists more than bending.
    """
    if loop.terms:
        return DenseModels(energy)
    if len(loop.rest_lengths) <= DENSE_LOOP:
        return QuadraticModels(energy, loop)
    return SubspaceModels(energy, loop)
