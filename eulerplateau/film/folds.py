"""Films that lie in folds: found by their normals, and laid anew across their loop.

Triangles that fold over count with their area although they span nothing: a folded film
can rest, every force balanced, on a mesh that no smooth film has. Where the vertices lie
inside is no part of a soap film's state, so they are laid anew.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.film import area_kernels
from eulerplateau.film.condensation import factorise
from eulerplateau.film.repair import mend_triangles
from eulerplateau.film.tiling import Tiling

# Cosine between the normals of two neighbours that lie on each other rather than side by
# side. A smooth film turns by less from triangle to triangle, however coarse.
_ON_EACH_OTHER = -0.5
# Triangles of less than this part of the area have no normal to speak of.
_NO_AREA = 1e-12
# How Dirichlet's energy of three equal triangles, whatever their shape, couples corners.
_EQUAL = np.array([[1.0, -0.5, -0.5], [-0.5, 1.0, -0.5], [-0.5, -0.5, 1.0]])


def is_folded(tiling: Tiling, x: FloatArray) -> bool:
    """Return whether neighbouring triangles of a film (n_v, 3) lie on each other."""
    sides = tiling.sides(x)
    least, cosine = _NO_AREA * float(sides.areas.sum()), _ON_EACH_OTHER
    triangles = sides.normals, sides.areas, tiling.neighbours
    return area_kernels.lie_on_each_other(*triangles, cosine, least)


def laid_anew(tiling: Tiling, x: FloatArray) -> tuple[Tiling, FloatArray]:
    """Return a film without folds on the loop of a folded one (n_v, 3), if there is one.

    Each vertex inside lies in the middle of its neighbours: across a plane convex loop that
    has no folds (Tutte 1963), across others thin triangles are mended. Where folds are
    left, the film as it was.
    """
    blocks = np.broadcast_to(_EQUAL, (len(tiling.triangles), 3, 3))
    try:
        even = factorise(tiling.elimination, tiling.filled(blocks))
    except LinAlgError:  # vertices inside that nothing joins to the loop
        return tiling, x
    flat = even.extend(x[tiling.loop])
    for found in ((tiling, flat), mend_triangles(tiling, flat)):
        if not is_folded(*found):
            return found
    return tiling, x
