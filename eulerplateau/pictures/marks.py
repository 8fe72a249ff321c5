"""Where a wire is marked so that one sees how it is twisted: which way its rod points."""

from __future__ import annotations

from pathlib import Path

from scipy.spatial.transform import Rotation

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape, read_vtp


def read_marks(path: Path, shape: Shape) -> FloatArray | None:
    """Return directions (n_b, 3) across the edges of a shape's loop, from its file.

    They are turned as the shape is that was made of what the file holds. None if the loop
    there does not resist twist.
    """
    stored = read_vtp(path)
    directors = stored.point_fields.get("director")
    if directors is None:
        return None
    there, here = stored.points[shape.loop], shape.x_loop
    turn, _ = Rotation.align_vectors(here - here.mean(axis=0), there - there.mean(axis=0))
    marks: FloatArray = turn.apply(directors[shape.loop])
    return marks
