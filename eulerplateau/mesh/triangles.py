"""What a triangle of any surface is asked for: edges, neighbours, areas, angles."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray, cross


def directed_edges(triangles: IntArray) -> IntArray:
    """Return the directed edges (3 n_t, 2); edge j of triangle t is row 3 t + j."""
    return triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)


def joints(triangles: IntArray) -> tuple[IntArray, IntArray]:
    """Return the rows of `directed_edges` that are the same edge, one and the other.

    Of edges that belong to two triangles; (n,) each.
    """
    ends = np.sort(directed_edges(triangles), axis=1)
    order = np.lexsort(ends.T)
    _, begin, count = np.unique(ends[order], axis=0, return_index=True, return_counts=True)
    pair = begin[count == 2]
    return order[pair], order[pair + 1]


def area_vectors(triangles: IntArray, x: FloatArray) -> FloatArray:
    """Return (n_t, 3) the area of each triangle times its unit normal."""
    a, b, c = x[triangles].transpose(1, 0, 2)
    return 0.5 * cross(b - a, c - a)


def corner_angles(corner: FloatArray, vectors: FloatArray) -> FloatArray:
    """Return the angles (n_t, 3) in [0, pi] at the corners (n_t, 3, 3) of triangles.

    vectors : (n_t, 3) float, their `area_vectors`
    """
    ahead = np.concatenate([corner[:, 1:], corner[:, :1]], axis=1) - corner
    back = np.concatenate([ahead[:, 2:], ahead[:, :2]], axis=1)
    doubled = 2.0 * np.linalg.norm(vectors, axis=1)
    # The way back from a corner is the way ahead from the one before it.
    turns = -np.einsum("tki,tki->tk", ahead, back)
    angles: FloatArray = np.arctan2(doubled[:, None], turns)
    return angles


def unit(vectors: FloatArray) -> FloatArray:
    """Return `vectors` (..., 3) scaled to length 1; zero vectors stay zero."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(lengths > 0.0, lengths, 1.0)


def smallest_angle(edges: FloatArray, areas: FloatArray) -> float:
    """Return the smallest angle of all triangles, degrees: 60 at best.

    Parameters
    ----------
    edges : (n_t, 3, d) float
        The sides of each triangle, in any order.
    areas : (n_t,) float
        Their areas: 0 gives an angle of 0, a negative one, of a plane triangle that has
        turned over, a negative angle.
    """
    # Opposite the shortest side, so acute.
    length = np.sort(np.linalg.norm(edges, axis=2), axis=1)
    span = length[:, 1] * length[:, 2]
    sine = np.divide(2 * areas, span, out=np.zeros_like(span), where=span > 0)
    return float(np.degrees(np.arcsin(np.clip(sine, -1.0, 1.0)).min()))


def cotangents(edges: FloatArray, areas: FloatArray) -> FloatArray:
    """Return the cotangents (n_t, 3) of the angles at the corners; 0 without an area.

    Parameters
    ----------
    edges : (n_t, 3, d) float
        The sides of each triangle, head to tail; side j lies opposite corner j.
    areas : (n_t,) float
        Their areas. One for all three corners: its rounding in a sliver then scales the
        sliver's Dirichlet energy and cannot make it indefinite.
    """
    dots = -(np.roll(edges, -1, axis=1) * np.roll(edges, 1, axis=1)).sum(axis=2)
    doubled = 2 * areas[:, None]
    found: FloatArray = np.divide(dots, doubled, out=np.zeros_like(dots), where=doubled > 0)
    return found


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
