"""Shapes as .vtp files and the .pvd series over them, for ParaView and pyvista.

A shape holds the loop as one closed polyline (cell 0: "Extract Cells By Type" and "Tube"
show the wire) and the film as triangles (cells 1 ... n_t). Quantities of the loop are NaN
inside the film and those of the film NaN on the loop, so that neither is mistaken for 0.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import OutputError
from eulerplateau.film import Load
from eulerplateau.mesh import DiskMesh, angle_defects, loop_frame
from eulerplateau.runs.files import write_whole
from eulerplateau.runs.table import Row

_LOOP_FIELDS = ("kappa", "kappa_n", "kappa_g", "contact_angle", "tangent", "normal")


@dataclass(frozen=True)
class Shape:
    """A shape read back from its file.

    Attributes
    ----------
    x : (n_v, 3) float, lengths in units of L
    triangles : (n_t, 3) int
    loop : (n_b,) int
    step, kL3_alpha, energy :
        Of the row of sweep.csv it belongs to.
    """

    x: FloatArray
    triangles: IntArray
    loop: IntArray
    step: int
    kL3_alpha: float  # noqa: N815 - the column's name
    energy: float


def write_shape(
    path: Path,
    mesh: DiskMesh,
    x: FloatArray,
    row: Row,
    modes: Mapping[str, FloatArray] | None = None,
) -> None:
    """Write the film at positions `x` (n_v, 3) to `path` (.vtp), exactly and whole.

    Point fields on the loop: kappa, kappa_n, kappa_g, contact_angle, tangent, normal (of
    the film); inside: angle_defect; everywhere: on_loop (1 or 0) and the vectors `modes`,
    (n_v, 3) each, under their names. Field data, of its `row`: step, kL3_alpha, sigma_hat,
    energy. Raises OutputError if the file cannot be written.
    """
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    film = vtkPolyData()
    film.SetPoints(_points(x))
    closed = np.append(mesh.loop, mesh.loop[0])
    film.SetLines(_cells(closed[None, :]))
    film.SetPolys(_cells(mesh.triangles))
    for name, values in (_point_fields(mesh, x) | dict(modes or {})).items():
        film.GetPointData().AddArray(_array(name, values))
    for name in ("step", "kL3_alpha", "sigma_hat", "energy"):
        film.GetFieldData().AddArray(_array(name, np.array([getattr(row, name)])))

    # Through a string, since VTK's own files end up empty on a full disk, in silence.
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(film)
    writer.WriteToOutputStringOn()
    writer.SetDataModeToBinary()
    writer.Write()
    write_whole(path, writer.GetOutputString().encode("ascii"))


def read_shape(path: Path) -> Shape:
    """Read what `write_shape` wrote; raises OutputError if the file is anything else."""
    from vtkmodules.util import numpy_support
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    try:
        content = path.read_bytes()
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None
    to_numpy: Any = numpy_support.vtk_to_numpy
    reader: Any = vtkXMLPolyDataReader()
    # Silent: what the reader complains of shows in what it returns, checked below.
    reader.AddObserver("ErrorEvent", lambda *_: None)
    reader.ReadFromInputStringOn()
    reader.SetInputString(content.decode("ascii", "replace"))
    reader.Update()
    film = reader.GetOutput()
    about = film.GetFieldData()
    if film.GetNumberOfLines() != 1 or not about.HasArray("kL3_alpha"):
        raise OutputError(path, "is not a whole shape file of a run")
    closed = to_numpy(film.GetLines().GetConnectivityArray())
    triangles = to_numpy(film.GetPolys().GetConnectivityArray())
    return Shape(
        x=to_numpy(film.GetPoints().GetData()).copy(),
        triangles=triangles.reshape(-1, 3).astype(np.int64),
        loop=closed[:-1].astype(np.int64),
        step=int(about.GetArray("step").GetValue(0)),
        kL3_alpha=float(about.GetArray("kL3_alpha").GetValue(0)),
        energy=float(about.GetArray("energy").GetValue(0)),
    )


def write_series(path: Path, shapes: Sequence[tuple[int, float, str]], load: Load) -> None:
    """Write the .pvd series `path` over `shapes`: (step, load, file relative to `path`).

    The time ParaView shows is the load if the loads only rise or only fall,
    and the step otherwise: a sweep up and down meets each load twice, and ParaView shows
    one shape per time. Raises OutputError if the file cannot be written.
    """
    change = np.diff([value for _, value, _ in shapes])
    by_load = bool((change > 0).all() or (change < 0).all())
    timed = sorted((value if by_load else step, name) for step, value, name in shapes)
    time_is = f"load {load.text}" if by_load else "step"
    lines = [
        f'    <DataSet timestep="{time!r}" part="0" file={quoteattr(name)}/>'
        for time, name in timed
    ]
    content = "\n".join(
        [
            '<?xml version="1.0"?>',
            f"<!-- timestep is the {time_is} -->",
            '<VTKFile type="Collection" version="0.1">',
            "  <Collection>",
            *lines,
            "  </Collection>",
            "</VTKFile>",
            "",
        ]
    )
    write_whole(path, content.encode("utf-8"))


def _point_fields(mesh: DiskMesh, x: FloatArray) -> dict[str, NDArray[Any]]:
    frame = loop_frame(mesh, x)
    fields: dict[str, NDArray[Any]] = {}
    for name in _LOOP_FIELDS:
        on_loop = getattr(frame, name)
        fields[name] = np.full((mesh.n_v, *on_loop.shape[1:]), np.nan)
        fields[name][mesh.loop] = on_loop
    fields["angle_defect"] = angle_defects(mesh, x).astype(np.float64)
    fields["angle_defect"][mesh.loop] = np.nan
    fields["on_loop"] = np.zeros(mesh.n_v, dtype=np.uint8)
    fields["on_loop"][mesh.loop] = 1
    return fields


def _array(name: str, values: NDArray[Any]) -> Any:
    from vtkmodules.util import numpy_support

    convert: Any = numpy_support.numpy_to_vtk
    array = convert(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    return array


def _points(x: FloatArray) -> Any:
    from vtkmodules.vtkCommonCore import vtkPoints

    points = vtkPoints()
    points.SetData(_array("Points", x))
    return points


def _cells(vertices: IntArray) -> Any:
    """Return cells of equal size, one row of vertex numbers each."""
    from vtkmodules.util import numpy_support
    from vtkmodules.vtkCommonDataModel import vtkCellArray

    convert: Any = numpy_support.numpy_to_vtkIdTypeArray
    count, size = vertices.shape
    offsets = convert(np.arange(count + 1) * size, deep=True)
    flat = np.ascontiguousarray(vertices.ravel(), dtype=np.int64)
    cells = vtkCellArray()
    cells.SetData(offsets, convert(flat, deep=True))
    return cells
