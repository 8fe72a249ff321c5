"""How the second variation is looked at: the whole of it, or the part that matters.

A descent asks for a model at a loop, for the spectrum at an equilibrium, and whether there
is a short cut to the equilibrium next to a loop. Which of these ways an energy is given is
decided where a solver is chosen (newton.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers.equilibrium import Settled, Stability
from eulerplateau.solvers.second_variation import (
    NewtonStep,
    TangentModel,
    stability,
    tangent_model,
)


class Model(Protocol):
    """A second-order model of an energy at one loop (n, d) that keeps its constraint."""

    @property
    def x(self) -> FloatArray:
        """The loop (n, d)."""

    @property
    def tensions(self) -> FloatArray:
        """Least-squares multipliers of the constraint."""

    @property
    def residual(self) -> float:
        """What they leave of the force, over the largest of its parts."""

    @property
    def rounding(self) -> float:
        """The residual that rounding alone can leave."""

    @property
    def dense(self) -> TangentModel:
        """The model in coordinates of the tangent space, or of a part of it."""

    def newton_step(self, radius: float) -> NewtonStep | None:
        """Return the Newton step; None where a way leads down, or where it does not fit."""


class Models(Protocol):
    """Second-order models of one energy of loops."""

    @property
    def energy(self) -> LoopEnergy:
        """The energy."""

    @property
    def always_classified(self) -> bool:
        """Whether the spectrum is cheap enough to be known wherever a descent ends."""

    def at(self, x: FloatArray, before: Model | None = None) -> Model:
        """Return the model at a loop (n, d); `before` is that of a loop near by."""

    def spectrum(self, model: Model) -> Stability:
        """Return the lowest part of the spectrum at an equilibrium, or all of it."""

    def modes(self, model: Model, count: int) -> FloatArray:
        """Return at most `count` of the softest modes (d n, m), the lowest first.

        They are in the model's coordinates.
        """

    def settle(
        self,
        x: FloatArray,
        tensions: FloatArray,
        limit: int,
        observe: Callable[[FloatArray], None],
    ) -> Settled | None:
        """Return the equilibrium next to x, stable or not, if there is a quick way to it.

        It takes at most `limit` steps and shows the loop to `observe` after each.
        """


@dataclass(frozen=True)
class DenseModels:
    """The whole tangent space at every loop."""

    energy: LoopEnergy

    @property
    def always_classified(self) -> bool:
        """Whether the spectrum is known wherever a descent ends: it is."""
        return True

    def at(self, x: FloatArray, before: Model | None = None) -> Model:
        """Return the model at a loop (n, d)."""
        return tangent_model(self.energy, x)

    def spectrum(self, model: Model) -> Stability:
        """Return all of the spectrum."""
        return stability(model.dense)

    def modes(self, model: Model, count: int) -> FloatArray:
        """Return the softest modes (d n, count)."""
        return model.dense.modes(model.dense.eigen[1][:, :count])

    def settle(
        self,
        x: FloatArray,
        tensions: FloatArray,
        limit: int,
        observe: Callable[[FloatArray], None],
    ) -> Settled | None:
        """Return None: there is no quicker way than descent."""
        return None
