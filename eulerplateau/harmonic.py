"""A film that follows its loop: values inside harmonic on a shape, given on the loop.

With the cotangent matrix of the shape, L x = 0 at every interior vertex; on a film at rest
that holds for its own positions (Pinkall and Polthier 1993).
"""

from __future__ import annotations

import numpy as np

from eulerplateau.area_film import AreaFilm, Sides
from eulerplateau.condensation import factorise
from eulerplateau.mesh import FloatArray


def harmonic(film: AreaFilm, sides: Sides, values: FloatArray) -> FloatArray:
    """Return the values (n_i, m) inside that are harmonic on a shape, given on the loop."""
    if len(film.interior) == 0:
        return np.zeros((0, values.shape[1]))
    rows = film.cotangent_laplacian(sides)[film.interior]
    inside = factorise(rows[:, film.interior], film.pieces)
    return -inside.solve(rows[:, film.loop] @ values)


def moved_with(film: AreaFilm, x: FloatArray, x_loop: FloatArray) -> FloatArray:
    """Return the shape x (n_v, 3) after its loop has moved to x_loop (n_b, 3)."""
    moved = x_loop - x[film.loop]
    after = x.copy()
    after[film.loop] = x_loop
    if moved.any():
        after[film.interior] += harmonic(film, film.sides(x), moved)
    return after


def balance(film: AreaFilm, x: FloatArray) -> FloatArray:
    """Return the forces (n_v, 3) of unit tension that do work in the chart at x (n_v, 3).

    Inside the part of the area's gradient along the normal; on the loop f = T^T g. Both
    are independent of the path by which a film came to x.
    """
    sides = film.sides(x)
    gradient = film.gradient(sides)
    forces = np.zeros_like(x)
    inside = film.interior
    normals = film.vertex_normals(sides)[inside]
    heights = (gradient[inside] * normals).sum(axis=1)
    forces[inside] = heights[:, None] * normals
    forces[film.loop] = gradient[film.loop]
    if len(inside):
        rows = film.cotangent_laplacian(sides)[inside]
        share = factorise(rows[:, inside], film.pieces).solve(gradient[inside])
        forces[film.loop] -= rows[:, film.loop].T @ share
    return forces
