"""VTK's kinds of cells: which are polygons, and which of their points are corners."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh.readers.content import Content, ForeignError, polygons, strips

# Points and lines, straight or curved: no part of the surface.
_LOWER = {0, 1, 2, 3, 4, 21, 35, 68, 75}
_STRIP, _PIXEL, _QUADRATIC_POLYGON = 6, 8, 36
_POLYGONS = {5, 7, 9}
# Curved ones, with their numbers of corners, which come first.
_CURVED = {22: 3, 34: 3, 69: 3, 76: 3, 23: 4, 28: 4, 30: 4, 70: 4, 77: 4}
_SOLIDS = {10: "tetrahedra", 11: "voxels", 12: "hexahedra", 13: "wedges", 14: "pyramids"}


def of_cells(
    points: FloatArray, corners: IntArray, ends: IntArray, kinds: IntArray
) -> Content:
    """Return the polygons among cells; raises ForeignError where there are solid ones.

    Parameters
    ----------
    points : (n, 3) float
    corners : (m,) int, the points of all cells, one cell after the other
    ends : (n_c,) int, where each cell ends in `corners`
    kinds : (n_c,) int, VTK's numbers of their kinds
    """
    other = set(kinds.tolist()) - _LOWER - _POLYGONS - _CURVED.keys()
    for kind in sorted(other - {_STRIP, _PIXEL, _QUADRATIC_POLYGON}):
        name = _SOLIDS.get(kind, f"cells of VTK's type {kind}")
        raise ForeignError(f"holds {name}; a film is a surface of triangles")
    sizes = np.diff(ends, prepend=0)
    if (kinds == 5).all() and (sizes == 3).all():
        return Content(points, corners, sizes)
    faces: list[list[int]] = []
    curved = 0
    for kind, end, size in zip(kinds.tolist(), ends.tolist(), sizes.tolist(), strict=True):
        cell = corners[end - size : end].tolist()
        if kind in _POLYGONS:
            faces.append(cell)
        elif kind == _STRIP:
            faces += strips([cell])
        elif kind == _PIXEL:
            faces.append([cell[place] for place in (0, 1, 3, 2)])
        elif kind not in _LOWER:
            faces.append(cell[: _CURVED.get(kind, size // 2)])
            curved += 1
    return Content(points, *polygons(faces), curved, corners)
