"""Films drawn as vectors, from one viewpoint and without perspective.

Blue is the side a film's normal points to, orange the other, so that it is seen to turn
over; in grey the front is the darker one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh import Shape
from eulerplateau.mesh.drawing import BACK, FRONT, LOOP, LOOP_RADIUS, UP
from eulerplateau.pictures.layers import cut_where_crossing, layers, overlaps

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LOOP_WIDTH = 1.0
# Width of the parts' edges: it closes the gaps that smoothing leaves between them, and is
# the most by which the line is ragged in which a film passes through itself.
_SEAM = 0.2
# Into so many an edge of the loop is divided, for it may be hidden in part.
_STRETCHES = 6
# Part of its colour that a film keeps where it is seen edge-on.
_DARKEST = 0.72
# Part of a thick wire's width that is drawn lighter, with so much of its darkness.
_MIDDLE, _LIGHT = 0.75, tuple(1 - 0.6 * (1 - part) for part in LOOP)


def room(
    shapes: Sequence[Shape], eyes: Sequence[FloatArray], radius: float = 0.0
) -> tuple[float, float]:
    """Return half the width and height that hold every shape about its loop's centre.

    radius : float, of the thickest wire
    """
    seen = [_project(shape.x, eye)[:, :2] for shape, eye in zip(shapes, eyes, strict=True)]
    half = 1.06 * (np.abs(np.concatenate(seen)).max(axis=0) + radius)
    return float(half[0]), float(half[1])


def draw_film(
    ax: Axes,
    shape: Shape,
    eye: FloatArray,
    half: tuple[float, float],
    radius: float = 0.0,
) -> None:
    """Draw a shape, centred at the origin, into a field of `half` its width and height.

    `eye` is the unit vector (3,) towards the viewer. What hides something is painted after.
    The loop is a line, or twice as wide as its `radius`, in the unit of the shape.
    """
    from matplotlib.collections import PolyCollection

    x = _project(shape.x, eye)
    corners, parents = cut_where_crossing(x, shape.triangles)
    ends = _stretches(x[shape.loop])
    outlines = [*corners, *ends]
    depth = np.array([outline[:, 2].mean() for outline in outlines])
    before = _what_hides(shape, corners, parents, ends, radius)
    order = np.lexsort((depth, layers(before, depth)))
    film = _shaded(x[shape.triangles])[parents]
    n, m = len(film), len(ends)
    widths, colours = np.repeat([_SEAM, _LOOP_WIDTH], [n, m]), [*film, *[LOOP] * m]
    if radius > LOOP_RADIUS:
        # On each stretch lies its lighter middle.
        order = np.repeat(order, np.where(order < n, 1, 2))
        order[1:] += m * (order[1:] == order[:-1])
        outlines[n:] = [*_bands(ends, radius), *_bands(ends, _MIDDLE * radius)]
        widths = np.repeat([_SEAM, 0.0, _SEAM], [n, m, m])
        colours += [_LIGHT] * m
    ax.add_collection(
        PolyCollection(
            [outlines[place][:, :2] for place in order],
            facecolors=np.array(colours)[order],
            edgecolors=np.array(colours)[order],
            linewidths=widths[order],
            joinstyle="round",
            capstyle="round",
        )
    )
    ax.set(xlim=(-half[0], half[0]), ylim=(-half[1], half[1]), aspect="equal")
    ax.set_axis_off()


def _what_hides(
    shape: Shape,
    corners: FloatArray,
    parents: IntArray,
    ends: FloatArray,
    radius: float,
) -> IntArray:
    """Return pairs (m, 2) of which the first is to be painted before the second.

    Numbered are first the parts (n, 3, 3) of the film, then the stretches (k n_b, 2, 3) of
    the loop. These lie over the triangles that their edge ends at, and in the way of all
    others as the front of a wire does, which hides what of the film lies in it.
    """
    n, m = len(corners), len(ends)
    numbers = np.concatenate([np.arange(n), np.tile(n + np.arange(m), 2)])
    seen = numbers[
        overlaps(np.concatenate([corners, _tube(ends, max(radius, LOOP_RADIUS))]))
    ]
    seen = seen[(seen < n).any(axis=1)]
    inside = _inside(corners, ends, radius)
    over = np.concatenate([_rim(shape, parents), inside]) + np.array([0, n])
    key = np.array([n + m, 1])
    among = np.isin(np.sort(seen, axis=1) @ key, np.sort(over, axis=1) @ key)
    return np.concatenate([seen[~among], over])


def _rim(shape: Shape, parents: IntArray) -> IntArray:
    """Return pairs (m, 2) of a part of the film and a stretch of the loop beside it."""
    n_b = len(shape.loop)
    place = np.full(len(shape.x), -1)
    place[shape.loop] = np.arange(n_b)
    part, corner = np.nonzero(place[shape.triangles][parents] >= 0)
    after = place[shape.triangles][parents][part, corner]
    edges = np.stack([after, after - 1], axis=1) % n_b
    stretches = edges[..., None] * _STRETCHES + np.arange(_STRETCHES)
    return np.stack(np.broadcast_arrays(part[:, None, None], stretches), axis=-1).reshape(
        -1, 2
    )


def _inside(corners: FloatArray, ends: FloatArray, radius: float) -> IntArray:
    """Return pairs (m, 2) of a part of the film and a stretch of wire it reaches into."""
    if not radius:
        return np.empty((0, 2), dtype=np.int64)
    from scipy.spatial import cKDTree  # slow to load, and only thick wires need it

    points, middles = cKDTree(corners.reshape(-1, 3)), cKDTree(ends.mean(axis=1))
    near = points.sparse_distance_matrix(middles, radius, output_type="ndarray")
    pairs = np.stack([near["i"] // 3, near["j"]], axis=1).astype(np.int64)
    return np.unique(pairs, axis=0)


def _stretches(x_loop: FloatArray) -> FloatArray:
    """Return the ends (k n_b, 2, 3) of a loop's edges (n_b, 3), each in k stretches."""
    share = np.arange(_STRETCHES + 1)[:, None] / _STRETCHES
    after = np.roll(x_loop, -1, axis=0)
    points = x_loop[:, None] + share * (after - x_loop)[:, None]
    return np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 3)


def _bands(ends: FloatArray, radius: float) -> FloatArray:
    """Return what a wire along stretches (m, 2, 3), end to end, covers: (m, 4, 3)."""
    place = ends[:, 0]
    way = (np.roll(place, -1, axis=0) - np.roll(place, 1, axis=0))[:, :2]
    way /= np.maximum(np.linalg.norm(way, axis=1), 1e-300)[:, None]
    aside = radius * np.stack([-way[:, 1], way[:, 0], np.zeros(len(way))], axis=1)
    left, right = place + aside, place - aside
    after = np.roll([left, right], -1, axis=1)
    return np.stack([left, after[0], after[1], right], axis=1)


def _tube(ends: FloatArray, radius: float) -> FloatArray:
    """Return the front of a tube round edges (n_b, 2, 3): two triangles (3, 3) for each."""
    way = ends[:, 1, :2] - ends[:, 0, :2]
    across = np.stack([-way[:, 1], way[:, 0]], axis=1)
    across *= radius / np.maximum(np.linalg.norm(way, axis=1), 1e-300)[:, None]
    start, end = (ends[:, side] + [0.0, 0.0, radius] for side in (0, 1))
    aside = np.concatenate([across, np.zeros((len(ends), 1))], axis=1)
    a, b, c, d = start - aside, end - aside, end + aside, start + aside
    return np.concatenate([np.stack(half, axis=1) for half in ((a, b, c), (a, c, d))])


def _shaded(corners: FloatArray) -> FloatArray:
    """Return the colours (n_t, 3) of triangles (n_t, 3, 3), darker where seen aslant."""
    a, b, c = corners.transpose(1, 0, 2)
    normals = np.cross(b - a, c - a)
    facing = normals[:, 2] / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)
    shade = _DARKEST + (1 - _DARKEST) * np.abs(facing)
    colours: FloatArray = np.where(facing[:, None] > 0, FRONT, BACK) * shade[:, None]
    return colours


def _project(x: FloatArray, eye: FloatArray) -> FloatArray:
    """Return positions (n, 3) to the right, upwards and towards the eye."""
    right = np.cross(UP, eye)
    right /= np.linalg.norm(right)
    seen: FloatArray = x @ np.stack([right, np.cross(eye, right), eye], axis=1)
    return seen
