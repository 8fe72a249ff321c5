"""What of forces is along the tangent space of a constraint, and derivatives along it.

It needs no coordinates there: an energy's second derivative along a few displacements
costs as many products, and what the constraint takes of each is one small solve.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import LengthMetric, LoopEnergy


@dataclass(frozen=True)
class Directional:
    """The second variation at a loop x (n, d), along one displacement after another.

    It needs no coordinates of the tangent space, only what of a force is along it.

    Attributes
    ----------
    along : takes a force (n, d) to the tensions that balance it best and what is left of
        it, which is not along motions that are free
    tensions : those that balance the energy's force
    """

    energy: LoopEnergy
    x: FloatArray
    along: Callable[[FloatArray], tuple[FloatArray, FloatArray]]
    tensions: FloatArray

    def left(self, force: FloatArray) -> FloatArray:
        """Return what of a force (n, d) is along the tangent space."""
        return self.along(force)[1]

    def pull(self, displacement: FloatArray) -> FloatArray:
        """Return the force (n, d) against the part of a displacement there."""
        weights = self.energy.weights[:, None]
        step = self.left(weights * displacement) / weights
        return self.left(self.energy.product(self.x, self.tensions, step))


def directional(energy: LoopEnergy, x: FloatArray) -> Directional:
    """Return the second variation at loop positions x (n, d) that keep the constraint."""
    free = energy.free_motions(x)
    turns = energy.constraint.turns(x)
    if turns is None or turns.others is not None:
        along = _balanced_by_columns(energy, x, free)
    else:
        motions = orthonormal(energy, free)
        along = partial(balanced, energy, x, motions=motions, metric=turns.metric)
    forces = energy.forces(x)
    return Directional(energy, x, along, along(sum(forces[1:], start=forces[0]))[0])


def balanced(
    energy: LoopEnergy,
    x: FloatArray,
    force: FloatArray,
    motions: FloatArray,
    metric: LengthMetric,
) -> tuple[FloatArray, FloatArray]:
    """Return the tensions (n,) that balance a force (n, d) best, and what is left of it.

    Of that the part along `motions` (d n, k), orthonormal and free, is left out.
    """
    tensions = metric.balance(force)
    left = (force + energy.constraint.force(x, tensions)).reshape(-1, 1)
    root = np.repeat(np.sqrt(energy.weights), x.shape[1])[:, None]
    left -= motions @ (motions.T @ (left / root**2))
    return tensions, left.reshape(x.shape)


def orthonormal(energy: LoopEnergy, free: FloatArray) -> FloatArray:
    """Return motions (d n, k) made orthonormal in the norm of the weights, times these."""
    root = np.repeat(np.sqrt(energy.weights), len(free) // len(energy.weights))[:, None]
    held: FloatArray = np.linalg.qr(free * root)[0] * root
    return held


def normals(
    energy: LoopEnergy, x: FloatArray, free: FloatArray
) -> tuple[FloatArray, FloatArray, int]:
    """Return sqrt(weights) (d n,), what is normal to the tangent space, and m of it.

    As columns, in the coordinates sqrt(weights) x: those of m equations, then free motions.
    """
    scale = np.repeat(np.sqrt(energy.weights), x.shape[1])
    rows = energy.constraint.jacobian(x)
    return scale, np.hstack([(rows / scale).T, free * scale[:, None]]), len(rows)


def _balanced_by_columns(
    energy: LoopEnergy, x: FloatArray, free: FloatArray
) -> Callable[[FloatArray], tuple[FloatArray, FloatArray]]:
    """Return the same as `balanced`, of a force (n, d), of any constraint."""
    scale, columns, m = normals(energy, x, free)
    q, r = np.linalg.qr(columns)

    def along(force: FloatArray) -> tuple[FloatArray, FloatArray]:
        weighted = force.ravel() / scale
        parts = q.T @ weighted
        left = (weighted - q @ parts) * scale
        return -np.linalg.solve(r[:m, :m], parts[:m]), left.reshape(x.shape)

    return along
