"""Discrete minimal surfaces: films whose area no displacement of a vertex inside changes.

Along its normals a film comes to rest in a chart (chart.py). What then remains of the
area's gradient lies in the film: the area of triangles depends, weakly, on where their
vertices lie. On a curved film it is least for certain places, denser where it is more
curved, and certain triangles. They are found here: by Newton's method on all coordinates
inside, the Hessian shifted until it is positive definite, and by flips to Delaunay's
triangles, without which some collapse.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.film.area import AreaFilm
from eulerplateau.film.free_moves import ROUNDING, Free, smaller
from eulerplateau.film.repair import flipped

_STEPS = 300
# The first stiffness against sliding.
_SHIFT = 1e-5
# Sine of the tilt up to which triangles count as flat: sliding then costs nothing.
_FLAT = 1e-6
# Degrees: thinner triangles are on their way to vanish.
_VANISHING = 5.0


def is_flat(film: AreaFilm, x: FloatArray) -> bool:
    """Return whether a film (n_v, 3) lies in a plane."""
    normals = film.sides(x).normals
    tilted = np.cross(normals, normals.mean(axis=0))
    return float(np.abs(tilted).max(initial=0.0)) < _FLAT


def minimal(film: AreaFilm, x: FloatArray) -> tuple[AreaFilm, FloatArray] | None:
    """Return the discrete minimal surface near a film (n_v, 3) on the same loop.

    With Delaunay's triangles; None where there is none but with vanishing triangles.
    """
    film = flipped(film, x)
    free, shift = Free(film), _SHIFT
    for _ in range(_STEPS):
        sides = film.sides(x)
        if sides.smallest_angle < _VANISHING:
            return None
        force = free.work(film.gradient(sides))
        error = float(np.abs(force).max(initial=0.0))
        if error <= ROUNDING * float(np.abs(sides.edges).max()):
            return film, x
        try:
            x, shift = smaller(free, x, sides, force, shift)
        except LinAlgError:
            return None
        better = flipped(film, x)
        if better is not film:
            film, free = better, Free(better)
    return None
