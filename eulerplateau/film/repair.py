"""Good triangles for a soap film: flips and sliding, the loop and the surface kept.

Where the vertices of a film lie on it is no part of its state: its energy depends on the
loop, and on the mesh only by its error. So edges may be flipped and vertices slid whenever
triangles have become thin.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film.flips import delaunay_flips
from eulerplateau.film.harmonic import follow_loop
from eulerplateau.film.tiling import LIMITS, Tiling

_ROUNDS = 40
# Degrees: a worst angle that is gained no more ends the repair.
_GAIN = 0.05


def carry_along(
    tiling: Tiling, x: FloatArray, x_loop: FloatArray, halvings: int = 8
) -> tuple[Tiling, FloatArray]:
    """Return the film and its shape (n_v, 3) after its loop has moved to x_loop (n_b, 3).

    In steps short enough that no triangle folds over, with a repair where they get thin.
    """
    before, after = tiling.sides(x), follow_loop(tiling, x, x_loop)
    standing = tiling.standing(after, before.normals, LIMITS.carried)
    if standing is None and halvings:
        middle = 0.5 * (x[tiling.loop] + x_loop)
        tiling, x = carry_along(tiling, x, middle, halvings - 1)
        return carry_along(tiling, x, x_loop, halvings - 1)
    moved = tiling.sides(after) if standing is None else standing[0]
    thin = moved.smallest_angle < LIMITS.thin
    return mend_triangles(tiling, after) if thin else (tiling, after)


def mend_triangles(
    tiling: Tiling, x: FloatArray, enough: float = np.inf
) -> tuple[Tiling, FloatArray]:
    """Return the film with other triangles and its shape (n_v, 3), the loop untouched.

    The best found, or the first whose worst angle is `enough` (degrees): never a smaller
    worst angle than before.
    """
    best = tiling, x
    angle = tiling.sides(x).smallest_angle
    idle = 0
    for _ in range(_ROUNDS):
        tiling = delaunay_flips(tiling, x)
        x = _slid(tiling, x)
        reached = tiling.sides(x).smallest_angle
        idle = 0 if reached > angle + _GAIN else idle + 1
        if reached > angle:
            best, angle = (tiling, x), reached
        if idle > 5 or angle > enough:
            break
    return best


def _slid(tiling: Tiling, x: FloatArray) -> FloatArray:
    """Return the shape with vertices slid towards the middle of their triangles."""
    sides = tiling.sides(x)
    middle = x[tiling.triangles].mean(axis=1) * sides.areas[:, None]
    total = tiling.gather(np.repeat(middle[:, None], 3, axis=1))
    weight = tiling.gather(np.broadcast_to(sides.areas[:, None, None], (len(middle), 3, 3)))
    normals = tiling.vertex_normals(sides)
    # Where all triangles around a vertex have collapsed, there is nowhere to slide to.
    step = np.divide(total, weight, out=x.copy(), where=weight > 0) - x
    step -= (step * normals).sum(axis=1)[:, None] * normals
    step[tiling.loop] = 0.0
    for _ in range(30):
        after = tiling.sides(x + step)
        turned = (after.normals * sides.normals).sum(axis=1)
        spoilt = (after.areas < LIMITS.area_kept * sides.areas) | (
            turned < LIMITS.normal_kept
        )
        if not spoilt.any():
            return x + step
        step[tiling.triangles[spoilt].ravel()] *= 0.5
    return x
