"""Springs of zero rest length that hold some vertices of a loop to points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.loop.term import Term


@dataclass(frozen=True, eq=False)
class Adhesions(Term):
    """sum_i k_i |x_i - p_i|^2 with k_i = stiffness * weights_i: no 1/2, the force is 2 k_i.

    Attributes
    ----------
    vertices : (N,) int, each once
    points : (N, d) float, where the springs end
    weights : (N,) float, positive
    stiffness : float, k_s L^3 / alpha
    """

    vertices: IntArray
    points: FloatArray
    weights: FloatArray
    stiffness: float

    @property
    def rounding(self) -> float:
        """What rounding alone leaves of a force, per unit of position."""
        eps = float(np.finfo(np.float64).eps)
        return 2 * eps * abs(self.stiffness) * float(self.weights.max())

    def energy(self, x: FloatArray) -> float:
        """Return the energy of a loop (n, d)."""
        squares = (self.extensions(x) ** 2).sum(axis=1)
        return self.stiffness * float(self.weights @ squares)

    def extensions(self, x: FloatArray) -> FloatArray:
        """Return x_i - p_i (N, d), from each point to its vertex."""
        return x[self.vertices] - self.points

    def force(self, x: FloatArray) -> FloatArray:
        """Return the gradient (n, d)."""
        return self.stiffness * self._unit_force(x)

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return 2 k_i on the diagonal (n, n)."""
        hessian = np.zeros((len(x), len(x)))
        hessian[self.vertices, self.vertices] = 2 * self.stiffness * self.weights
        return hessian

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return the change of a quadratic form: its gradient half-way times the step."""
        return float(np.vdot(step, self.force(x + 0.5 * step)))

    def rate(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return the derivative of the force by the stiffness."""
        return self._unit_force(x) if parameter == "stiffness" else None

    def _unit_force(self, x: FloatArray) -> FloatArray:
        force = np.zeros_like(x)
        force[self.vertices] = 2 * self.weights[:, None] * self.extensions(x)
        return force
