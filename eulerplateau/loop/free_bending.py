"""The bending energy of a polygon in the plane whose edges may change their lengths.

    E = sum_v phi_v^2 / s_v,    s_v = (l_v + l_{v-1}) / 2,

phi_v the exterior angle at vertex v, l_v the length of edge v -> v + 1 (alpha = 1).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.edges import (
    Edges,
    edges_of,
    length_changes,
    neighbours,
    rotations,
    scattered,
    shifted,
)
from eulerplateau.loop.loop import backward_differences
from eulerplateau.loop.term import Term

# The sum of sizes in a row of the second derivative, 2 (1 + 4 + 6 + 4 + 1) / l^3.
_STIFFEST = 32.0
# How the two edges at a vertex (4) follow the positions x_{v-1}, x_v, x_{v+1} (6).
_CHAIN = np.kron([[-1.0, 1.0, 0.0], [0.0, -1.0, 1.0]], np.eye(2))


@dataclass(frozen=True)
class FreeBending(Term):
    """sum_v phi_v^2 / s_v of a polygon (n, 2) whose shortest edge is about `edge` long.

    That length says what rounding does to the force; the term is good to a factor of two.
    """

    edge: float

    @property
    def rounding(self) -> float:
        """What rounding alone leaves of the force, per unit of position: eps |H|."""
        return float(np.finfo(np.float64).eps) * _STIFFEST / self.edge**3

    def energy(self, x: FloatArray) -> float:
        """Return the energy of a polygon (n, 2)."""
        edges = edges_of(x)
        return float((edges.turning**2 / edges.means).sum())

    def force(self, x: FloatArray) -> FloatArray:
        """Return the gradient (n, 2)."""
        edges = edges_of(x)
        moment = 2 * edges.turning / edges.means
        shrink = -0.25 * moment**2
        # By the angle of edge v, and by its length.
        turn = moment - np.append(moment[1:], moment[0])
        stretch = 0.5 * (shrink + np.append(shrink[1:], shrink[0]))
        pull = stretch[:, None] * edges.tangents
        pull += (turn / edges.lengths)[:, None] * edges.normals
        return -backward_differences(pull)

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return the second derivative (2 n, 2 n): of each vertex and its neighbours."""
        n = len(x)
        by_edges = _edge_hessians(edges_of(x))
        by_vertices = _CHAIN.T @ by_edges @ _CHAIN
        return scattered(n, neighbours(n, (-1, 0, 1)), by_vertices)

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return the energy at x + step less that at x, formed from changes of each part.

        With d for changes, phi'^2 / s' - phi^2 / s = dphi (phi + phi') / s' -
        phi^2 ds / (s s'). Raises LinAlgError where a step folds an edge back over its
        neighbour or shrinks it to nothing: on the other side the loop would turn the
        other way round.
        """
        edges = edges_of(x)
        turned = rotations(edges, step)
        turning = edges.turning
        more = np.diff(turned, prepend=turned[-1])
        after = edges_of(x + step)
        new = after.turning
        if not (np.abs(turning + more - new) < 1).all():
            raise LinAlgError("an edge of the loop folds back over its neighbour")
        grown = length_changes(edges, step)
        grown = 0.5 * (grown + shifted(grown))
        s, longer = edges.means, after.means
        by_angle = more * (turning + new) / longer
        return float((by_angle - turning**2 * grown / (s * longer)).sum())

    def holds(self, x: FloatArray) -> bool:
        """Return whether the shortest edge is still about as long."""
        shortest = float(edges_of(x).lengths.min())
        return 0.5 * self.edge <= shortest <= 2 * self.edge


def _edge_hessians(edges: Edges) -> FloatArray:
    """Return the second derivatives (n, 4, 4) of phi_v^2 / s_v by edges v - 1 and v."""
    before = edges.shifted
    phi, s = edges.turning[:, None, None], edges.means[:, None, None]
    by_angle = np.hstack(
        [-before.normals / before.lengths[:, None], edges.normals / edges.lengths[:, None]]
    )
    by_length = 0.5 * np.hstack([before.tangents, edges.tangents])
    mixed = _outer(by_angle, by_length)
    total: FloatArray = (2 / s) * _outer(by_angle, by_angle)
    total -= (2 * phi / s**2) * (mixed + mixed.transpose(0, 2, 1))
    total += (2 * phi**2 / s**3) * _outer(by_length, by_length)
    for place, edge, sign in ((slice(0, 2), before, -1.0), (slice(2, 4), edges, 1.0)):
        across = _outer(edge.tangents, edge.normals)
        length = edge.lengths[:, None, None]
        curved = (across + across.transpose(0, 2, 1)) / length**2
        stretched = _outer(edge.normals, edge.normals) / (2 * length)
        total[:, place, place] -= sign * (2 * phi / s) * curved
        total[:, place, place] -= (phi / s) ** 2 * stretched
    return total


def _outer(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return a b^T (n, k, k) for each of n rows."""
    product: FloatArray = a[:, :, None] * b[:, None, :]
    return product
