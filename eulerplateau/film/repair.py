"""Good triangles for a soap film: flips and sliding, the loop and the surface kept.

Where the vertices of a film lie on it is no part of its state: its energy depends on the
loop, and on the mesh only by its error. So edges may be flipped and vertices slid whenever
triangles have become thin.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film.area import AreaFilm
from eulerplateau.film.flip_kernels import flip_to_delaunay
from eulerplateau.film.harmonic import moved_with
from eulerplateau.film.interior import THIN
from eulerplateau.mesh import neighbours

_ROUNDS = 40
# A vertex slides as far towards its neighbours' middle as leaves every triangle at least
# this part of its area and this cosine to its normal.
_AREA_KEPT = 0.3
_NORMAL_KEPT = 0.8
# Cosine by which a triangle may turn in one step of its loop.
_NOT_FOLDED = 0.5
# Degrees: a worst angle that is gained no more ends the repair.
_GAIN = 0.05


def carried(
    film: AreaFilm, x: FloatArray, x_loop: FloatArray, halvings: int = 8
) -> tuple[AreaFilm, FloatArray]:
    """Return the film and its shape (n_v, 3) after its loop has moved to x_loop (n_b, 3).

    In steps short enough that no triangle folds over, with a repair where they get thin.
    """
    before, after = film.sides(x), moved_with(film, x, x_loop)
    moved = film.sides(after)
    turned = (before.normals * moved.normals).sum(axis=1)
    sound = bool((moved.areas > 0).all() and (turned > _NOT_FOLDED).all())
    if not sound and halvings:
        middle = 0.5 * (x[film.loop] + x_loop)
        film, x = carried(film, x, middle, halvings - 1)
        return carried(film, x, x_loop, halvings - 1)
    return repaired(film, after) if moved.smallest_angle < THIN else (film, after)


def repaired(
    film: AreaFilm, x: FloatArray, enough: float = np.inf
) -> tuple[AreaFilm, FloatArray]:
    """Return the film with other triangles and its shape (n_v, 3), the loop untouched.

    The best found, or the first whose worst angle is `enough` (degrees): never a smaller
    worst angle than before.
    """
    best = film, x
    angle = film.sides(x).smallest_angle
    idle = 0
    for _ in range(_ROUNDS):
        film = flipped(film, x)
        x = _slid(film, x)
        reached = film.sides(x).smallest_angle
        idle = 0 if reached > angle + _GAIN else idle + 1
        if reached > angle:
            best, angle = (film, x), reached
        if idle > 5 or angle > enough:
            break
    return best


def flipped(film: AreaFilm, x: FloatArray) -> AreaFilm:
    """Return the film with Delaunay's triangles on the vertices x (n_v, 3)."""
    triangles = film.triangles.copy()
    flips = flip_to_delaunay(np.ascontiguousarray(x), triangles, neighbours(triangles))
    return film.retiled(triangles) if flips else film


def _slid(film: AreaFilm, x: FloatArray) -> FloatArray:
    """Return the shape with vertices slid towards the middle of their triangles."""
    sides = film.sides(x)
    middle = x[film.triangles].mean(axis=1) * sides.areas[:, None]
    total = film.gather(np.repeat(middle[:, None], 3, axis=1))
    weight = film.gather(np.broadcast_to(sides.areas[:, None, None], (len(middle), 3, 3)))
    normals = film.vertex_normals(sides)
    # Where all triangles around a vertex have collapsed, there is nowhere to slide to.
    step = np.divide(total, weight, out=x.copy(), where=weight > 0) - x
    step -= (step * normals).sum(axis=1)[:, None] * normals
    step[film.loop] = 0.0
    for _ in range(30):
        after = film.sides(x + step)
        turned = (after.normals * sides.normals).sum(axis=1)
        spoilt = (after.areas < _AREA_KEPT * sides.areas) | (turned < _NORMAL_KEPT)
        if not spoilt.any():
            return x + step
        step[film.triangles[spoilt].ravel()] *= 0.5
    return x
