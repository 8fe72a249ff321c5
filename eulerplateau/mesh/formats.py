"""Readers and writers of points and triangles, one pair per library.

A reader returns points (n, 3) and triangles (n_t, 3) and may raise anything on a broken
file; `files` turns that into the project's errors.
"""

from __future__ import annotations

import io
import logging
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError, OutputError
from eulerplateau.mesh.vtp import Fields, read_vtp, vtp_content
from eulerplateau.mesh.whole_files import whole_file, write_whole

_log = logging.getLogger(__name__)

Reader = Callable[[Path], tuple[NDArray[Any], NDArray[Any]]]
Writer = Callable[[Path, FloatArray, IntArray], None]


def read_polygons(path: Path) -> tuple[NDArray[Any], NDArray[Any]]:
    """Read VTK's XML polygons; warn if they are a shape that a run has written."""
    found = read_vtp(path)
    if found.field_data.keys() >= {"step", "kL3_alpha"}:
        _log.warning(
            "%s is a shape of a run: as a mesh its deformed film becomes the rest state; "
            "to start from it keep the run's mesh and set start.file",
            path,
        )
    return found.points, found.triangles


def write_polygons(path: Path, points: FloatArray, triangles: IntArray) -> None:
    """Write VTK's XML polygons, compressed."""
    path.write_bytes(vtp_content(points, triangles))


def write_vtp(
    path: Path,
    x: FloatArray,
    triangles: IntArray,
    *,
    loop: IntArray | None = None,
    point_fields: Fields | None = None,
    field_data: Fields | None = None,
) -> None:
    """Write a surface and its fields, as `vtp_content` says; whole or not at all.

    Raises OutputError if the file cannot be written.
    """
    write_whole(path, vtp_content(x, triangles, loop, point_fields, field_data))


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


_FORMATS: dict[str, tuple[Reader, Writer]] = {
    ".vtp": (read_polygons, write_polygons),
    ".msh": (read_meshio, write_meshio),
    ".vtu": (read_meshio, write_meshio),
    ".vtk": (read_meshio, write_meshio),
    ".off": (read_meshio, write_meshio),
    ".ply": (read_meshio, write_meshio),
    ".stl": (read_trimesh, write_trimesh),
    ".glb": (read_trimesh, write_trimesh),
    ".obj": (read_obj, write_obj),
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
