"""A loop in pieces whose edges are equal: each piece has one length, which is free."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, solveh_banded

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.loop.edges import Edges, edges_of, length_hessian

# Gauss-Newton converges quadratically: a handful of steps from a nearby loop.
_PROJECTION_STEPS = 30
# Edges that differ by less than this, relative to the longest, may be equal to rounding.
_SMALL = 1e-12
# Vertices farther than this from their places, in edges, are spread along the polygon.
_FAR = 0.2


@dataclass(frozen=True)
class EqualEdges:
    """c_j = l_{j+1} - l_j = 0 inside each side of a polygon x (N m, 2).

    Side i has the vertices i m ... (i + 1) m; the m - 1 equations of a side stand next to
    each other. Between two sides nothing is asked, so that each has a free length.
    """

    per_side: int

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Return dc/dx (n - N, 2 n)."""
        rows = self._rows(edges_of(x))
        sides, inner = rows.shape[:2]
        dense = np.zeros((sides * inner, len(x), 2))
        first = self._first(sides)
        for place in range(3):
            vertices = (first + place) % len(x)
            dense[np.arange(len(first)), vertices] = rows[:, :, place].reshape(-1, 2)
        return dense.reshape(len(first), -1)

    def force(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return J^T tensions (n, 2), for tensions (n - N,)."""
        return self._pulled(self._rows(edges_of(x)), tensions, len(x))

    def stiffness(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the second derivative (2 n, 2 n) of tensions . c."""
        pulls = tensions.reshape(-1, self.per_side - 1)
        weights = -np.diff(pulls, axis=1, prepend=0.0, append=0.0)
        return length_hessian(edges_of(x), weights.ravel())

    def excess(self, x: FloatArray) -> FloatArray:
        """Return c (N, m - 1)."""
        return self._excess(edges_of(x))

    def project(self, x: FloatArray) -> FloatArray | None:
        """Return a near loop with equal edges, to rounding; None if it is lost.

        Gauss-Newton, the ends of the sides held still: each side's equations J J^T meet
        their two next neighbours only, and a banded Cholesky costs O(n). It converges
        where vertices have less than an edge to go; from farther they are spread along
        the polygon first.
        """
        error = np.inf
        for _ in range(_PROJECTION_STEPS):
            try:
                edges = edges_of(x)
                excess = self._excess(edges)
                previous = error
                error = float(np.abs(excess).max() / edges.lengths.max())
                # Quadratic convergence ends where rounding begins: error stops falling.
                if error < 1e-15 or (error < _SMALL and error >= 0.25 * previous):
                    return x
                if self._shift(edges) > _FAR:
                    x = self._spread(x, edges)
                else:
                    x = x - self._correction(edges, excess)
            except (LinAlgError, ValueError):
                return None
        return x if error < _SMALL else None

    def turns(self, x: FloatArray) -> None:
        """Return None: edges may grow together."""

    def split_stiffness(
        self, x: FloatArray, tensions: FloatArray
    ) -> tuple[FloatArray | None, FloatArray]:
        """Return nothing: there are no turns to say it by."""
        return None, np.zeros(0)

    def _shift(self, edges: Edges) -> float:
        """Return how far a vertex is from its place along its side, in edges."""
        lengths = edges.lengths.reshape(-1, self.per_side)
        steps = lengths / lengths.mean(axis=1, keepdims=True) - 1
        return float(np.abs(np.cumsum(steps, axis=1)).max())

    def _spread(self, x: FloatArray, edges: Edges) -> FloatArray:
        """Return vertices (n, 2) at equal distances along each side of a polygon."""
        m, spread = self.per_side, np.empty_like(x)
        closed = np.vstack([x, x[:1]])
        for start in range(0, len(x), m):
            places = np.append(0.0, np.cumsum(edges.lengths[start : start + m]))
            wanted = places[-1] * np.arange(m) / m
            for axis in range(2):
                corners = closed[start : start + m + 1, axis]
                spread[start : start + m, axis] = np.interp(wanted, places, corners)
        return spread

    def _correction(self, edges: Edges, excess: FloatArray) -> FloatArray:
        """Return the least move (n, 2) of inner vertices that takes c away, linearly."""
        rows = self._rows(edges)
        rows[:, 0, 0] = rows[:, -1, 2] = 0.0
        pull = solveh_banded(_normal_bands(rows), excess.ravel(), lower=True)
        return self._pulled(rows, pull, len(edges.lengths))

    def _excess(self, edges: Edges) -> FloatArray:
        return np.diff(edges.lengths.reshape(-1, self.per_side), axis=1)

    def _rows(self, edges: Edges) -> FloatArray:
        """Return dc/dx (N, m - 1, 3, 2) of each equation by its three vertices."""
        tangents = edges.tangents.reshape(-1, self.per_side, 2)
        before, after = tangents[:, :-1], tangents[:, 1:]
        return np.stack([before, -before - after, after], axis=2)

    def _first(self, sides: int) -> IntArray:
        """Return the first vertex (n - N,) of each equation."""
        starts = self.per_side * np.arange(sides)
        first: IntArray = (starts[:, None] + np.arange(self.per_side - 1)).ravel()
        return first

    def _pulled(self, rows: FloatArray, pull: FloatArray, n: int) -> FloatArray:
        """Return J^T pull (n, 2) for given rows of J."""
        pulls = pull.reshape(rows.shape[:2])[:, :, None, None] * rows
        moved = np.zeros((n, 2))
        first = self._first(len(rows))
        for place in range(3):
            # No two equations have the same vertex in the same place.
            moved[(first + place) % n] += pulls[:, :, place].reshape(-1, 2)
        return moved


def _normal_bands(rows: FloatArray) -> FloatArray:
    """Return the lower bands (3, n - N) of J J^T, rows (N, m - 1, 3, 2) as in `_rows`."""
    bands = np.zeros((3, *rows.shape[:2]))
    bands[0] = (rows**2).sum(axis=(2, 3))
    bands[1, :, :-1] = (rows[:, :-1, 1:] * rows[:, 1:, :2]).sum(axis=(2, 3))
    bands[2, :, :-2] = (rows[:, :-2, 2] * rows[:, 2:, 0]).sum(axis=2)
    return bands.reshape(3, -1)
