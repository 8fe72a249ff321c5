"""A film that follows its loop: values inside harmonic on a shape, given on the loop.

With the cotangent matrix of the shape, L x = 0 at every interior vertex; on a film at rest
that holds for its own positions (Pinkall and Polthier 1993).
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film.condensation import Condensation, factorise
from eulerplateau.film.tiling import Tiling, TriangleGeometry


def follower(tiling: Tiling, sides: TriangleGeometry) -> Condensation:
    """Return what extends values on the loop to those harmonic inside, on a shape.

    Its `carry` takes forces to the loop. LinAlgError where the shape is too degenerate.
    """
    return factorise(tiling.elimination, tiling.cotangent_laplacian(sides).data)


def follow_loop(tiling: Tiling, x: FloatArray, x_loop: FloatArray) -> FloatArray:
    """Return the shape x (n_v, 3) after its loop has moved to x_loop (n_b, 3)."""
    moved = x_loop - x[tiling.loop]
    after = x.copy()
    if moved.any():
        after += follower(tiling, tiling.sides(x)).extend(moved)
        after[tiling.loop] = x_loop
    return after


def balance(tiling: Tiling, x: FloatArray) -> FloatArray:
    """Return the forces (n_v, 3) of unit tension that do work near x (n_v, 3).

    Inside the part of the area's gradient along the normal; on the loop f = T^T g. Both
    are independent of the path by which a film came to x.
    """
    sides = tiling.sides(x)
    gradient = tiling.gradient(sides)
    forces = np.zeros_like(x)
    inside = tiling.interior
    normals = tiling.vertex_normals(sides)[inside]
    heights = (gradient[inside] * normals).sum(axis=1)
    forces[inside] = heights[:, None] * normals
    forces[tiling.loop] = follower(tiling, sides).carry(gradient)
    return forces
