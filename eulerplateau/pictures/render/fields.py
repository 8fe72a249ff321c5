"""Read fields of a shape file: a curvature, to colour the film by; how its rod points."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.mesh import Shape, read_vtp


def read_field(path: Path, name: str) -> FloatArray:
    """Return the values (n_v,) of a scalar field of a shape file that `read_shape` reads.

    Raises SpecError naming the fields there are if this is none of them.
    """
    fields = read_vtp(path).point_fields
    scalars = {key: values for key, values in fields.items() if values.ndim == 1}
    if name not in scalars:
        known = ", ".join(sorted(scalars))
        raise SpecError("--colour", f"{name} is no field of {path}: sides, soap, {known}")
    return scalars[name].astype(np.float64)


def read_marks(path: Path, shape: Shape) -> FloatArray | None:
    """Return which way the rod of a shape file points, so that one sees its twist.

    Directions (n_b, 3) across the edges of the loop, turned as the shape is that was made
    of it; None if its loop does not resist twist.
    """
    stored = read_vtp(path)
    directors = stored.point_fields.get("director")
    if directors is None:
        return None
    there, here = stored.points[shape.loop], shape.x_loop
    turn, _ = Rotation.align_vectors(here - here.mean(axis=0), there - there.mean(axis=0))
    marks: FloatArray = turn.apply(directors[shape.loop])
    return marks
