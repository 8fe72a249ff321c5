"""The line tension of a loop: an energy proportional to its perimeter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.edges import edges_of, length_changes, length_hessian
from eulerplateau.loop.loop import backward_differences
from eulerplateau.loop.term import Term


@dataclass(frozen=True)
class LineTension(Term):
    """tension * perimeter of a polygon (n, 2) whose shortest edge is about `edge` long."""

    tension: float
    edge: float

    @property
    def rounding(self) -> float:
        """What rounding alone leaves of a force, per unit of position."""
        return float(np.finfo(np.float64).eps) * 4 * abs(self.tension) / self.edge

    def energy(self, x: FloatArray) -> float:
        """Return the energy of a polygon (n, 2)."""
        return self.tension * float(edges_of(x).lengths.sum())

    def force(self, x: FloatArray) -> FloatArray:
        """Return the gradient (n, 2)."""
        return self.tension * _perimeter_gradient(x)

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return the second derivative (2 n, 2 n)."""
        return length_hessian(edges_of(x), np.full(len(x), self.tension))

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return the energy at x + step less that at x."""
        return self.tension * float(length_changes(edges_of(x), step).sum())

    def rate(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return the derivative of the force by the tension."""
        return _perimeter_gradient(x) if parameter == "line_tension" else None


def _perimeter_gradient(x: FloatArray) -> FloatArray:
    return -backward_differences(edges_of(x).tangents)
