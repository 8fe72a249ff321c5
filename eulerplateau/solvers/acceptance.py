"""Whether a step of a descent is taken: what it gains, what it promised, and rounding."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers.second_variation import NewtonStep, TangentModel
from eulerplateau.solvers.trust_region import trust_region_step

SMALLEST_RADIUS = 1e-12
_LARGEST_RADIUS = 0.5


class Balanced(Protocol):
    """A model of an energy near a loop, as far as it says how well forces balance."""

    @property
    def residual(self) -> float:
        """What forces are left, over the largest."""

    @property
    def rounding(self) -> float:
        """The residual that rounding alone can leave."""


def accepted(step: NewtonStep, gained: float, noise: float, radius: float) -> float | None:
    """Return the radius of the next step; None if this has not gained what it promised.

    noise : float, the change of energy that rounding alone can show
    """
    at_noise = abs(gained) <= noise and -step.promised <= noise
    if not (gained <= 0.1 * min(step.promised, 0.0) or at_noise):
        return None
    grow = step.size > 0.8 * radius and gained < 0.75 * step.promised
    return min(2 * radius, _LARGEST_RADIUS) if grow else radius


def noise_of(
    energy: LoopEnergy, x: FloatArray, moved: FloatArray, tensions: FloatArray
) -> float:
    """Return the change of energy that rounding alone can show for a displacement.

    Rounding of the forces counts, and that of the positions by way of the edges' lengths.
    """
    eps = float(np.finfo(np.float64).eps)
    by_lengths = eps * float(np.abs(x).max() * np.abs(tensions).sum())
    return 4 * (energy.rounding * float(np.abs(moved).sum()) + by_lengths)


def at_rounding(model: Balanced) -> bool:
    """Whether the forces balance as well as double precision can tell."""
    return model.residual <= max(4 * model.rounding, 1e-13)


def change_of_energy(
    energy: LoopEnergy, x: FloatArray, after: FloatArray | None
) -> float | None:
    """Return the change of energy; None where there is no loop, or no film on it."""
    if after is None:
        return None
    try:
        return energy.change(x, after - x)
    except LinAlgError:
        return None


def bounded_step(energy: LoopEnergy, model: TangentModel, radius: float) -> NewtonStep:
    """Return the trust-region step, still along modes whose gain rounding would hide.

    A hexagon's saddle turns against its mesh almost for free: following that mode would
    walk round the circle of saddles for ever without gaining a measurable energy.
    """
    values, vectors = model.eigen
    slope = vectors.T @ model.gradient
    gain = np.abs(slope) + 0.5 * np.abs(values) * radius
    live = gain > 4 * energy.rounding
    if not live.any():
        return model.step(np.zeros_like(slope))
    bounded = trust_region_step(values[live], slope[live], radius)
    return model.step(vectors[:, live] @ bounded)
