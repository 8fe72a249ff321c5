"""How far a film is twisted at its waist: the turn of its normal from tip to tip."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray, IntArray, cross
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.triangles import area_vectors, unit

# Lengths, in units of L, that count as zero when the rest polygon is cut by a line: above
# the rounding of meshes in single precision, or far from the origin.
_ON_LINE = 1e-6
# Twists (degrees) that are one and the same.
_SAME_TWIST = 1e-6


@dataclass(frozen=True)
class WaistPath:
    """The straight lines between the loop vertices farthest apart in the rest mesh.

    Each pair of vertices has two, one for each way; on the rim of the polygon one. The
    lines cross n triangles in all. Attributes:

    corners : (n, 3) int
        Vertices of the triangles, line after line, in the order in which it crosses them.
    weights : (n, 2, 3) float
        Barycentric coordinates of the points where it enters and leaves each of them.
    first : (m,) int
        Where each line begins.
    """

    corners: IntArray
    weights: FloatArray
    first: IntArray


def waist_twist(path: WaistPath | None, x: FloatArray) -> float:
    """Return by how many degrees the film's normal turns along the waist path of `x`.

    The path runs straight through each triangle it crosses. From one triangle to the next
    the normal is carried along by the smallest rotation that takes one segment's direction
    to the other's; the angle from there to the next triangle's normal, about the path, is
    summed. Positive when the film winds as a right-handed screw, whichever way the path
    runs and whichever side of the film is up; a mirror image has the opposite twist. The
    surface of eq. eight has 4 arctan(t). Full turns count. NaN without a path.

    Of several lines, the one whose twist is largest in size is taken, so that no numbering
    of the mesh decides; of two alike and opposite, as in a film that is its own mirror
    image, the positive one. Where a film lies flat on itself it turns neither way: that
    counts as +180.
    """
    if path is None:
        return float("nan")
    ends = np.einsum("npc,ncd->npd", path.weights, x[path.corners])
    along = unit(ends[:, 1] - ends[:, 0])
    normals = unit(area_vectors(path.corners, x))
    before, after = normals[:-1], normals[1:]
    turn = along[:-1] + along[1:]
    fall = (before * along[1:]).sum(axis=1)
    # 1 + cos of the bend; a path that doubles back has no smallest rotation, only a floor.
    bend = np.maximum(0.5 * (turn * turn).sum(axis=1), 1e-12)
    carried = before - (fall / bend)[:, None] * turn
    sine = (along[1:] * cross(carried, after)).sum(axis=1)
    cosine = (carried * after).sum(axis=1)
    turns = np.append(np.degrees(np.arctan2(sine, cosine)), 0.0)
    turns[turns <= -180.0 + _SAME_TWIST] += 360.0  # flat on itself: rounding chose the way
    turns[path.first[1:] - 1] = 0.0  # from the end of a line to the next one's beginning
    twists = np.add.reduceat(turns, path.first)
    lowest, highest = float(twists.min()), float(twists.max())
    return highest if highest >= -lowest - _SAME_TWIST else lowest


def waist_path(mesh: Disk) -> WaistPath | None:
    """Return the path for `waist_twist`, or None if the rest mesh has none.

    It has none if it is not planar, or if a line leaves the polygon. Where a
    line runs along an edge the triangle on its right is taken. Where several pairs of loop
    vertices are equally far apart, as in a regular hexagon, each has its lines.
    """
    up = unit(area_vectors(mesh.triangles, mesh.x).sum(axis=0))
    if float(np.ptp(mesh.x @ up)) > _ON_LINE:
        return None
    found: list[tuple[IntArray, FloatArray]] = []
    for start, end in _farthest_pairs(mesh):
        both = (_line(mesh, up, start, end), _line(mesh, up, end, start))
        inside = [line for line in both if line is not None]
        if not inside:
            return None
        found += inside
    corners, weights = zip(*found, strict=True)
    first = np.cumsum([0, *(len(line) for line in corners[:-1])])
    return WaistPath(np.concatenate(corners), np.concatenate(weights), first)


def _line(
    mesh: Disk, up: FloatArray, start: int, end: int
) -> tuple[IntArray, FloatArray] | None:
    """Return what a line crosses, as in WaistPath; None if it leaves the polygon."""
    offset = mesh.x - mesh.x[start]
    along = unit(offset[end])
    span = float(np.linalg.norm(offset[end]))
    side = offset @ np.cross(up, along)
    # Vertices on the line are counted to its left, so that no case is special.
    side[np.abs(side) < _ON_LINE] = 0.0
    corners = _crossed(mesh.triangles, side < 0.0)
    weights = _crossings(side[corners])
    place = (weights * (offset @ along)[corners][:, None, :]).sum(axis=2)
    forward = np.argsort(place, axis=1)
    place = np.take_along_axis(place, forward, axis=1)
    weights = np.take_along_axis(weights, forward[:, :, None], axis=1)
    # Triangles met in a point only, around a vertex on the line, have no segment.
    order = np.argsort(place[:, 0])
    order = order[place[order, 1] - place[order, 0] > _ON_LINE]
    stops = place[order]
    reached = np.concatenate([[0.0], stops[:, 1]])
    wanted = np.concatenate([stops[:, 0], [span]])
    if not np.allclose(reached, wanted, rtol=0.0, atol=10.0 * _ON_LINE):
        return None
    return corners[order], weights[order]


def _farthest_pairs(mesh: Disk) -> list[tuple[int, int]]:
    """Return the pairs of loop vertices farthest apart, all among equals."""
    one, other = (mesh.loop[places] for places in np.triu_indices(mesh.n_b, 1))
    # One axis after the other: there may be millions of pairs.
    distances = np.sqrt(sum((along[one] - along[other]) ** 2 for along in mesh.x.T))
    equals = distances >= distances.max() - _ON_LINE
    return list(zip(one[equals].tolist(), other[equals].tolist(), strict=True))


def _crossed(triangles: IntArray, right: BoolArray) -> IntArray:
    """Return the triangles (n, 3) with corners on both sides, the lone one first."""
    corners = right[triangles]
    number = corners.sum(axis=1)
    mixed = (number == 1) | (number == 2)
    lone = np.argmax(corners[mixed] == (number[mixed] == 1)[:, None], axis=1)
    shift = (lone[:, None] + np.arange(3)) % 3
    return np.take_along_axis(triangles[mixed], shift, axis=1)


def _crossings(side: FloatArray) -> FloatArray:
    """Barycentric (n, 2, 3) of the line's crossings with edges 0-1 and 0-2.

    `side` (n, 3) is the signed distance of the corners from the line.
    """
    weights = np.zeros((len(side), 2, 3))
    for edge, other in enumerate((1, 2)):
        share = side[:, 0] / (side[:, 0] - side[:, other])
        weights[:, edge, 0] = 1.0 - share
        weights[:, edge, other] = share
    return weights
