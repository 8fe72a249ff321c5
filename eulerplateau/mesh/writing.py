"""Which writer belongs to the extension of a mesh file; `formats` has the readers."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import TypeVar

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError, OutputError
from eulerplateau.mesh.vtp_content import Fields, vtp_content
from eulerplateau.mesh.whole_files import whole_file, write_whole

Writer = Callable[[Path, FloatArray, IntArray], None]
F = TypeVar("F")


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


_WRITERS: dict[str, Writer] = {
    ".vtp": write_polygons,
    ".msh": write_meshio,
    ".vtu": write_meshio,
    ".vtk": write_meshio,
    ".off": write_meshio,
    ".ply": write_meshio,
    ".stl": write_trimesh,
    ".glb": write_trimesh,
    ".obj": write_obj,
}


def of_extension(path: Path, known: Mapping[str, F]) -> F:
    """Return what is `known` by the extension of a file; raises MeshError for another."""
    try:
        return known[path.suffix.lower()]
    except KeyError:
        names = " ".join(known)
        problem = f"{path} has an unknown extension; known are {names} (and .toml specs)"
        raise MeshError("mesh", None, problem) from None


def write_triangles(path: Path, points: FloatArray, triangles: IntArray) -> None:
    """Write points (n, 3) and triangles (n_t, 3) in the format of the extension, whole.

    Raises MeshError for an unknown one, OutputError if the file cannot be written.
    """
    write = of_extension(path, _WRITERS)
    with whole_file(path) as temporary:
        write(temporary, points, triangles)
        # A library may leave an empty file on a full disk, without an error.
        if not temporary.is_file() or temporary.stat().st_size == 0:
            raise OutputError(path, "cannot be written: is the disk full?")


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
