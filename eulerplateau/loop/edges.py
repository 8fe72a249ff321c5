"""The edges of a polygon in the plane: lengths, directions, and how they change.

Of an edge e = l t with the tangent t = (cos theta, sin theta) and n = (-sin, cos) to its
left, dl = t . de and dtheta = n . de / l; the second derivatives by e are

    d2l = n n^T / l,    d2theta = -(t n^T + n t^T) / l^2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.loop.loop import differences


@dataclass(frozen=True)
class Edges:
    """Edges v -> v + 1 of a closed polygon x (n, 2).

    Attributes
    ----------
    vectors : (n, 2) float, e_v = x_{v+1} - x_v
    lengths : (n,) float
    tangents, normals : (n, 2) float, unit vectors along and to the left of each edge
    """

    vectors: FloatArray
    lengths: FloatArray
    tangents: FloatArray
    normals: FloatArray

    @property
    def turning(self) -> FloatArray:
        """Angles (n,) from edge v - 1 to edge v, in (-pi, pi]; left is positive."""
        before = shifted(self.tangents)
        along = (before * self.tangents).sum(axis=1)
        turning: FloatArray = np.arctan2(_cross(before, self.tangents), along)
        return turning

    @property
    def means(self) -> FloatArray:
        """The length (n,) that belongs to each vertex, (l_v + l_{v-1}) / 2."""
        return 0.5 * (self.lengths + shifted(self.lengths))

    @property
    def shifted(self) -> Edges:
        """The same with edge v - 1 in place of edge v."""
        parts = self.vectors, self.lengths, self.tangents, self.normals
        return Edges(*(shifted(part) for part in parts))


def shifted(rows: FloatArray) -> FloatArray:
    """Return row v - 1 in place of row v, cyclic (np.roll costs more than the work)."""
    return np.concatenate([rows[-1:], rows[:-1]])


def edges_of(x: FloatArray) -> Edges:
    """Return the edges of a polygon (n, 2); LinAlgError where one has no length."""
    vectors = differences(x)
    lengths = np.hypot(vectors[:, 0], vectors[:, 1])
    if not lengths.min() > 0:
        raise LinAlgError("an edge of the loop has no length")
    tangents = vectors / lengths[:, None]
    normals = np.empty_like(tangents)
    normals[:, 0], normals[:, 1] = -tangents[:, 1], tangents[:, 0]
    return Edges(vectors, lengths, tangents, normals)


def length_changes(before: Edges, step: FloatArray) -> FloatArray:
    """Return by how much edges grow (n,), as precise as the step (n, 2) of the vertices.

    As (2 e + u) . u / (l + l'), u the change of e: the difference of two lengths would
    keep only the digits in which they differ.
    """
    moved = differences(step)
    after = before.vectors + moved
    grown = ((before.vectors + after) * moved).sum(axis=1)
    changes: FloatArray = grown / (before.lengths + np.hypot(after[:, 0], after[:, 1]))
    return changes


def rotations(before: Edges, step: FloatArray) -> FloatArray:
    """Return by which angle (n,), in (-pi, pi], a step (n, 2) turns each edge."""
    moved = differences(step)
    along = (before.vectors * (before.vectors + moved)).sum(axis=1)
    turned: FloatArray = np.arctan2(_cross(before.vectors, moved), along)
    return turned


def length_hessian(edges: Edges, weights: FloatArray) -> FloatArray:
    """Return the second derivative (2 n, 2 n) of sum_v weights_v l_v."""
    n = len(weights)
    across = edges.normals[:, :, None] * edges.normals[:, None, :]
    block = across * (weights / edges.lengths)[:, None, None]
    local = np.empty((n, 2, 2, 2, 2))
    local[:, 0, :, 0] = local[:, 1, :, 1] = block
    local[:, 0, :, 1] = local[:, 1, :, 0] = -block
    return scattered(n, neighbours(n, (0, 1)), local.reshape(n, 4, 4))


def neighbours(n: int, offsets: tuple[int, ...]) -> IntArray:
    """Return the vertices v + offset (n, k) of each vertex v of a closed polygon."""
    around: IntArray = (np.arange(n)[:, None] + np.array(offsets)) % n
    return around


def scattered(n: int, vertices: IntArray, blocks: FloatArray) -> FloatArray:
    """Return the sum (2 n, 2 n) of matrices that belong to a few vertices each.

    vertices : (m, k) int; blocks : (m, 2 k, 2 k) float, coordinates next to each other.
    """
    places = (2 * vertices[:, :, None] + np.arange(2)).reshape(len(vertices), -1)
    entries = 2 * n * places[:, :, None] + places[:, None, :]
    total = np.bincount(entries.ravel(), blocks.ravel(), 4 * n * n)
    return total.astype(np.float64, copy=False).reshape(2 * n, 2 * n)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    crossed: FloatArray = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return crossed
