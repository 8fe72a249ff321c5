"""A plane mesh that follows its loop: where its vertices lie is no part of its state."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film.area import AreaFilm
from eulerplateau.film.follow_kernels import smallest_angle, spread_inside
from eulerplateau.film.interior import THIN
from eulerplateau.film.plane import PlaneFilm
from eulerplateau.film.repair import carried, repaired

# With fewer vertices inside, per vertex of the loop, no mesh has good triangles along it.
_FEW = 0.25
# In how many steps a mesh follows: in more where triangles have become thin, or folded.
_STEPS = (1, 4)
# Part of the forces that may be left when vertices stop, and when they stop in any case.
_SMALL = 1e-2
_LIMIT = 500
# A repair ends at this many times the angle that makes it necessary.
_REPAIRED = 1.5


def carried_in_plane(
    film: PlaneFilm, x: FloatArray, polygon: FloatArray, spanned: bool
) -> tuple[AreaFilm, FloatArray]:
    """Return the triangles, and the flat shape (n_v, 3) after its loop has moved.

    x : (n_v, 3); polygon : (n_b, 2), where the loop has moved to. Repaired where triangles
    have become thin, unless no disk is `spanned`, or the mesh has so few vertices inside
    that they are thin in any case.
    """
    soap = film.soap
    start = np.ascontiguousarray(x @ film.axes.T)
    mendable = spanned and len(soap.interior) >= _FEW * len(soap.loop)
    best, angle = start, -np.inf
    for steps in _STEPS if mendable else _STEPS[:1]:
        flat = _followed(soap, start, polygon, steps)
        reached = np.degrees(smallest_angle(flat, soap.triangles))
        if reached > angle:
            best, angle = flat, reached
        if reached >= THIN:
            break
    if mendable and not angle > 0.0:
        return carried(soap, film.flattened(x), polygon @ film.axes)
    moved = best @ film.axes
    if mendable and angle < THIN:
        return repaired(soap, moved, _REPAIRED * THIN)
    return soap, moved


def _followed(
    soap: AreaFilm, start: FloatArray, polygon: FloatArray, steps: int
) -> FloatArray:
    """Return the vertices (n_v, 2) after their loop has moved in so many equal steps."""
    x = start
    for left in range(steps, 0, -1):
        move = np.zeros_like(x)
        move[soap.loop] = (polygon - x[soap.loop]) / left
        spread_inside(x, soap.triangles, soap.interior, move, _SMALL, _LIMIT)
        x = x + move
    x[soap.loop] = polygon
    return x
