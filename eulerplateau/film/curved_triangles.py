"""The area of a film of curved triangles: quadratic, with a node in each edge's middle.

With the six nodes p_k of a triangle, its corners and the middles opposite them, and the
quadratic shape functions N_k over the unit triangle, x = sum_k N_k p_k, and the area is the
integral of |c|, c = x_1 x x_2, indices being derivatives. With the unit normal n = c / |c|,

    d|c| = n . dc,    d2|c| = (|dc|^2 - (n . dc)^2) / |c| + 2 n . (dx_1 x dx_2).

The least area on such triangles errs by O(h^4), as the energy of quadratic elements does
(Strang and Fix, An Analysis of the Finite Element Method, 1973).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray, IntArray, cross
from eulerplateau.film.elimination import summed

# Three points inside, exact for polynomials of degree 2: enough for an error of O(h^4).
_PLACES = np.array([[1, 1], [4, 1], [1, 4]]) / 6
_WEIGHT = 1 / 6


def _slopes() -> tuple[FloatArray, FloatArray]:
    """Return the derivatives (3, 6) of the shape functions at the points, by xi and eta.

    In barycentric coordinates l: l_j (2 l_j - 1) of corner j, 4 l_k l_m of the middle
    opposite it.
    """
    place = np.column_stack([1 - _PLACES.sum(axis=1), _PLACES])
    slope = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
    after, before = np.roll(place, -1, axis=1), np.roll(place, 1, axis=1)
    found = []
    for d in slope:
        d_after, d_before = np.roll(d, -1), np.roll(d, 1)
        corners, middles = (4 * place - 1) * d, 4 * (after * d_before + before * d_after)
        found.append(np.concatenate([corners, middles], axis=1))
    return found[0], found[1]


_XI, _ETA = _slopes()


@dataclass(frozen=True)
class CurvedTriangles:
    """Triangles whose nodes are vertices and, behind these, the middles of edges.

    Attributes
    ----------
    nodes : (n_t, 6) int
    edges : (n_e, 2) int, the vertices that a middle is between
    on_loop : (n_b,) int, the edges of the loop in order
    n_v : int, vertices
    """

    nodes: IntArray
    edges: IntArray
    on_loop: IntArray
    n_v: int

    @classmethod
    def of(cls, triangles: IntArray, loop: IntArray, n_v: int) -> CurvedTriangles:
        """Give triangles (n_t, 3), with their loop (n_b,), a node in each edge's middle."""
        opposite = triangles[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2)
        keys = opposite.min(axis=1) * n_v + opposite.max(axis=1)
        known, number = np.unique(keys, return_inverse=True)
        edges = np.stack([known // n_v, known % n_v], axis=1)
        following = np.roll(loop, -1)
        around = np.minimum(loop, following) * n_v + np.maximum(loop, following)
        nodes = np.concatenate([triangles, n_v + number.reshape(-1, 3)], axis=1)
        return cls(nodes, edges, np.searchsorted(known, around), n_v)

    @property
    def size(self) -> int:
        """The number of nodes."""
        return self.n_v + len(self.edges)

    @cached_property
    def is_inside(self) -> BoolArray:
        """Whether each node is inside, not on the loop."""
        inside = np.ones(self.size, dtype=bool)
        inside[self.edges[self.on_loop].ravel()] = False
        inside[self.n_v + self.on_loop] = False
        return inside

    def spread(self, values: FloatArray) -> FloatArray:
        """Return values (n_v, ...) and, at each middle, the mean of its ends'."""
        between = 0.5 * (values[self.edges[:, 0]] + values[self.edges[:, 1]])
        return np.concatenate([values, between])

    def gathered(self, forces: FloatArray) -> FloatArray:
        """Return what forces (size, ...) come to on vertices (n_v, ...): the adjoint."""
        half = np.repeat(0.5 * forces[self.n_v :], 2, axis=0)
        return forces[: self.n_v] + summed(self.edges.ravel(), half, self.n_v)

    def at(self, x: FloatArray) -> CurvedFilm:
        """Return the film whose nodes are at x (size, 3)."""
        corners = x[self.nodes]
        return CurvedFilm(self, np.matmul(_XI, corners), np.matmul(_ETA, corners))


@dataclass(frozen=True)
class CurvedFilm:
    """Such a film: its derivatives x_1 and x_2 (n_t, 3, 3) at each triangle's points."""

    triangles: CurvedTriangles
    x_1: FloatArray
    x_2: FloatArray

    @property
    def area(self) -> float:
        """Its area."""
        return float(_WEIGHT * self._size.sum())

    @cached_property
    def gradient(self) -> FloatArray:
        """The gradient of its area (size, 3)."""
        along_xi = cross(self.x_2, self._normal)
        along_eta = cross(self._normal, self.x_1)
        forces = np.matmul(_XI.T, along_xi) + np.matmul(_ETA.T, along_eta)
        return self._gather(_WEIGHT * forces)

    def stiffness(self, directions: FloatArray) -> FloatArray:
        """Return each triangle's Hessian (n_t, 6, 6) along directions (size, 3)."""
        n = directions[self.triangles.nodes][:, None]
        normal = self._normal[:, :, None]
        d_1, d_2 = _XI[..., None] * n, _ETA[..., None] * n
        turned = cross(d_1, self.x_2[:, :, None]) + cross(self.x_1[:, :, None], d_2)
        turned -= (turned * normal).sum(axis=-1, keepdims=True) * normal
        turned /= np.sqrt(self._size)[:, :, None, None]
        mixed = np.matmul(cross(normal, d_1), d_2.swapaxes(2, 3))
        whole = np.matmul(turned, turned.swapaxes(2, 3)) + mixed + mixed.swapaxes(2, 3)
        stiffness: FloatArray = _WEIGHT * whole.sum(axis=1)
        return stiffness

    def _gather(self, forces: FloatArray) -> FloatArray:
        n = forces.shape[-1]
        return summed(
            self.triangles.nodes.ravel(), forces.reshape(-1, n), self.triangles.size
        )

    @cached_property
    def _across(self) -> FloatArray:
        return cross(self.x_1, self.x_2)

    @cached_property
    def _size(self) -> FloatArray:
        size: FloatArray = np.linalg.norm(self._across, axis=2)
        return size

    @cached_property
    def _normal(self) -> FloatArray:
        return self._across / self._size[:, :, None]
