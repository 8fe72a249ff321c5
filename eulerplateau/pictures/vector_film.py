"""Films drawn as vectors, from one viewpoint and without perspective.

Blue is the side a film's normal points to, orange the other, so that it is seen to turn
over; in grey the front is the darker one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape
from eulerplateau.mesh.drawing import UP

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FRONT, _BACK, _LOOP = "#5BA4D9", "#FAD09C", "#1A1A1A"
_LOOP_WIDTH = 1.0
# Part of its colour that a film keeps where it is seen edge-on.
_DARKEST = 0.72
# The loop is painted as if it were so many of its edges' lengths nearer to the eye: then it
# hides the rim of the film beside it.
_NEARER = 1.0


def room(shapes: Sequence[Shape], eye: FloatArray) -> tuple[float, float]:
    """Return half the width and height that hold every shape about its loop's centre."""
    seen = np.concatenate([_project(shape.x, eye)[:, :2] for shape in shapes])
    half = 1.06 * np.abs(seen).max(axis=0)
    return float(half[0]), float(half[1])


def draw_film(ax: Axes, shape: Shape, eye: FloatArray, half: tuple[float, float]) -> None:
    """Draw a shape, centred at the origin, into a field of `half` its width and height.

    `eye` is the unit vector (3,) towards the viewer. Triangles and loop edges are painted
    from the farthest to the nearest.
    """
    from matplotlib.collections import PolyCollection
    from matplotlib.colors import to_rgb

    x = _project(shape.x, eye)
    corners = x[shape.triangles]
    a, b, c = corners.transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    facing = normals[:, 2] / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)
    shade = _DARKEST + (1 - _DARKEST) * np.abs(facing)
    sides = np.where(facing[:, None] > 0, to_rgb(_FRONT), to_rgb(_BACK)) * shade[:, None]
    ends = np.stack([x[shape.loop], x[np.roll(shape.loop, -1)]], axis=1)
    nearer = _NEARER * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    depths = [corners[..., 2].mean(axis=1), ends[..., 2].mean(axis=1) + nearer]
    colours = np.concatenate([sides, np.tile(to_rgb(_LOOP), (len(ends), 1))])
    # As wide an edge as closes the seams that smoothing leaves between triangles.
    widths = np.repeat([0.35, _LOOP_WIDTH], [len(corners), len(ends)])
    order = np.argsort(np.concatenate(depths))
    outlines = [*corners[..., :2], *ends[..., :2]]
    ax.add_collection(
        PolyCollection(
            [outlines[place] for place in order],
            facecolors=colours[order],
            edgecolors=colours[order],
            linewidths=widths[order],
            joinstyle="round",
            capstyle="round",
        )
    )
    ax.set(xlim=(-half[0], half[0]), ylim=(-half[1], half[1]), aspect="equal")
    ax.set_axis_off()


def _project(x: FloatArray, eye: FloatArray) -> FloatArray:
    """Return positions (n, 3) to the right, upwards and towards the eye."""
    right = np.cross(UP, eye)
    right /= np.linalg.norm(right)
    seen: FloatArray = x @ np.stack([right, np.cross(eye, right), eye], axis=1)
    return seen
