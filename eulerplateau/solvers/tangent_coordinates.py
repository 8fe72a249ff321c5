"""Orthonormal coordinates of the displacements that keep a constraint and cost something.

Orthonormal in the norm sum_v weights_v |dx_v|^2, to the constraint's linearisation and to
the motions that are free. Any constraint has those that a QR of its Jacobian gives, in
O((d n)^3). A loop of even edges that keeps their lengths is known by its edges' turns
(loop/turns.py): what is left to eliminate there is a handful of rows, and one Cholesky of
a Gram matrix makes them orthonormal, in an eighth of the work.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np
from numpy.linalg import LinAlgError

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.lapack import dgeqrf, dpotrf, dsygst, dtrtrs
from eulerplateau.loop import EdgeTurns, LoopEnergy

# Least pivot of the Gram factor, of the largest: on an even loop it is about 1 / n.
_DEPENDENT = 1e-7


class Coordinates(Protocol):
    """m coordinates of displacements of a loop (n, d), orthonormal."""

    def displacement(self, coefficients: FloatArray) -> FloatArray:
        """Return the displacements (d n, k) of coordinates (m, k)."""

    def slope(self, forces: FloatArray) -> FloatArray:
        """Return what forces (d n, k) are by the coordinates (m, k)."""

    def hessian(
        self, energy: LoopEnergy, x: FloatArray, tensions: FloatArray
    ) -> FloatArray:
        """Return the second derivative (m, m) of an energy plus tensions . constraint."""


@dataclass(frozen=True)
class Columns:
    """Coordinates along given columns.

    Attributes
    ----------
    basis : (d n, m) float, orthonormal, in the coordinates sqrt(weights) x
    scale : (d n,) float, sqrt(weights)
    """

    basis: FloatArray
    scale: FloatArray

    def displacement(self, coefficients: FloatArray) -> FloatArray:
        """Return the displacements (d n, k) of coordinates (m, k)."""
        moved: FloatArray = self.basis @ coefficients / self.scale[:, None]
        return moved

    def slope(self, forces: FloatArray) -> FloatArray:
        """Return what forces (d n, k) are by the coordinates (m, k)."""
        slope: FloatArray = self.basis.T @ (forces / self.scale[:, None])
        return slope

    def hessian(
        self, energy: LoopEnergy, x: FloatArray, tensions: FloatArray
    ) -> FloatArray:
        """Return the second derivative (m, m) of an energy plus tensions . constraint."""
        whole = energy.lagrangian_hessian(x, tensions)
        # One matrix for all coordinates, or one for the displacements of all of them.
        root = self.scale[:: len(self.scale) // len(whole)]
        scaled = whole / (root * root[:, None])
        moved = (scaled @ self.basis.reshape(len(scaled), -1)).reshape(self.basis.shape)
        projected: FloatArray = self.basis.T @ moved
        return 0.5 * (projected + projected.T)


@dataclass(frozen=True)
class Reflections:
    """An orthogonal matrix Q = I - V T V^T that turns k given columns onto the first axes.

    Attributes
    ----------
    vectors : (N, k) float, Householder's V
    factors : (k, k) float, upper triangular, T (Schreiber and Van Loan 1989)
    """

    vectors: FloatArray
    factors: FloatArray

    def back(self, y: FloatArray) -> FloatArray:
        """Return Q (0, y) (N, m) of y (N - k, m)."""
        k = len(self.factors)
        found: FloatArray = -self.vectors @ (self.factors @ (self.vectors[k:].T @ y))
        found[k:] += y
        return found

    def rest(self, y: FloatArray) -> FloatArray:
        """Return Q^T y (N - k, m) without its first k rows, of y (N, m)."""
        k = len(self.factors)
        rest: FloatArray = y[k:] - self.vectors[k:] @ (
            self.factors.T @ (self.vectors.T @ y)
        )
        return rest

    def rest_of_matrix(self, matrix: FloatArray) -> FloatArray:
        """Return Q^T A Q (N - k, N - k), of a symmetric A (N, N), without those rows."""
        k = len(self.factors)
        moved = matrix @ (self.vectors @ self.factors)
        inner = self.factors.T @ (self.vectors.T @ moved)
        moved -= 0.5 * self.vectors @ inner
        v, w = self.vectors[k:], moved[k:]
        rest: FloatArray = matrix[k:, k:] - np.hstack([v, w]) @ np.hstack([w, v]).T
        return rest


def reflections(columns: FloatArray) -> Reflections:
    """Return the reflections that turn independent columns (N, k) onto the first axes."""
    packed, tau, _, _ = dgeqrf(columns)
    k = len(tau)
    vectors = np.tril(packed, -1)
    # Where there is nothing to turn, tau is 0.
    vectors[range(k), range(k)] = tau != 0
    inverse = np.triu(vectors.T @ vectors, 1) + np.diag(1 / np.where(tau != 0, tau, 1.0))
    return Reflections(vectors, np.triu(np.linalg.inv(inverse)))


@dataclass(frozen=True)
class Turned:
    """Coordinates by the turns of edges, y = Q (0, R^-T c).

    Attributes
    ----------
    turns : the unknowns y, of which some gape the loop or cost nothing
    reflections : Q, which eliminates those
    root : (m, m) float, lower triangular, R with R R^T the norm of what is left
    """

    turns: EdgeTurns
    reflections: Reflections
    root: FloatArray

    def displacement(self, coefficients: FloatArray) -> FloatArray:
        """Return the displacements (d n, k) of coordinates (m, k)."""
        y = self._solved(coefficients, 1)
        return self.turns.displacement(self.reflections.back(y))

    def slope(self, forces: FloatArray) -> FloatArray:
        """Return what forces (d n, k) are by the coordinates (m, k)."""
        work = self.reflections.rest(self.turns.work(forces))
        return self._solved(work, 0)

    def _solved(self, y: FloatArray, trans: int) -> FloatArray:
        if not y.size:  # for LAPACK there is nothing so small
            return y
        found: FloatArray = dtrtrs(self.root, y, lower=1, trans=trans)[0]
        return found

    def hessian(
        self, energy: LoopEnergy, x: FloatArray, tensions: FloatArray
    ) -> FloatArray:
        """Return the second derivative (m, m) of an energy plus tensions . constraint."""
        whole = self.turns.matrix(*energy.split_hessian(x, tensions))
        # The transpose: LAPACK wants columns, and a symmetric matrix is the same.
        matrix: FloatArray = self.reflections.rest_of_matrix(whole).T
        if not matrix.size:  # a triangle has no freedom at all
            return matrix
        found, _ = dsygst(matrix, self.root, itype=1, lower=1, overwrite_a=1)
        np.copyto(found, found.T, where=_above(len(found)))
        projected: FloatArray = found
        return projected


def turned(turns: EdgeTurns, free: FloatArray) -> Turned:
    """Return the coordinates orthogonal to free motions (d n, k) that keep all lengths.

    Raises LinAlgError if the loop has hardly any width: then turns hang together.
    """
    weights = np.repeat(turns.weights, turns.across.shape[2])[:, None]
    gone = reflections(np.hstack([turns.closure(), turns.work(free * weights)]))
    norm = gone.rest_of_matrix(turns.mass())
    root, failed = dpotrf(norm.T, lower=1)
    if failed:
        raise LinAlgError("turns of the loop's edges hang together")
    pivots = np.diag(root)
    if len(root) and pivots.min() < _DEPENDENT * pivots.max():
        raise LinAlgError("turns of the loop's edges hang together")
    return Turned(turns, gone, root)


@lru_cache(maxsize=4)
def _above(m: int) -> BoolArray:
    """Return which entries (m, m) lie above the diagonal."""
    return ~np.tri(m, dtype=bool)
