"""Stability: the spectrum of the second variation on the constraint's tangent space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.solvers.second_variation import TangentModel

# The lowest eigenvalue of the bare circle, 2 (2 pi)^4 times 36/5.
_SOFTEST_BENDING = 22443.0


@dataclass(frozen=True)
class Stability:
    """Eigenvalues of the second variation, rigid motions removed.

    Attributes
    ----------
    eigenvalues : (m,) float, ascending, in units alpha / L^3 for the norm integral |p|^2 ds
        All of them, or of a large loop the lowest: every one that is not stable is there.
    error_bound : float
        What rounding can have moved each eigenvalue by.
    """

    eigenvalues: FloatArray
    error_bound: float

    @property
    def blind(self) -> bool:
        """Whether rounding hides eigenvalues, even as large as those of the bare loop."""
        return self.n_neutral > 0 and self.error_bound > 0.1 * _SOFTEST_BENDING

    @property
    def n_unstable(self) -> int:
        """Eigenvalues that are negative beyond their error bound: the Morse index."""
        return int(np.sum(self.eigenvalues < -self.error_bound))

    @property
    def n_neutral(self) -> int:
        """Eigenvalues that cannot be told from zero: neither stable nor unstable."""
        return int(np.sum(np.abs(self.eigenvalues) <= self.error_bound))

    @property
    def lowest(self) -> float:
        """The smallest eigenvalue; infinite where the loop cannot move at all."""
        return float(self.eigenvalues[0]) if len(self.eigenvalues) else np.inf


def stability(model: TangentModel) -> Stability:
    """Return the spectrum at an equilibrium.

    The error bound is the backward error of the symmetric eigensolver and of the projected
    Hessian, a small multiple of eps |H|_2 (Weyl).
    """
    values = model.eigenvalues
    if len(values) == 0:
        return Stability(values, 0.0)
    eps = float(np.finfo(np.float64).eps)
    return Stability(values, 10 * eps * float(np.abs(values).max()))
