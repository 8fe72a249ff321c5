"""One term of an energy of loops: what whoever adds to the physics of the loop writes."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping

import numpy as np

from eulerplateau.arrays import FloatArray

# What a run or a branch of films may vary: values down to these, included, do not exist.
LEAST = {
    "load": 0.0,
    "link": -math.inf,
    "twist_ratio": 0.0,
    "rest_curvature": 0.0,
    "diameter": 0.0,
}
# And values beyond these: a thicker loop has hardly room for its own turns.
MOST = {"diameter": 0.1}


class Term(ABC):
    """One term of an energy of loops x (n, d), d = 3, or 2 in a plane.

    Energies are in units of alpha / L, lengths in units of L.
    """

    @property
    def rounding(self) -> float:
        """What rounding alone leaves of the term's force, per unit of position."""
        return 0.0

    @abstractmethod
    def force(self, x: FloatArray) -> FloatArray:
        """Return the gradient of the term (n, d)."""

    @abstractmethod
    def hessian(self, x: FloatArray) -> FloatArray:
        """Return the second derivative, the caller's to change.

        It is one matrix (n, n) for all coordinates, or a full one (d n, d n).
        """

    def edge_hessian(self) -> FloatArray | None:
        """Return the second derivative by the edges e_v (n, n), all coordinates alike.

        None of a term that is not the same quadratic form of the edges everywhere. By
        positions such a form has lost digits: its entries are larger by 1 / s^2.
        """
        return None

    def product(self, x: FloatArray, step: FloatArray) -> FloatArray:
        """Return the second derivative times a step (n, d)."""
        return product(self.hessian(x), step)

    @property
    def is_handed(self) -> bool:
        """Whether a loop and its mirror image differ in it."""
        return False

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return the term at x + step less that at x, as precise as the difference.

        Here it is the work of the force along the step, by Gauss's rule: right for terms
        of degree 16, and to many digits for smooth ones. Terms that know better say so.
        """
        places, shares = np.polynomial.legendre.leggauss(8)
        work = [np.vdot(step, self.force(x + 0.5 * (1 + t) * step)) for t in places]
        return 0.5 * float(np.dot(shares, work))

    def rate(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return the derivative of the force (n, d) by a parameter; None if there is none.

        A parameter is a number the term depends on, by the name under which a branch
        varies it: the load of a film, the stiffness of springs.
        """
        return None

    def holds(self, x: FloatArray) -> bool:
        """Return whether the term is still good at x."""
        return True

    def reaches(self, x: FloatArray, other: FloatArray) -> bool:
        """Return whether a short way leads to another loop: nothing passes through."""
        return True


class OwnTerm(Term):
    """What a loop's own energy has beside its bending: that of its twist."""

    @property
    def slides(self) -> bool:
        """Whether a loop slides along itself for nothing, as far as the term knows."""
        return True

    @property
    def parameters(self) -> Mapping[str, float]:
        """What can be varied of it, by the names that `rate` knows: values of LEAST."""
        return {}

    @abstractmethod
    def with_value(self, parameter: str, value: float) -> OwnTerm:
        """Return the term at another value of a parameter; itself if it has no such one."""

    @abstractmethod
    def on_edges(self, rest_lengths: FloatArray) -> OwnTerm:
        """Return the term of the same loop with other edges, so long (n,)."""

    @abstractmethod
    def energy(self, x: FloatArray) -> float:
        """Return the energy of a loop (n, 3)."""

    @abstractmethod
    def columns(self, x: FloatArray) -> Mapping[str, float]:
        """Return what tables say of it, by the names of their columns."""

    @abstractmethod
    def fields(self, x: FloatArray) -> Mapping[str, FloatArray]:
        """Return what shapes say of it: vectors (n, 3) on the loop, by their names."""

    @abstractmethod
    def pinched(self, x: FloatArray) -> bool:
        """Return whether the loop meets itself where that ends what the term says."""


def product(matrix: FloatArray, step: FloatArray) -> FloatArray:
    """Return a matrix, (n, n) for all coordinates or (d n, d n), times a step (n, d)."""
    if len(matrix) == len(step):
        return matrix @ step
    return (matrix @ step.ravel()).reshape(step.shape)


def summed(parts: list[FloatArray], n: int) -> FloatArray:
    """Return the sum of matrices (n, n), the same for all coordinates, and full ones."""
    alike = [part for part in parts if len(part) == n]
    full = [part for part in parts if len(part) > n]
    shared = alike[0] if alike else np.zeros((n, n))
    for part in alike[1:]:
        shared += part
    if not full:
        return shared
    total = full[0]
    for part in full[1:]:
        total += part
    d = len(total) // n
    blocks = total.reshape(n, d, n, d)
    for axis in range(d):
        blocks[:, axis, :, axis] += shared
    return total
