"""Mesh files, made here or elsewhere, and their one way into a `Disk`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError, OutputError, SpecError
from eulerplateau.mesh import formats
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.generation import generate
from eulerplateau.mesh.spec import MeshSpec
from eulerplateau.settings import load_toml


def read_disk(path: str | Path) -> Disk:
    """Return the mesh that `path` describes (.toml) or holds (any other extension).

    Raises what `generate` and `read_mesh` raise.
    """
    if Path(path).suffix.lower() == ".toml":
        return generate(load_toml(path, MeshSpec))
    return read_mesh(path)


def read_mesh(path: str | Path) -> Disk:
    """Read a triangulated disk from a .vtp .msh .vtu .vtk .off .ply .stl .obj .glb file.

    Points and lines in the file, and vertices that no triangle uses, are left out. The
    last three formats store a position more than once where triangles meet; positions
    equal to the last bit are merged.

    Raises SpecError if there is no such file, OutputError if it cannot be read, and
    MeshError if it holds anything else than a disk; the vertices that MeshError names are
    numbered as in the file (after merging).
    """
    points, triangles = read_triangles(path)
    if not len(triangles):
        raise MeshError("mesh", None, f"{path} holds no triangles")
    outside = ((triangles < 0) | (triangles >= len(points))).any(axis=1)
    if outside.any():
        first = int(np.flatnonzero(outside)[0])
        problem = f"uses a vertex outside 0 ... {len(points) - 1} (in {path})"
        raise MeshError("triangle", first, problem)
    used, renumbered = np.unique(triangles, return_inverse=True)
    try:
        return Disk.from_triangles(points[used], renumbered.reshape(-1, 3))
    except MeshError as error:
        raise _named_as_in_file(error, used, path) from None


def read_triangles(path: str | Path) -> tuple[FloatArray, IntArray]:
    """Return points (n, 3) and triangles (n_t, 3) as the file has them, unchecked."""
    path = Path(path)
    try:
        with path.open("rb") as file:
            empty = not file.read(1)
    except FileNotFoundError:
        raise SpecError(str(path), "there is no such file") from None
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None
    if empty:
        raise MeshError("mesh", None, f"{path} is empty")
    read, _ = formats.format_of(path)
    try:
        points, triangles = read(path)
        return points.astype(np.float64), triangles.astype(np.int64).reshape(-1, 3)
    except MeshError:
        raise
    # The readers raise whatever comes up in a broken file, and meshio even exits.
    except (Exception, SystemExit) as error:
        problem = f"{path} is not a whole {path.suffix} file of a triangulated surface"
        raise MeshError("mesh", None, problem) from error


def write_mesh(mesh: Disk, path: str | Path) -> None:
    """Write `mesh` at its physical size, `mesh.x * mesh.length`; whole or not at all.

    .vtp .msh .vtu .vtk .off .ply .obj keep every bit, .stl and .glb single precision.
    Raises MeshError for another extension, OutputError if the file cannot be written.
    """
    formats.write_triangles(Path(path), mesh.x * mesh.length, mesh.triangles)


def _named_as_in_file(error: MeshError, used: IntArray, path: str | Path) -> MeshError:
    index = error.index
    if error.kind == "vertex" and isinstance(index, int):
        index = int(used[index])
    elif isinstance(index, tuple):
        index = (int(used[index[0]]), int(used[index[1]]))
    problem = str(error).partition(": ")[2]
    return MeshError(error.kind, index, f"{problem} (in {path})")
