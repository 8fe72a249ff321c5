"""Compiled loops of a plane mesh that follows its loop. Arrays in, arrays out.

Helpers stay in this file (numba #1833).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from eulerplateau.arrays import FloatArray, IntArray


@njit(cache=True, error_model="numpy")
def smallest_angle(x: FloatArray, triangles: IntArray) -> float:
    """Return the smallest angle, in radians, of triangles of x (n_v, 2).

    Of a triangle that has turned over the angles are negative.
    """
    smallest = np.pi
    for t in range(len(triangles)):
        for j in range(3):
            i, k, m = triangles[t, j], triangles[t, (j + 1) % 3], triangles[t, (j + 2) % 3]
            px, py = x[k, 0] - x[i, 0], x[k, 1] - x[i, 1]
            qx, qy = x[m, 0] - x[i, 0], x[m, 1] - x[i, 1]
            smallest = min(smallest, np.arctan2(px * qy - py * qx, px * qx + py * qy))
    return smallest


@njit(cache=True, error_model="numpy")
def _cotangents(x: FloatArray, triangles: IntArray, weights: FloatArray) -> None:
    """Fill weights (n_t, 3) with each corner's cotangent; 0 without an area."""
    for t in range(len(triangles)):
        for j in range(3):
            i, k, m = triangles[t, j], triangles[t, (j + 1) % 3], triangles[t, (j + 2) % 3]
            px, py = x[k, 0] - x[i, 0], x[k, 1] - x[i, 1]
            qx, qy = x[m, 0] - x[i, 0], x[m, 1] - x[i, 1]
            across = abs(px * qy - py * qx)
            weights[t, j] = (px * qx + py * qy) / across if across > 0.0 else 0.0


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
    x: FloatArray,
    triangles: IntArray,
    interior: IntArray,
    move: FloatArray,
    small: float,
    limit: int,
) -> float:
    """Fill the interior of move (n_v, 2), given on the loop, with its harmonic extension.

    That of the shape x (n_v, 2), by conjugate gradients on both coordinates at once, scaled
    by the diagonal; at most `limit` of them, until what is left of the forces has fallen to
    `small` times what it was. Returns by how much it has.
    """
    weights, pull = np.empty((len(triangles), 3)), np.empty((len(x), 2))
    diagonal, rest = np.zeros(len(x)), np.zeros((len(x), 2))
    way = np.zeros((len(x), 2))
    _cotangents(x, triangles, weights)
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
