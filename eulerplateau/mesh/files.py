"""Mesh files, made here or elsewhere, and their one way into a `Disk`."""

from __future__ import annotations

import logging
from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError, OutputError, SpecError
from eulerplateau.mesh.cleaning import split
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.formats import SOUPS, reader_of
from eulerplateau.mesh.generation import generate
from eulerplateau.mesh.mending import as_disk, counted
from eulerplateau.mesh.readers import Content, one_line
from eulerplateau.mesh.spec import MeshSpec
from eulerplateau.mesh.writing import write_triangles
from eulerplateau.settings import load_toml

_log = logging.getLogger(__name__)


def read_disk(path: str | Path) -> Disk:
    """Return the mesh that `path` describes (.toml) or holds (any other extension).

    Raises what `generate` and `read_mesh` raise.
    """
    if Path(path).suffix.lower() == ".toml":
        return generate(load_toml(path, MeshSpec))
    return read_mesh(path)


def read_mesh(path: str | Path) -> Disk:
    """Read a disk from a .vtp .msh .vtu .vtk .off .ply .stl .obj .glb file.

    What is in the way of a disk is mended, and a warning says so: polygons are split,
    curved triangles taken by their corners, triangles turned over that disagree with the
    others, vertices left out that no triangle uses. Vertices that coincide are merged only
    if the file holds no disk otherwise, at best those that do to the last bit.

    Raises SpecError if there is no such file, OutputError if it cannot be read, and
    MeshError if it holds anything else than a disk; the vertices that MeshError names are
    numbered as in the file.
    """
    path = Path(path)
    content = _content(path)
    points, triangles = _triangles(content, path)
    if not len(triangles):
        n = len(points)
        raise MeshError("mesh", None, f"{path} holds no triangles, but {n} points")
    disk, lines = as_disk(points, triangles, str(path), path.suffix.lower() in SOUPS)
    for line in [*_left_out(content, triangles), *lines]:
        _log.warning("%s: %s", path, line)
    return disk


def read_triangles(path: str | Path) -> tuple[FloatArray, IntArray]:
    """Return points (n, 3) and triangles (n_t, 3) as the file has them, polygons split."""
    content = _content(Path(path))
    return _triangles(content, Path(path))


def _content(path: Path) -> Content:
    try:
        with path.open("rb") as file:
            empty = not file.read(1)
    except FileNotFoundError:
        raise SpecError(str(path), "there is no such file") from None
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None
    if empty:
        raise MeshError("mesh", None, f"{path} is empty")
    read = reader_of(path)
    with one_line(path):
        return read(path)


def _triangles(content: Content, path: Path) -> tuple[FloatArray, IntArray]:
    points, corners, sizes = content.points, content.corners, content.sizes
    outside = (corners < 0) | (corners >= len(points))
    if outside.any():
        polygon = int(np.repeat(np.arange(len(sizes)), sizes)[outside][0])
        problem = f"uses a vertex outside 0 ... {len(points) - 1} (in {path})"
        raise MeshError("triangle", polygon, problem)
    return points, split(points, corners, sizes)[0]


def _left_out(content: Content, triangles: IntArray) -> list[str]:
    """Say what of a file is not in its triangles, or not as it was."""
    lines = []
    if content.curved:
        what = counted(content.curved, "polygon is", "polygons are")
        lines.append(f"{what} second-order: only the corners are taken")
    if larger := int((content.sizes > 3).sum()):
        what = counted(larger, "polygon is", "polygons are")
        lines.append(f"{what} split along the shorter diagonal")
    if smaller := int((content.sizes < 3).sum()):
        what = counted(
            smaller,
            "polygon of fewer than 3 corners is",
            "polygons of fewer than 3 corners are",
        )
        lines.append(f"{what} left out")
    every = np.zeros(len(content.points), dtype=bool)
    every[triangles] = True
    # Of lines, of curved sides: not forgotten, only no part of the surface.
    every[content.beside] = True
    if unused := int((~every).sum()):
        what = counted(
            unused, "vertex that no triangle uses is", "vertices that no triangle uses are"
        )
        lines.append(f"{what} left out")
    return lines


def write_mesh(mesh: Disk, path: str | Path) -> None:
    """Write `mesh` at its physical size, `mesh.x * mesh.length`; whole or not at all.

    .vtp .msh .vtu .vtk .off .ply .obj keep every bit, .stl and .glb single precision.
    Raises MeshError for another extension, OutputError if the file cannot be written.
    """
    write_triangles(Path(path), mesh.x * mesh.length, mesh.triangles)
