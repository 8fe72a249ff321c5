"""Triangulated surfaces as .vtp files (VTK's XML polygons), read and written exactly."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError, OutputError

Fields = Mapping[str, NDArray[Any]]


@dataclass(frozen=True)
class VtpFile:
    """What a .vtp file holds.

    Attributes
    ----------
    points : (n_v, 3) float
    triangles : (n_t, 3) int
    lines : each (n,) int, vertex by vertex; a closed one ends with the vertex it starts at
    point_fields : by name, (n_v,) or (n_v, k)
    field_data : by name, (n,) or (n, k): what belongs to no point, such as a load
    """

    points: FloatArray
    triangles: IntArray
    lines: tuple[IntArray, ...]
    point_fields: Fields
    field_data: Fields


def vtp_content(
    x: FloatArray,
    triangles: IntArray,
    loop: IntArray | None = None,
    point_fields: Fields | None = None,
    field_data: Fields | None = None,
) -> bytes:
    """Return the content of a .vtp file of a surface, every bit of it, compressed.

    Parameters
    ----------
    x : (n_v, 3) float
    triangles : (n_t, 3) int
    loop : (n_b,) int, cyclic; written as one closed line, which is then cell 0
    point_fields : by name, (n_v,) or (n_v, k)
    field_data : by name, (n,) or (n, k)
    """
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


def read_vtp(path: Path) -> VtpFile:
    """Read the triangles, lines and fields of a .vtp file.

    Raises OutputError if the file cannot be opened, and MeshError if it is broken or holds
    other polygons than triangles. Whether they make a surface is not looked at.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None
    surface = _parsed(content)
    if surface is None:
        raise _mesh_error(path, "is not a whole .vtp file of a triangulated surface")
    if surface.GetNumberOfStrips():
        raise _mesh_error(path, "holds triangle strips; a film is made of triangles")
    sizes = np.diff(_numpy(surface.GetPolys().GetOffsetsArray()))
    if (sizes != 3).any():
        corners = int(sizes[sizes != 3][0])
        problem = f"holds a polygon of {corners} corners; a film is made of triangles"
        raise _mesh_error(path, problem)
    return VtpFile(
        points=_numpy(surface.GetPoints().GetData()).astype(np.float64),
        triangles=_vertices(surface.GetPolys()).reshape(-1, 3),
        lines=tuple(_split(surface.GetLines())),
        point_fields=_fields(surface.GetPointData()),
        field_data=_fields(surface.GetFieldData()),
    )


def _parsed(content: bytes) -> Any:
    """Return the vtkPolyData in a file; None of a broken one, which VTK finds empty."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader: Any = vtkXMLPolyDataReader()
    reader.ReadFromInputStringOn()
    reader.SetInputString(content)
    with _silent_vtk():
        reader.Update()
    surface = reader.GetOutput()
    broken = reader.GetErrorCode() or surface.GetNumberOfPoints() == 0
    return None if broken else surface


@contextmanager
def _silent_vtk() -> Iterator[None]:
    from vtkmodules.vtkCommonCore import vtkObject

    before = vtkObject.GetGlobalWarningDisplay()
    vtkObject.SetGlobalWarningDisplay(0)
    try:
        yield
    finally:
        vtkObject.SetGlobalWarningDisplay(before)


def _mesh_error(path: Path, problem: str) -> MeshError:
    return MeshError("mesh", None, f"{path} {problem}")


def _split(cells: Any) -> list[IntArray]:
    """Return the vertices (n,) of each cell."""
    if not cells.GetNumberOfCells():
        return []
    return np.split(_vertices(cells), _numpy(cells.GetOffsetsArray())[1:-1])


def _vertices(cells: Any) -> IntArray:
    """Return the vertices of all cells, one after the other."""
    return _numpy(cells.GetConnectivityArray()).astype(np.int64)


def _fields(data: Any) -> dict[str, NDArray[Any]]:
    """Return the arrays of numbers among a surface's data, by name."""
    arrays = [data.GetArray(number) for number in range(data.GetNumberOfArrays())]
    return {array.GetName(): _numpy(array) for array in arrays if array is not None}


def _numpy(array: Any) -> NDArray[Any]:
    from vtkmodules.util import numpy_support

    to_numpy: Any = numpy_support.vtk_to_numpy
    values: NDArray[Any] = to_numpy(array)
    return values


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
