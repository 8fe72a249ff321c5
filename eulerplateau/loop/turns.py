"""How a loop that keeps its edges' lengths moves: by turns of its edges; and its tensions.

An edge keeps its length where it moves across itself: de_v = N_v y_v, the d - 1 columns of
N_v across e_v. Summed up along the loop,

    dx_v = t + sum_{u < v} N_u y_u - c,

c such that the sum is centred, these are n (d - 1) turns y and a translation t; the loop
stays closed where sum_u N_u y_u = 0. A matrix by vertices becomes one by turns in O(n^2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.lapack import dpttrf, dpttrs
from eulerplateau.loop.loop import Loop, backward_differences, differences


@dataclass(frozen=True)
class LengthMetric:
    """J M^-1 J^T (n_b, n_b), M = diag(<s>): how forces along the edges change lengths.

    Each edge meets only its two neighbours, so that to solve with the matrix costs O(n_b):
    it is tridiagonal but for the entry in the corner, which a rank-one term w w^T takes
    out, w having two entries; what remains is positive semidefinite, and Sherman and
    Morrison put w back. slide_kernels.py does the same inside of compiled loops.

    Attributes
    ----------
    directions : (n_b, d) float, e_v / s_v
    means : (n_b,) float, <s_v>
    """

    directions: FloatArray
    means: FloatArray

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Return (J M^-1 J^T)^-1 rhs, for rhs (n_b,) or (n_b, m).

        Raises LinAlgError if the matrix is singular: an edge has no length, or all edges
        lie along one line.
        """
        pivots, ratios, border, solved = self._factor
        solution: FloatArray = dpttrs(pivots, ratios, rhs)[0]
        share = (border @ solution) / (1 + border @ solved)
        solution -= solved * share if rhs.ndim == 1 else np.outer(solved, share)
        return solution

    @cached_property
    def _factor(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """LAPACK's factor of the matrix without w w^T, then w, and w solved for."""
        u, ease = self.directions, 1 / self.means
        squares = np.vecdot(u, u)
        diagonal = squares * (ease + np.concatenate([ease[1:], ease[:1]]))
        beside = -np.vecdot(u[1:], u[:-1]) * ease[1:]
        corner = -float(u[-1] @ u[0]) * ease[0]
        border, root = np.zeros(len(u)), math.sqrt(abs(corner))
        first, last = float(squares[0]), float(squares[-1])
        even = (first / last) ** 0.25 if first and last else 1.0
        border[0], border[-1] = root * even, math.copysign(root / even, corner)
        pivots, ratios, _ = dpttrf(diagonal - border * border, beside)
        if not pivots.min() > 0:
            raise LinAlgError("an edge of the loop has no length, or the loop no width")
        return pivots, ratios, border, dpttrs(pivots, ratios, border)[0]

    def force(self, tensions: FloatArray) -> FloatArray:
        """Return J^T tensions (n_b, d), for tensions (n_b,)."""
        return -backward_differences(tensions[:, None] * self.directions)

    def balance(self, forces: FloatArray) -> FloatArray:
        """Return the tensions (n_b,) that leave least of forces (n_b, d).

        In the norm of M^-1. Twice: once more for what rounding has left.
        """
        tensions, left = np.zeros(len(forces)), forces
        for _ in range(2):
            moved = differences(left / self.means[:, None])
            tensions -= self.solve((self.directions * moved).sum(axis=1))
            pull = tensions[:, None] * self.directions
            left = forces - backward_differences(pull)
        return tensions


def length_metric(loop: Loop, x_loop: FloatArray) -> LengthMetric:
    """Return J M^-1 J^T at a loop (n_b, d), d = 2 or 3."""
    directions = loop.chords(x_loop) / loop.rest_lengths[:, None]
    return LengthMetric(directions, loop.mean_lengths)


@dataclass(frozen=True)
class EdgeTurns:
    """Turns of the edges of a loop (n, d), and its translations.

    Attributes
    ----------
    across : (d - 1, n, d) float
        The columns N_v of each edge, sqrt(s_v) long: y_v is sqrt(s_v) times an angle.
    metric : how tensions act on this loop
    others : (k, d n) float
        Derivatives of what the loop is held to beside its edges' lengths; by default none.
    """

    across: FloatArray
    metric: LengthMetric
    others: FloatArray | None = None

    @property
    def weights(self) -> FloatArray:
        """The length (n,) that belongs to each vertex."""
        return self.metric.means

    @property
    def size(self) -> int:
        """Number of unknowns: the first turns (n,), then the second, then translations."""
        turns, n, d = self.across.shape
        return int(turns * n + d)

    @property
    def _stride(self) -> float:
        """How far a unit of translation goes: as far as turns go, or it drowns them."""
        return float(np.sqrt(self.weights.mean()))

    @cached_property
    def _behind(self) -> FloatArray:
        """The part (n,) of the loop's weight that edge v moves."""
        behind: FloatArray = 1 - np.cumsum(self.weights) / self.weights.sum()
        return behind

    def displacement(self, y: FloatArray) -> FloatArray:
        """Return dx (d n, k) of unknowns y (size, k)."""
        turns, n, d = self.across.shape
        moved = np.einsum("avd,avk->vdk", self.across, y[:-d].reshape(turns, n, -1))
        along = np.empty_like(moved)
        along[0] = 0.0
        np.cumsum(moved[:-1], axis=0, out=along[1:])
        along += self._stride * y[-d:] - np.tensordot(
            self.weights / self.weights.sum(), along, 1
        )
        moves: FloatArray = along.reshape(n * d, -1)
        return moves

    def work(self, forces: FloatArray) -> FloatArray:
        """Return the work (size, k) of forces (d n, k) by the unknowns: the adjoint."""
        turns, n, d = self.across.shape
        total, ahead = self._ahead(forces.reshape(n, d, -1))
        work = np.empty((self.size, forces.shape[1]))
        by_turns = work[:-d].reshape(turns, n, -1).transpose(1, 0, 2)
        np.matmul(self.across.transpose(1, 0, 2), ahead, out=by_turns)
        work[-d:] = self._stride * total
        return work

    def closure(self) -> FloatArray:
        """Return the columns (size, d) whose products with y say how the loop gapes."""
        turns, n, d = self.across.shape
        return np.concatenate([self.across.reshape(turns * n, d), np.zeros((d, d))])

    def mass(self) -> FloatArray:
        """Return the matrix (size, size) of the norm sum_v weights_v |dx_v|^2."""
        behind, whole = self._behind, float(self.weights.sum())
        shared = np.minimum.outer(behind, behind) - np.outer(behind, behind)
        return self._spread(whole * shared, np.zeros(len(behind)), whole)

    def matrix(self, hessian: FloatArray, by_edges: FloatArray) -> FloatArray:
        """Return a matrix by positions, and one by edges, as one (size, size) by unknowns.

        Parameters
        ----------
        hessian : one matrix (n, n) for all coordinates, or a full one (d n, d n)
        by_edges : (n, n) float, for all coordinates
        """
        n = len(self.weights)
        if len(hessian) > n:
            whole = self.work(np.ascontiguousarray(self.work(hessian).T))
            whole += self._spread(by_edges, np.zeros(n), 0.0)
            return whole
        total, ahead = self._ahead(hessian[:, None])
        beside, shared = self._ahead(np.ascontiguousarray(ahead[:, 0].T)[:, None])
        return self._spread(shared[:, 0] + by_edges, beside[0], float(total.sum()))

    def _ahead(self, forces: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the sum of forces (n, d, k), and the part of them each edge moves."""
        total = forces.sum(axis=0)
        ahead = self._behind[:, None, None] * -total
        ahead[:-1] += np.cumsum(forces[:0:-1], axis=0)[::-1]
        return total, ahead

    def _spread(self, shared: FloatArray, beside: FloatArray, corner: float) -> FloatArray:
        """Return the matrix (size, size) of numbers that are the same for all coordinates.

        shared : (n, n) between edges; beside : (n,) between edges and translations
        """
        turns, n, d = self.across.shape
        matrix = np.zeros((self.size, self.size))
        for a in range(turns):
            rows = slice(a * n, (a + 1) * n)
            for b in range(turns):
                product = self.across[a] @ self.across[b].T
                np.multiply(product, shared, out=matrix[rows, b * n : (b + 1) * n])
            matrix[rows, -d:] = self._stride * beside[:, None] * self.across[a]
            matrix[-d:, rows] = matrix[rows, -d:].T
        matrix[range(-d, 0), range(-d, 0)] = self._stride**2 * corner
        return matrix


def edge_turns(loop: Loop, x: FloatArray) -> EdgeTurns:
    """Return the turns of the edges of a loop x (n, d), d = 2 or 3."""
    metric = length_metric(loop, x)
    along = metric.directions / np.linalg.norm(metric.directions, axis=1)[:, None]
    size = np.sqrt(loop.rest_lengths)[:, None]
    if x.shape[1] == 2:
        across = np.stack([-along[:, 1], along[:, 0]], axis=1) * size
        return EdgeTurns(across[None], metric)
    # Any vector that is far from parallel: the axis along which the edge is shortest.
    other = np.eye(3)[np.abs(along).argmin(axis=1)]
    first = np.cross(along, other)
    first *= size / np.linalg.norm(first, axis=1)[:, None]
    second = np.cross(along, first)
    return EdgeTurns(np.stack([first, second]), metric)
