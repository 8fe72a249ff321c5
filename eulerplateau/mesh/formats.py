"""Which reader belongs to the extension of a mesh file; `writing` has the writers."""

from __future__ import annotations

import logging
from collections.abc import Callable
from pathlib import Path

import numpy as np

from eulerplateau.mesh import readers
from eulerplateau.mesh.readers import Content
from eulerplateau.mesh.writing import of_extension

_log = logging.getLogger(__name__)

# A reader may raise anything on a broken file: `readers.one_line` says what it means.
Reader = Callable[[Path], Content]

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


def read_glb(path: Path) -> Content:
    """Read a .glb file by trimesh, all its parts where their scene has them."""
    import trimesh

    # trimesh's own merging has an absolute tolerance, which destroys small meshes.
    found = trimesh.load_mesh(path, file_type="glb", process=False)
    triangles = np.asarray(found.faces, dtype=np.int64).reshape(-1, 3)
    points = np.asarray(found.vertices, dtype=np.float64).reshape(-1, 3)
    return Content(points, triangles.ravel(), np.full(len(triangles), 3))


_READERS: dict[str, Reader] = {
    ".vtp": read_polygons,
    ".msh": readers.read_msh,
    ".vtu": readers.read_xml,
    ".vtk": readers.read_legacy,
    ".off": readers.read_off,
    ".ply": readers.read_ply,
    ".stl": readers.read_stl,
    ".glb": read_glb,
    ".obj": readers.read_obj,
}


def reader_of(path: Path) -> Reader:
    """Return what reads a file; raises MeshError for an unknown extension."""
    return of_extension(path, _READERS)
