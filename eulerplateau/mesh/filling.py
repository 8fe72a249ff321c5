"""Triangles inside a plane polygon, for what is drawn of an outline."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray


def fill_polygon(outline: FloatArray) -> IntArray:
    """Return triangles (n - 2, 3) between the vertices of a polygon (n, 2).

    It may be concave, and is counter-clockwise; one that crosses itself may get fewer.
    """
    from vtkmodules.vtkCommonCore import vtkIdList
    from vtkmodules.vtkCommonDataModel import vtkPolygon

    n = len(outline)
    polygon = vtkPolygon()
    polygon.GetPoints().SetNumberOfPoints(n)
    polygon.GetPointIds().SetNumberOfIds(n)
    for number, (x, y) in enumerate(outline.tolist()):
        polygon.GetPoints().SetPoint(number, x, y, 0.0)
        polygon.GetPointIds().SetId(number, number)
    found = vtkIdList()
    polygon.EarCutTriangulation(found)
    corners = [found.GetId(i) for i in range(found.GetNumberOfIds())]
    triangles: IntArray = np.array(corners, dtype=np.int64).reshape(-1, 3)
    return triangles
