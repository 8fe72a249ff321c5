"""Triangles of any surface: their edges, neighbours, areas and angles."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray


def directed_edges(triangles: IntArray) -> IntArray:
    """Return the directed edges (3 n_t, 2); edge j of triangle t is row 3 t + j."""
    return triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)


def area_vectors(triangles: IntArray, x: FloatArray) -> FloatArray:
    """Return (n_t, 3) the area of each triangle times its unit normal."""
    a, b, c = x[triangles].transpose(1, 0, 2)
    return 0.5 * np.cross(b - a, c - a)


def unit(vectors: FloatArray) -> FloatArray:
    """Return `vectors` (..., 3) scaled to length 1; zero vectors stay zero."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(lengths > 0.0, lengths, 1.0)


def smallest_angle(edges: FloatArray, areas: FloatArray) -> float:
    """Return the smallest angle of triangles with sides (n_t, 3, 3), degrees.

    60 at best, 0 for a triangle without area.
    """
    # Opposite the shortest side, so acute.
    length = np.sort(np.linalg.norm(edges, axis=2), axis=1)
    span = length[:, 1] * length[:, 2]
    sine = np.divide(2 * areas, span, out=np.zeros_like(span), where=span > 0)
    return float(np.degrees(np.arcsin(np.minimum(sine, 1.0)).min()))


def neighbours(triangles: IntArray) -> IntArray:
    """Return the triangle (n_t, 3) beyond the side opposite each corner, -1 at the loop."""
    n_v = int(triangles.max()) + 1
    half = directed_edges(triangles)
    # Row 3 t + j of the edges leaves corner j: it lies opposite corner j + 2.
    there, back = half @ (n_v, 1), half[:, ::-1] @ (n_v, 1)
    order = np.argsort(there)
    place = np.minimum(np.searchsorted(there[order], back), len(order) - 1)
    found = np.where(there[order][place] == back, order[place] // 3, -1)
    beyond: IntArray = np.roll(found.reshape(-1, 3), -1, axis=1)
    return np.ascontiguousarray(beyond)
