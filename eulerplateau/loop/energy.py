"""What a solver must know of an energy of loops to minimise it."""

from __future__ import annotations

from functools import cached_property
from typing import Protocol

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.loop import Loop

# Up to this many loop vertices the whole tangent space is searched, beyond it a subspace;
# a rough start is then smoothed on a loop of as many.
DENSE_LOOP = 128


class CondensedEnergy(Protocol):
    """An energy of loops (n_b, 3), the film's interior eliminated."""

    @property
    def loop(self) -> Loop:
        """Rest lengths and bending."""

    @property
    def dense(self) -> bool:
        """Whether matrices of all the loop's displacements are used."""

    @property
    def slides(self) -> bool:
        """Whether the loop's sliding along itself costs nothing but by discretisation."""

    @property
    def force_rounding(self) -> float:
        """What rounding alone leaves of a force, per unit of position."""

    def film_force(self, x: FloatArray) -> FloatArray:
        """Return the gradient of the film's energy (n_b, 3)."""

    def lagrangian_hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        """Return the Hessian of E + lambda . c: one for all coordinates, or for each."""

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return E(x + step) - E(x) with the relative precision of the difference."""

    def holds(self, x: FloatArray) -> bool:
        """Return whether the energy is still good at x."""


class SoapEnergy:
    """What energies of true soap films have in common, in space and in their plane."""

    loop: Loop

    @property
    def dense(self) -> bool:
        """Whether matrices of all the loop's displacements are used: always."""
        return True

    @property
    def slides(self) -> bool:
        """Whether the loop may slide along itself: the film only sees its curve."""
        return True

    @cached_property
    def bending(self) -> FloatArray:
        """2 B (n_b, n_b)."""
        return 2 * self.loop.bending_matrix


def stress_stiffness(loop: Loop, multipliers: FloatArray) -> FloatArray:
    """Return D^T diag(lambda / s) D (n_b, n_b): what tension adds to the stiffness."""
    stress = multipliers / loop.rest_lengths
    n = len(stress)
    stiffness = np.diag(stress + np.roll(stress, 1))
    v = np.arange(n)
    # Not stiffness[i, j] -= ...: with three vertices an entry can occur twice.
    np.subtract.at(stiffness, (v, (v + 1) % n), stress)
    np.subtract.at(stiffness, ((v + 1) % n, v), stress)
    return stiffness
