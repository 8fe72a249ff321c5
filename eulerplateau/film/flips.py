"""Delaunay's triangles on the vertices of a film, by flips of its edges."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film.flip_kernels import flip_to_delaunay
from eulerplateau.film.tiling import Tiling


def delaunay_flips(tiling: Tiling, x: FloatArray) -> Tiling:
    """Return the film with Delaunay's triangles on the vertices x (n_v, 3)."""
    triangles = tiling.triangles.copy()
    flips = flip_to_delaunay(np.ascontiguousarray(x), triangles, tiling.neighbours.copy())
    return tiling.with_triangles(triangles) if flips else tiling
