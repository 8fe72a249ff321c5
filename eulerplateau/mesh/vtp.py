"""Write triangulated surfaces as .vtp files (VTK's XML polygons), exactly."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh.whole_files import write_whole

Fields = Mapping[str, NDArray[Any]]


def write_vtp(
    path: Path,
    x: FloatArray,
    triangles: IntArray,
    *,
    loop: IntArray | None = None,
    point_fields: Fields | None = None,
    field_data: Fields | None = None,
) -> None:
    """Write a surface to `path`, every bit of it, compressed; whole or not at all.

    Raises OutputError if the file cannot be written.

    Parameters
    ----------
    path : Path
    x : (n_v, 3) float
    triangles : (n_t, 3) int
    loop : (n_b,) int, cyclic; written as one closed line, which is then cell 0
    point_fields : by name, (n_v,) or (n_v, k)
    field_data : by name, (n,) or (n, k)
    """
    write_whole(path, vtp_content(x, triangles, loop, point_fields, field_data))


def vtp_content(
    x: FloatArray,
    triangles: IntArray,
    loop: IntArray | None = None,
    point_fields: Fields | None = None,
    field_data: Fields | None = None,
) -> bytes:
    """Return what `write_vtp` writes."""
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    positions = vtkPoints()
    positions.SetData(_array("Points", x))
    surface = vtkPolyData()
    surface.SetPoints(positions)
    if loop is not None:
        surface.SetLines(_cells(np.append(loop, loop[0])[None, :]))
    surface.SetPolys(_cells(triangles))
    for name, values in (point_fields or {}).items():
        surface.GetPointData().AddArray(_array(name, values))
    for name, values in (field_data or {}).items():
        surface.GetFieldData().AddArray(_array(name, values))
    # Into a string, since VTK's own files end up empty on a full disk, in silence.
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(surface)
    writer.WriteToOutputStringOn()
    writer.SetDataModeToBinary()
    writer.Write()
    content: str = writer.GetOutputString()
    return content.encode("ascii")


def _array(name: str, values: NDArray[Any]) -> Any:
    from vtkmodules.util import numpy_support

    to_vtk: Any = numpy_support.numpy_to_vtk
    array = to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    return array


def _cells(vertices: IntArray) -> Any:
    """Return cells of equal size, one row of vertex numbers each."""
    from vtkmodules.util import numpy_support
    from vtkmodules.vtkCommonDataModel import vtkCellArray

    to_vtk: Any = numpy_support.numpy_to_vtkIdTypeArray
    count, size = vertices.shape
    offsets = to_vtk(np.arange(count + 1) * size, deep=True)
    flat = np.ascontiguousarray(vertices.ravel(), dtype=np.int64)
    cells = vtkCellArray()
    cells.SetData(offsets, to_vtk(flat, deep=True))
    return cells
