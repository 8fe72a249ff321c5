"""The bending energy of a loop, and the energy of a loop that keeps its lengths."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.energy import LoopEnergy
from eulerplateau.loop.lengths import Lengths
from eulerplateau.loop.loop import Loop
from eulerplateau.loop.term import Term


@dataclass(frozen=True)
class Bending(Term):
    """sum_v <s_v> kappa_v^2 of a loop that keeps its lengths (eq. discrete-energy).

    There the energy is the quadratic form tr(x^T B x), B = loop.bending_matrix.
    """

    loop: Loop

    @property
    def rounding(self) -> float:
        """What rounding alone leaves of the force, per unit of position: eps |2 B|."""
        return float(np.finfo(np.float64).eps) * self.loop.stiffest_row

    def force(self, x: FloatArray) -> FloatArray:
        """Return 2 B x (n, d)."""
        return self.loop.bending_force(x)

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return 2 B (n, n)."""
        return 2 * self.loop.bending_matrix

    def edge_hessian(self) -> FloatArray:
        """Return the second derivative by the edges (n, n)."""
        return 2 * self.loop.edge_bending_matrix

    def product(self, x: FloatArray, step: FloatArray) -> FloatArray:
        """Return 2 B step (n, d)."""
        return self.loop.bending_force(step)

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return the change of a quadratic form: its gradient half-way times the step."""
        return float(np.vdot(step, self.loop.bending_force(x + 0.5 * step)))


def inextensible(
    loop: Loop, film: Term, free_motions: Callable[[FloatArray], FloatArray]
) -> LoopEnergy:
    """Return a loop's own energy plus a film's, of a loop that keeps its lengths."""
    terms = {"bending": Bending(loop), **loop.terms, "film": film}
    return LoopEnergy(terms, Lengths(loop), loop.mean_lengths, free_motions)
