"""Readers and writers of points and triangles, one pair per library.

A reader returns points (n, 3) and triangles (n_t, 3) and may raise anything on a broken
file; `files` turns that into the project's errors.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError

Reader = Callable[[Path], tuple[NDArray[Any], NDArray[Any]]]
Writer = Callable[[Path, FloatArray, IntArray], None]


def read_vtp(path: Path) -> tuple[NDArray[Any], NDArray[Any]]:
    """Read VTK's XML polygons; of a broken file VTK makes an empty surface."""
    from vtkmodules.util import numpy_support
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader: Any = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    with _silent_vtk():
        reader.Update()
    surface = reader.GetOutput()
    if reader.GetErrorCode() or surface.GetNumberOfPoints() == 0:
        raise ValueError("VTK cannot read it")
    if surface.GetNumberOfStrips():
        raise _not_triangles(path, "triangle strips")
    to_numpy: Any = numpy_support.vtk_to_numpy
    polygons = surface.GetPolys()
    sizes = np.diff(to_numpy(polygons.GetOffsetsArray()))
    if (sizes != 3).any():
        raise _not_triangles(path, f"a polygon of {int(sizes[sizes != 3][0])} corners")
    triangles = to_numpy(polygons.GetConnectivityArray()).reshape(len(sizes), 3)
    return to_numpy(surface.GetPoints().GetData()).copy(), triangles.copy()


def write_vtp(path: Path, points: FloatArray, triangles: IntArray) -> None:
    """Write VTK's XML polygons, compressed."""
    from vtkmodules.util import numpy_support
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    to_vtk: Any = numpy_support.numpy_to_vtk
    to_vtk_ids: Any = numpy_support.numpy_to_vtkIdTypeArray
    positions = vtkPoints()
    positions.SetData(to_vtk(points, deep=True))
    cells = vtkCellArray()
    offsets = np.arange(0, triangles.size + 1, 3, dtype=np.int64)
    cells.SetData(to_vtk_ids(offsets, deep=True), to_vtk_ids(triangles.ravel(), deep=True))
    surface = vtkPolyData()
    surface.SetPoints(positions)
    surface.SetPolys(cells)
    writer: Any = vtkXMLPolyDataWriter()
    writer.SetInputData(surface)
    writer.SetFileName(str(path))
    writer.SetDataModeToBinary()
    with _silent_vtk():
        written = writer.Write()
    if not written:
        raise OSError(0, "VTK cannot write there")


@contextmanager
def _silent_vtk() -> Iterator[None]:
    from vtkmodules.vtkCommonCore import vtkObject

    before = vtkObject.GetGlobalWarningDisplay()
    vtkObject.SetGlobalWarningDisplay(0)
    try:
        yield
    finally:
        vtkObject.SetGlobalWarningDisplay(before)


def read_meshio(path: Path) -> tuple[NDArray[Any], NDArray[Any]]:
    """Read any format of meshio, which prints and exits where it should raise."""
    import meshio

    _refuse_half_a_header(path)
    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
        content = meshio.read(path, file_format=_meshio_name(path))
    kinds = {block.type for block in content.cells} - {"vertex", "line"}
    if kinds - {"triangle"}:
        raise _not_triangles(path, f"{', '.join(sorted(kinds - {'triangle'}))} cells")
    return content.points, content.get_cells_type("triangle")


def write_meshio(path: Path, points: FloatArray, triangles: IntArray) -> None:
    """Write in meshio's format of that extension."""
    import meshio

    mesh = meshio.Mesh(points, [("triangle", triangles)])
    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
        mesh.write(path, file_format=_meshio_name(path))


def _refuse_half_a_header(path: Path) -> None:
    # meshio would wait for the rest of it for ever.
    lines = [line.strip() for line in path.read_bytes().splitlines()]
    if path.suffix.lower() == ".ply" and b"end_header" not in lines:
        raise ValueError("the header has no end")
    said = [line for line in lines[1:] if line and not line.startswith(b"#")]
    if path.suffix.lower() == ".off" and not said:
        raise ValueError("the header has no counts")


def _meshio_name(path: Path) -> str:
    # By name: meshio would try Ansys first for .msh.
    extension = path.suffix.lower().removeprefix(".")
    return "gmsh" if extension == "msh" else extension


def read_trimesh(path: Path) -> tuple[NDArray[Any], NDArray[Any]]:
    """Read a soup of triangles: positions equal to the last bit are one vertex."""
    import trimesh

    # trimesh's own merging has an absolute tolerance, which destroys small meshes.
    soup = trimesh.load_mesh(path, file_type=path.suffix[1:].lower(), process=False)
    return _merge_equal(np.asarray(soup.vertices), np.asarray(soup.faces))


def write_trimesh(path: Path, points: FloatArray, triangles: IntArray) -> None:
    """Write in trimesh's format of that extension."""
    import trimesh

    mesh = trimesh.Trimesh(points, triangles, process=False)
    mesh.export(path, file_type=path.suffix[1:].lower())


def read_obj(path: Path) -> tuple[NDArray[Any], NDArray[Any]]:
    """Read a Wavefront file by trimesh, which would split quadrangles without a word."""
    with path.open("rb") as file:
        for line in file:
            words = line.split()
            if words[:1] == [b"f"] and len(words) != 4:
                raise _not_triangles(path, f"a face of {len(words) - 1} corners")
    return read_trimesh(path)


def write_obj(path: Path, points: FloatArray, triangles: IntArray) -> None:
    """Write a Wavefront file; trimesh would round to a fixed number of decimals."""
    vertices = [f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist()]
    faces = [f"f {a} {b} {c}\n" for a, b, c in (triangles + 1).tolist()]
    path.write_text("".join(vertices + faces), encoding="ascii")


def _merge_equal(
    points: NDArray[Any], triangles: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    _, first, place = np.unique(points, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.argsort(order)
    return points[first[order]], rank[place.ravel()][triangles]


def _not_triangles(path: Path, found: str) -> MeshError:
    return MeshError("mesh", None, f"{path} holds {found}; a film is made of triangles")
