"""Which reader and which writer belong to the extension of a mesh file."""

from __future__ import annotations

import io
import logging
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError, OutputError
from eulerplateau.mesh import readers
from eulerplateau.mesh.readers import Content
from eulerplateau.mesh.vtp import vtp_content
from eulerplateau.mesh.whole_files import whole_file

_log = logging.getLogger(__name__)

# A reader may raise anything on a broken file: `readers.one_line` says what it means.
Reader = Callable[[Path], Content]
Writer = Callable[[Path, FloatArray, IntArray], None]

# Formats in which triangles share no vertices, so that merging them is nothing to tell.
SOUPS = {".stl", ".glb"}


def read_polygons(path: Path) -> Content:
    """Read VTK's XML polygons; warn if they are a shape that a run has written."""
    file = readers.XmlFile(path.read_bytes())
    if file.field_data().keys() >= {"step", "kL3_alpha"}:
        _log.warning(
            "%s is a shape of a run: as a mesh its deformed film becomes the rest state; "
            "to start from it keep the run's mesh and set start.file",
            path,
        )
    return file.surface()


def write_polygons(path: Path, points: FloatArray, triangles: IntArray) -> None:
    """Write VTK's XML polygons, compressed."""
    path.write_bytes(vtp_content(points, triangles))


def write_meshio(path: Path, points: FloatArray, triangles: IntArray) -> None:
    """Write in meshio's format of that extension."""
    import meshio

    mesh = meshio.Mesh(points, [("triangle", triangles)])
    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
        mesh.write(path, file_format=_meshio_name(path))


def _meshio_name(path: Path) -> str:
    # By name: meshio would take .msh for one of Ansys.
    extension = path.suffix.lower().removeprefix(".")
    return "gmsh" if extension == "msh" else extension


def read_glb(path: Path) -> Content:
    """Read a .glb file by trimesh, all its parts where their scene has them."""
    import trimesh

    # trimesh's own merging has an absolute tolerance, which destroys small meshes.
    found = trimesh.load_mesh(path, file_type="glb", process=False)
    triangles = np.asarray(found.faces, dtype=np.int64).reshape(-1, 3)
    points = np.asarray(found.vertices, dtype=np.float64).reshape(-1, 3)
    return Content(points, triangles.ravel(), np.full(len(triangles), 3))


def write_trimesh(path: Path, points: FloatArray, triangles: IntArray) -> None:
    """Write in trimesh's format of that extension."""
    import trimesh

    mesh = trimesh.Trimesh(points, triangles, process=False)
    mesh.export(path, file_type=path.suffix[1:].lower())


def write_obj(path: Path, points: FloatArray, triangles: IntArray) -> None:
    """Write a Wavefront file; trimesh would round to a fixed number of decimals."""
    vertices = [f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist()]
    faces = [f"f {a} {b} {c}\n" for a, b, c in (triangles + 1).tolist()]
    path.write_text("".join(vertices + faces), encoding="ascii")


_FORMATS: dict[str, tuple[Reader, Writer]] = {
    ".vtp": (read_polygons, write_polygons),
    ".msh": (readers.read_msh, write_meshio),
    ".vtu": (readers.read_xml, write_meshio),
    ".vtk": (readers.read_legacy, write_meshio),
    ".off": (readers.read_off, write_meshio),
    ".ply": (readers.read_ply, write_meshio),
    ".stl": (readers.read_stl, write_trimesh),
    ".glb": (read_glb, write_trimesh),
    ".obj": (readers.read_obj, write_obj),
}


def format_of(path: Path) -> tuple[Reader, Writer]:
    """Return what reads and writes a file; raises MeshError for an unknown extension."""
    try:
        return _FORMATS[path.suffix.lower()]
    except KeyError:
        known = " ".join(_FORMATS)
        problem = f"{path} has an unknown extension; known are {known} (and .toml specs)"
        raise MeshError("mesh", None, problem) from None


def write_triangles(path: Path, points: FloatArray, triangles: IntArray) -> None:
    """Write points (n, 3) and triangles (n_t, 3) in the format of the extension, whole.

    Raises MeshError for an unknown one, OutputError if the file cannot be written.
    """
    _, write = format_of(path)
    with whole_file(path) as temporary:
        write(temporary, points, triangles)
        # A library may leave an empty file on a full disk, without an error.
        if not temporary.is_file() or temporary.stat().st_size == 0:
            raise OutputError(path, "cannot be written: is the disk full?")
