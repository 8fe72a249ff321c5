"""The area of a soap film as a term of its loop's energy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film.interior import LocalFilm
from eulerplateau.loop import Term


@dataclass(frozen=True)
class Area(Term):
    """load * A(x_b), A the least area of films near one shape (interior.py).

    Its Hessian is a full (3 n_b, 3 n_b) matrix that changes with the loop.
    """

    local: LocalFilm
    load: float

    @property
    def rounding(self) -> float:
        """What rounding alone leaves of a force, per unit of position.

        A film of tension 1 pulls with the sum of half the sides across a vertex.
        """
        return float(np.finfo(np.float64).eps) * 8 * abs(self.load)

    def force(self, x: FloatArray) -> FloatArray:
        """Return the gradient (n_b, 3)."""
        return self.load * self.local.relax(x).force

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return the second derivative (3 n_b, 3 n_b)."""
        return self.load * self.local.relax(x).hessian

    def product(self, x: FloatArray, step: FloatArray) -> FloatArray:
        """Return the second derivative times a step (n_b, 3)."""
        return self.load * self.local.relax(x).product(step)

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return the change of the area, summed triangle by triangle as differences."""
        before, after = self.local.relax(x), self.local.relax(x + step)
        return self.load * self.local.tiling.change(before.x, after.x)

    def rate(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return the derivative of the force by the load."""
        return self.local.relax(x).force if parameter == "load" else None

    def holds(self, x: FloatArray) -> bool:
        """Return whether the film is still close enough to where it was made."""
        return self.local.holds(self.local.relax(x).sides)
