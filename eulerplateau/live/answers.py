"""What pages are told: what can be varied, the points visited, the shapes, as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape
from eulerplateau.mesh.drawing import EYE, LOOP_RADIUS, mean_normal, settled, turn_onto
from eulerplateau.pictures.gallery import base64_of, cell_of, film_colours
from eulerplateau.runs import Varied, Visited

# No vertex is farther from the middle of a loop of length 1 than 1/2: 16 bits are 2e-5.
_UNIT = 0.5 / 32767
# A mark's direction, to half a degree round the wire.
_INT8 = 127
# Of a normal: less than a tenth of a degree.
_NORMAL_DIGITS = 4
# What is seen across and up at first, in units of L: the longest films are eights.
_HALF_SIZE = 0.25, 0.17


class Stage:
    """Turns each shape to lie close to the one before it, as the gallery does.

    An equilibrium leaves open where and how it lies.
    """

    def __init__(self) -> None:
        self._last: FloatArray | None = None

    def shape(self, point: Visited) -> dict[str, Any]:
        """Return a shape as the page draws it."""
        x, turn = self._placed(point.shape)
        marks = None
        if point.directors is not None:
            marks = base64_of(np.rint(_INT8 * (point.directors @ turn)).astype("i1"))
        return {
            "x": base64_of(np.rint(x / _UNIT).astype("<i2")),
            "marks": marks,
            "normal": np.round(mean_normal(x[point.shape.loop]), _NORMAL_DIGITS).tolist(),
            "radius": LOOP_RADIUS if point.radius is None else point.radius,
        }

    def _placed(self, shape: Shape) -> tuple[FloatArray, FloatArray]:
        """Return positions (n_v, 3), and the rotation (3, 3) that turned them."""
        here = shape.x - shape.x.mean(axis=0)
        if not np.isfinite(here).all():
            return np.zeros_like(here), np.eye(3)
        if self._last is None:
            self._last = settled(shape.x[None], [None], shape.loop)[0]
        turn = turn_onto(self._last, here)
        self._last = here @ turn
        return self._last, turn


def point_told(number: int, point: Visited) -> dict[str, Any]:
    """Return a point as the diagram and the numbers show it."""
    row = point.row
    names = (field.name for field in fields(row) if not field.kw_only)
    return {
        "number": number,
        "values": {name: cell_of(value) for name, value in point.values.items()},
        "row": {name: cell_of(getattr(row, name)) for name in names},
        "way": point.way,
        "jumped": point.jumped,
        "advice": "" if row.converged else row.status.advice,
    }


def opening(name: str, varied: Sequence[Varied], shape: Shape) -> dict[str, Any]:
    """Return what a page is told first: what can be varied, and how shapes are decoded."""
    return {
        "name": name,
        "varied": [
            {
                "key": each.key,
                "unit": each.name.unit,
                "low": each.low,
                "high": each.high,
            }
            for each in varied
        ],
        "unit": _UNIT,
        "size": 1.0,
        "colours": film_colours(),
        "eye": EYE.tolist(),
        "halfSize": _HALF_SIZE,
        "vertices": len(shape.x),
        "loop": base64_of(shape.loop.astype("<u4")),
    }
