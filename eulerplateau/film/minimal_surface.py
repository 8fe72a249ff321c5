"""Discrete minimal surfaces: films whose area no displacement of a vertex inside changes.

A film whose vertices have come to rest along their normals (interior.py) has a gradient of
the area left that lies in the film: the area of triangles depends, weakly, on where their
vertices lie. On a curved film it is least for certain places, denser where it is more
curved, and certain triangles. They are found here: by Newton's method on all coordinates
inside, the Hessian shifted until it is positive definite, and by flips to Delaunay's
triangles, without which some collapse.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray, cross
from eulerplateau.film.flips import delaunay_flips
from eulerplateau.film.free_moves import ROUNDING, FreeInterior, smaller
from eulerplateau.film.tiling import LIMITS, Tiling

_STEPS = 300
# The first stiffness against sliding.
_SHIFT = 1e-5
# Sine of the tilt up to which triangles count as flat: sliding then costs nothing.
_FLAT = 1e-6


def is_flat(tiling: Tiling, x: FloatArray) -> bool:
    """Return whether a film (n_v, 3) lies in a plane."""
    normals = tiling.sides(x).normals
    tilted = cross(normals, normals.mean(axis=0))
    return float(np.abs(tilted).max(initial=0.0)) < _FLAT


def find_minimal_surface(tiling: Tiling, x: FloatArray) -> tuple[Tiling, FloatArray] | None:
    """Return the discrete minimal surface near a film (n_v, 3) on the same loop.

    With Delaunay's triangles; None where there is none but with vanishing triangles.
    """
    tiling = delaunay_flips(tiling, x)
    free, shift = FreeInterior(tiling), _SHIFT
    for _ in range(_STEPS):
        sides = tiling.sides(x)
        if sides.smallest_angle < LIMITS.vanishing:
            return None
        force = free.work(tiling.gradient(sides))
        error = float(np.abs(force).max(initial=0.0))
        if error <= ROUNDING * float(np.abs(sides.edges).max()):
            return tiling, x
        try:
            x, shift = smaller(free, x, sides, force, shift)
        except LinAlgError:
            return None
        better = delaunay_flips(tiling, x)
        if better is not tiling:
            tiling, free = better, FreeInterior(better)
    return None
