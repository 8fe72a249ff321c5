"""Where a film comes against the rod it hangs on, or against itself.

The rod is a tube round the loop. Of the places (s, p), s along the loop and p on the film,
that are nearer to each other than the tube is thick, those that hang together with
(s, gamma(s)) are where the film is attached. Any others are contact.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray, IntArray
from eulerplateau.compiling import njit
from eulerplateau.mesh.crossings import self_intersections
from eulerplateau.mesh.graphs import components
from eulerplateau.mesh.shape import Shape
from eulerplateau.mesh.triangles import neighbours

# Distances below this, in parts of the film's extent, are none.
_ROUNDING = 1e-12


def film_touches(shape: Shape, radius: float) -> bool:
    """Return whether a film passes through itself, or comes against a rod so thick.

    The rod is taken thinner by what its curve may leave the loop's edges by: on a coarse
    mesh contact is found later than it begins.

    Parameters
    ----------
    shape : the film, in any unit
    radius : of the rod, in the same
    """
    if self_intersections(shape.x, shape.triangles):
        return True
    x, loop = np.ascontiguousarray(shape.x), shape.loop
    chords = np.roll(x[loop], -1, axis=0) - x[loop]
    # An edge of length h is kappa h^2 / 8 from its curve, kappa h^2 the turn of chords.
    turns = np.linalg.norm(chords - np.roll(chords, 1, axis=0), axis=1)
    reach = radius - np.maximum(turns, np.roll(turns, -1)) / 8
    least = _ROUNDING * float(np.ptp(x, axis=0).max())
    near = _near(x, shape.triangles, loop, np.maximum(reach, least))
    return _pieces(near, neighbours(shape.triangles)) > 1


def _pieces(near: BoolArray, beyond: IntArray) -> int:
    """Return how many pieces pairs of edges and triangles (n_b, n_t) that are near have.

    Pairs hang together with the same edge and triangles side by side, and with the same
    triangle and edges behind each other.
    """
    number = np.full(near.shape, -1)
    edges, triangles = np.nonzero(near)
    count = len(edges)
    number[edges, triangles] = np.arange(count)
    following = number[(edges + 1) % len(near), triangles]
    sides = np.where(beyond[triangles] >= 0, number[edges[:, None], beyond[triangles]], -1)
    others = np.column_stack([following, sides])
    one = np.broadcast_to(np.arange(count)[:, None], others.shape)[others >= 0]
    return int(components(one, others[others >= 0], count).max(initial=-1)) + 1


@njit(cache=True)
def _near(
    x: FloatArray, triangles: IntArray, loop: IntArray, reach: FloatArray
) -> BoolArray:
    """Return which edges of the loop and triangles are within reach (n_b, n_t)."""
    n_b, n_t = loop.shape[0], triangles.shape[0]
    found = np.zeros((n_b, n_t), dtype=np.bool_)
    corners, low, high = np.empty((3, 3)), np.empty(3), np.empty(3)
    for t in range(n_t):
        for k in range(3):
            for i in range(3):
                corners[i, k] = x[triangles[t, i], k]
            low[k] = min(corners[0, k], corners[1, k], corners[2, k])
            high[k] = max(corners[0, k], corners[1, k], corners[2, k])
        for e in range(n_b):
            v, w = loop[e], loop[(e + 1) % n_b]
            if _box_is_near(low, high, x, v, w, reach[e]):
                apart = _distance(corners, _row(x, v), _row(x, w))
                found[e, t] = apart <= reach[e]
    return found


@njit(cache=True)
def _box_is_near(
    low: FloatArray, high: FloatArray, x: FloatArray, v: int, w: int, reach: float
) -> bool:
    """Whether the box round an edge v w, wider by reach, meets the box low to high."""
    for k in range(3):
        if min(x[v, k], x[w, k]) - reach > high[k]:
            return False
        if max(x[v, k], x[w, k]) + reach < low[k]:
            return False
    return True


# Triples of numbers, not arrays: numba compiles those several times as fast.
Vector = tuple[float, float, float]


@njit(cache=True)
def _row(x: FloatArray, i: int) -> Vector:
    return x[i, 0], x[i, 1], x[i, 2]


@njit(cache=True)
def _sum(a: Vector, factor: float, b: Vector) -> Vector:
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]


@njit(cache=True)
def _dot(a: Vector, b: Vector) -> float:
    product: float = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return product


@njit(cache=True)
def _cross(a: Vector, b: Vector) -> Vector:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@njit(cache=True)
def _distance(corners: FloatArray, p: Vector, q: Vector) -> float:
    """Return the distance of a triangle (3, 3) from an edge p q (Ericson 2005, 5.1)."""
    if _through(corners, p, q):
        return 0.0
    least = min(_over(corners, p), _over(corners, q))
    for i in range(3):
        a, b = _row(corners, i), _row(corners, (i + 1) % 3)
        least = min(least, _of_edges(a, b, p, q))
    return least


@njit(cache=True)
def _side(corners: FloatArray, i: int) -> Vector:
    return _sum(_row(corners, (i + 1) % 3), -1.0, _row(corners, i))


@njit(cache=True)
def _normal(corners: FloatArray) -> Vector:
    return _cross(_side(corners, 0), _sum(_row(corners, 2), -1.0, _row(corners, 0)))


@njit(cache=True)
def _inside(corners: FloatArray, normal: Vector, point: Vector) -> bool:
    """Whether a point lies over a triangle."""
    for i in range(3):
        beyond = _cross(_side(corners, i), _sum(point, -1.0, _row(corners, i)))
        if _dot(beyond, normal) < 0.0:
            return False
    return True


@njit(cache=True)
def _through(corners: FloatArray, p: Vector, q: Vector) -> bool:
    """Whether an edge p q passes through a triangle."""
    normal, first = _normal(corners), _row(corners, 0)
    above = _dot(_sum(p, -1.0, first), normal)
    below = _dot(_sum(q, -1.0, first), normal)
    if above * below >= 0.0:
        return False
    return _inside(corners, normal, _sum(p, above / (above - below), _sum(q, -1.0, p)))


@njit(cache=True)
def _over(corners: FloatArray, point: Vector) -> float:
    """Return how high a point lies over a triangle; infinite if it is not over it."""
    normal = _normal(corners)
    length = np.sqrt(_dot(normal, normal))
    if length == 0.0 or not _inside(corners, normal, point):
        return np.inf
    return float(abs(_dot(_sum(point, -1.0, _row(corners, 0)), normal)) / length)


@njit(cache=True)
def _of_edges(a: Vector, b: Vector, p: Vector, q: Vector) -> float:
    """Return the distance of two edges a b and p q."""
    u, v, w = _sum(b, -1.0, a), _sum(q, -1.0, p), _sum(a, -1.0, p)
    uu, uv, vv = _dot(u, u), _dot(u, v), _dot(v, v)
    uw, vw = _dot(u, w), _dot(v, w)
    determinant = uu * vv - uv * uv
    s = 0.5
    if determinant > 1e-12 * uu * vv:
        s = min(max((uv * vw - vv * uw) / determinant, 0.0), 1.0)
    t = min(max((uv * s + vw) / vv, 0.0), 1.0)
    s = min(max((uv * t - uw) / uu, 0.0), 1.0)
    apart = _sum(_sum(w, s, u), -t, v)
    return float(np.sqrt(_dot(apart, apart)))
