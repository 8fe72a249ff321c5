"""A plane mesh that follows its loop: where its vertices lie is no part of its state."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film.follow_kernels import spread_inside
from eulerplateau.film.repair import carry_along, mend_triangles
from eulerplateau.film.tiling import LIMITS, Tiling
from eulerplateau.loop import strands_meet
from eulerplateau.mesh import cotangents, smallest_angle

# With fewer vertices inside, per vertex of the loop, no mesh has good triangles along it.
_FEW = 0.25
# In how many steps a mesh follows: in more where triangles have become thin, or folded.
_STEPS = (1, 4)
# Part of the forces that may be left when vertices stop, and when they stop in any case.
_SMALL = 1e-2
_LIMIT = 500
# A repair ends at this many times the angle that makes it necessary.
_REPAIRED = 1.5


def carry_in_plane(
    tiling: Tiling, x: FloatArray, polygon: FloatArray, axes: FloatArray
) -> tuple[Tiling, FloatArray]:
    """Return the triangles, and the flat shape (n_v, 3) after its loop has moved.

    Triangles are repaired where they have become thin, unless strands of the loop meet, so
    that no disk is spanned, or the mesh has so few vertices inside that they are thin in
    any case.

    Parameters
    ----------
    x : (n_v, 3) float, in the plane through the origin along `axes`
    polygon : (n_b, 2) float, where the loop has moved to
    axes : (2, 3) float, orthonormal
    """
    start = np.ascontiguousarray(x @ axes.T)
    mendable = not is_sparse(tiling) and not strands_meet(polygon)
    best, angle = start, -np.inf
    for steps in _STEPS if mendable else _STEPS[:1]:
        flat = _followed(tiling, start, polygon, steps)
        reached = smallest_angle(*_sides(tiling, flat))
        if reached > angle:
            best, angle = flat, reached
        if reached >= LIMITS.thin:
            break
    if mendable and not angle > 0.0:
        return carry_along(tiling, x @ axes.T @ axes, polygon @ axes)
    moved = best @ axes
    if mendable and angle < LIMITS.thin:
        return mend_triangles(tiling, moved, _REPAIRED * LIMITS.thin)
    return tiling, moved


def is_sparse(tiling: Tiling) -> bool:
    """Return whether a mesh has too few vertices inside for good triangles."""
    return len(tiling.interior) < _FEW * len(tiling.loop)


def _followed(
    tiling: Tiling, start: FloatArray, polygon: FloatArray, steps: int
) -> FloatArray:
    """Return the vertices (n_v, 2) after their loop has moved in so many equal steps."""
    x = start
    for left in range(steps, 0, -1):
        move = np.zeros_like(x)
        move[tiling.loop] = (polygon - x[tiling.loop]) / left
        edges, areas = _sides(tiling, x)
        weights = cotangents(edges, np.abs(areas))
        spread_inside(tiling.triangles, weights, tiling.interior, move, _SMALL, _LIMIT)
        x = x + move
    x[tiling.loop] = polygon
    return x


def _sides(tiling: Tiling, x: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the triangles' sides (n_t, 3, 2) and areas (n_t,), < 0 where turned over."""
    corners = x[tiling.triangles]
    edges = np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1)
    (a, b), (c, d) = edges[:, 0].T, edges[:, 1].T
    return edges, 0.5 * (a * d - b * c)
