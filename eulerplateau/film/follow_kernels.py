"""How a plane mesh follows its loop: compiled loops, arrays in, arrays out.

Helpers stay in this file (numba #1833).
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.compiling import njit


@njit(cache=True, error_model="numpy")
def _pull(
    triangles: IntArray, weights: FloatArray, move: FloatArray, pull: FloatArray
) -> None:
    """Fill pull (n_v, 2) with the cotangent Laplacian of move (n_v, 2)."""
    for v in range(len(pull)):
        pull[v, 0] = pull[v, 1] = 0.0
    for t in range(len(triangles)):
        for j in range(3):
            i, k = triangles[t, (j + 1) % 3], triangles[t, (j + 2) % 3]
            for d in range(2):
                force = weights[t, j] * (move[i, d] - move[k, d])
                pull[i, d] += force
                pull[k, d] -= force


@njit(cache=True, error_model="numpy")
def spread_inside(
    triangles: IntArray,
    weights: FloatArray,
    interior: IntArray,
    move: FloatArray,
    small: float,
    limit: int,
) -> float:
    """Fill the interior of move (n_v, 2), given on the loop, with its harmonic extension.

    That of a shape by the cotangents `weights` (n_t, 3) at its triangles' corners, by
    conjugate gradients on both coordinates at once, scaled by the diagonal; at most `limit`
    of them, until what is left of the forces has fallen to `small` times what it was.
    Returns by how much it has.
    """
    n_v = len(move)
    diagonal, pull = np.zeros(n_v), np.empty((n_v, 2))
    rest, way = np.zeros((n_v, 2)), np.zeros((n_v, 2))
    for t in range(len(triangles)):
        for j in range(3):
            diagonal[triangles[t, (j + 1) % 3]] += weights[t, j]
            diagonal[triangles[t, (j + 2) % 3]] += weights[t, j]
    _pull(triangles, weights, move, pull)
    size = first = 0.0
    for v in interior:
        for d in range(2):
            rest[v, d] = -pull[v, d]
            way[v, d] = rest[v, d] / diagonal[v]
            first += rest[v, d] * way[v, d]
    size = first
    for _ in range(limit):
        if not size > small * small * first:
            break
        _pull(triangles, weights, way, pull)
        along = 0.0
        for v in interior:
            along += way[v, 0] * pull[v, 0] + way[v, 1] * pull[v, 1]
        step, before, size = size / along, size, 0.0
        for v in interior:
            for d in range(2):
                move[v, d] += step * way[v, d]
                rest[v, d] -= step * pull[v, d]
                size += rest[v, d] * rest[v, d] / diagonal[v]
        for v in interior:
            for d in range(2):
                way[v, d] = rest[v, d] / diagonal[v] + size / before * way[v, d]
    return np.sqrt(size / first) if first > 0.0 else 0.0
