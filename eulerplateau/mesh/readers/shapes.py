"""Read .vtp files of triangles with their lines and fields, as runs write them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError
from eulerplateau.mesh.readers.content import one_line
from eulerplateau.mesh.readers.xml_vtk import XmlFile

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


def read_vtp(path: Path) -> VtpFile:
    """Read the triangles, lines and fields of a .vtp file.

    Raises OutputError if the file cannot be opened, and MeshError if it is broken or holds
    other polygons than triangles. Whether they make a surface is not looked at.
    """
    with one_line(path):
        file = XmlFile(path.read_bytes())
        corners, ends = file.cells("Polys")
        if (np.diff(ends, prepend=0) != 3).any() or len(file.cells("Strips")[1]):
            raise MeshError("mesh", None, f"{path} holds other polygons than triangles")
        vertices, stops = file.cells("Lines")
        return VtpFile(
            points=file.points(),
            triangles=corners.reshape(-1, 3),
            lines=tuple(np.split(vertices, stops[:-1])) if len(stops) else (),
            point_fields=file.point_fields(),
            field_data=file.field_data(),
        )
