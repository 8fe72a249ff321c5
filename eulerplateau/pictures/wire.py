"""How the wire of a stored shape is drawn: how thick, and where it is marked."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape, read_vtp
from eulerplateau.mesh.drawing import LOOP_RADIUS, turn_onto


@dataclass(frozen=True)
class Wire:
    """What is drawn along a loop.

    Attributes
    ----------
    radius : float, in lengths of the loop: half its diameter, or that of a line
    marks : (n_b, 3) float, directions across the loop's edges in which it is marked, so
        that one sees how it is twisted; None of a loop that does not resist twist
    """

    radius: float
    marks: FloatArray | None


def read_wire(path: Path, shape: Shape) -> Wire:
    """Return the wire of a shape, from its file.

    Its marks are turned as the shape is that was made of what the file holds.
    """
    stored = read_vtp(path)
    diameter = stored.field_data.get("diameter")
    radius = LOOP_RADIUS if diameter is None else 0.5 * float(diameter[0])
    directors = stored.point_fields.get("director")
    if directors is None:
        return Wire(radius, None)
    there, here = stored.points[shape.loop], shape.x_loop
    turn = turn_onto(here - here.mean(axis=0), there - there.mean(axis=0))
    return Wire(radius, directors[shape.loop] @ turn)
