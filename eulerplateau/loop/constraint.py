"""What a loop is held to: the lengths of its edges one by one, or nothing."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.lengths import jacobian, project_lengths
from eulerplateau.loop.loop import Loop


class Constraint(Protocol):
    """m equations c(x) = 0 for loops x (n, d); their multipliers are called tensions."""

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Return dc/dx (m, d n)."""

    def force(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return J^T tensions (n, d), for tensions (m,)."""

    def stiffness(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the second derivative of tensions . c, as a term's `hessian` is."""

    def project(self, x: FloatArray) -> FloatArray | None:
        """Return the nearest loop (n, d) with c = 0, to rounding; None if it is lost."""


@dataclass(frozen=True)
class Lengths:
    """Every edge keeps its length: c_v = (|e_v|^2 - s_v^2) / (2 s_v)."""

    loop: Loop

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Return J (n, d n): see lengths.jacobian."""
        return jacobian(self.loop, x)

    def force(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return J^T tensions (n, d)."""
        return self.loop.tension_force(x, tensions)

    def stiffness(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return D^T diag(tensions / s) D (n, n)."""
        return self.loop.tension_stiffness(tensions)

    def project(self, x: FloatArray) -> FloatArray | None:
        """Return the nearest loop that keeps its lengths."""
        return project_lengths(self.loop, x)


class Unconstrained:
    """No equation at all: the loop's length is free."""

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Return no rows (0, d n)."""
        return np.zeros((0, x.size))

    def force(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return no force (n, d)."""
        return np.zeros_like(x)

    def stiffness(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return no stiffness (n, n)."""
        return np.zeros((len(x), len(x)))

    def project(self, x: FloatArray) -> FloatArray | None:
        """Return the loop itself."""
        return x
