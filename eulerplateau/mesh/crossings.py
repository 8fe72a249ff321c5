"""Where a film passes through itself: triangles that cross one another."""

from __future__ import annotations

import numpy as np
from numba import njit

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError

# Distances below this, relative to the extent of the shape, count as contact: a thousand
# times the rounding of a coordinate.
_CONTACT = 1e-13


def self_intersections(x: FloatArray, triangles: IntArray) -> int:
    """Return how many pairs of triangles cross one another (`crossing_pairs`)."""
    return len(crossing_pairs(x, triangles))


def crossing_pairs(x: FloatArray, triangles: IntArray) -> IntArray:
    """Return the pairs (n, 2) of triangles without a common vertex that cross one another.

    Two triangles cross if each has corners strictly on both sides of the other's plane and
    they have a segment, not only a point, in common. Contact is no crossing: a corner or
    an edge that lies in the other triangle, or triangles that overlap in one plane, as in
    a film folded flat. A flat film with rounding noise across its plane has none.

    Parameters
    ----------
    x : (n_v, 3) float
        Positions, in any unit.
    triangles : (n_t, 3) int

    Raises
    ------
    MeshError
        Kind "vertex", if a coordinate is not finite.
    """
    finite = np.isfinite(x).all(axis=1)
    if not finite.all():
        culprit = int(np.flatnonzero(~finite)[0])
        raise MeshError("vertex", culprit, "a coordinate is not finite")
    low = x[triangles].min(axis=1)
    high = x[triangles].max(axis=1)
    extent = np.ptp(x, axis=0)
    axes = np.argsort(-extent)
    order = np.argsort(low[:, axes[0]], kind="stable")
    boxes = np.stack([low[order][:, axes], high[order][:, axes]], axis=1)
    contact = _CONTACT * float(extent.max())
    pairs = np.empty((0, 2), dtype=np.int64)
    count = _sweep(x, triangles[order], boxes, contact, pairs)
    if count:
        pairs = np.empty((count, 2), dtype=np.int64)
        _sweep(x, triangles[order], boxes, contact, pairs)
    found: IntArray = order[pairs]
    return found


@njit(cache=True)
def _sweep(
    x: FloatArray, triangles: IntArray, boxes: FloatArray, contact: float, pairs: IntArray
) -> int:
    """Count crossing pairs, and put the first of them into `pairs` (n, 2).

    `boxes` (n_t, 2, 3) ascend in their lower end along axis 0.
    """
    count = 0
    points = np.empty((2, 3, 3))
    distance = np.empty((2, 3))
    normal = np.empty((2, 3))
    for i in range(len(boxes)):
        for j in range(i + 1, len(boxes)):
            if boxes[j, 0, 0] > boxes[i, 1, 0]:
                break
            if boxes[j, 0, 1] > boxes[i, 1, 1] or boxes[i, 0, 1] > boxes[j, 1, 1]:
                continue
            if boxes[j, 0, 2] > boxes[i, 1, 2] or boxes[i, 0, 2] > boxes[j, 1, 2]:
                continue
            if _share_vertex(triangles[i], triangles[j]):
                continue
            for k in range(3):
                for axis in range(3):
                    points[0, k, axis] = x[triangles[i, k], axis]
                    points[1, k, axis] = x[triangles[j, k], axis]
            if _cross(points, distance, normal, contact):
                if count < len(pairs):
                    pairs[count, 0], pairs[count, 1] = i, j
                count += 1
    return count


@njit(cache=True)
def _share_vertex(a: IntArray, b: IntArray) -> bool:
    for i in range(3):
        for j in range(3):
            if a[i] == b[j]:
                return True
    return False


@njit(cache=True)
def _cross(
    points: FloatArray, distance: FloatArray, normal: FloatArray, contact: float
) -> bool:
    """Whether the two triangles `points` (2, 3, 3) cross (Moeller's interval test, 1997).

    `distance` (2, 3) and `normal` (2, 3) are work space.
    """
    for face in range(2):
        if not _straddles(
            points[face], points[1 - face], distance[face], normal[face], contact
        ):
            return False
    # Both triangles meet the common line of their planes in an interval; compare the two
    # along the coordinate axis closest to that line.
    axis = 0
    steepest = -1.0
    for k in range(3):
        along = abs(
            normal[0, (k + 1) % 3] * normal[1, (k + 2) % 3]
            - normal[0, (k + 2) % 3] * normal[1, (k + 1) % 3]
        )
        if along > steepest:
            steepest = along
            axis = k
    low_a, high_a = _interval(points[0], distance[1], axis)
    low_b, high_b = _interval(points[1], distance[0], axis)
    return min(high_a, high_b) - max(low_a, low_b) > 10.0 * contact


@njit(cache=True)
def _straddles(
    face: FloatArray,
    other: FloatArray,
    distance: FloatArray,
    normal: FloatArray,
    contact: float,
) -> bool:
    """Whether `other` has corners on both sides of the plane of `face`.

    Fills `normal` with twice the area vector of `face`, and `distance` with the height of
    the corners of `other` over it times twice the area, zero where that is contact.
    """
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        normal[k] = (face[1, i] - face[0, i]) * (face[2, j] - face[0, j]) - (
            face[1, j] - face[0, j]
        ) * (face[2, i] - face[0, i])
    # A coordinate's rounding error moves the product by at most about that times this
    # square, also where the triangle is a sliver and its normal is lost in rounding.
    square = 0.0
    for k in range(3):
        to_face = 0.0
        to_other = 0.0
        for axis in range(3):
            to_face += (face[k, axis] - face[0, axis]) ** 2
            to_other += (other[k, axis] - face[0, axis]) ** 2
        square = max(square, to_face, to_other)
    below = False
    above = False
    for k in range(3):
        distance[k] = 0.0
        for axis in range(3):
            distance[k] += normal[axis] * (other[k, axis] - face[0, axis])
        if abs(distance[k]) <= contact * square:
            distance[k] = 0.0
        below = below or distance[k] < 0.0
        above = above or distance[k] > 0.0
    return below and above


@njit(cache=True)
def _interval(corners: FloatArray, distance: FloatArray, axis: int) -> tuple[float, float]:
    """Extent along `axis` of the segment where a straddling triangle meets a plane."""
    low = np.inf
    high = -np.inf
    for i in range(3):
        j = (i + 1) % 3
        if distance[i] == 0.0:
            place = corners[i, axis]
        elif distance[i] * distance[j] < 0.0:
            step = distance[i] / (distance[i] - distance[j])
            place = corners[i, axis] + step * (corners[j, axis] - corners[i, axis])
        else:
            continue
        low = min(low, place)
        high = max(high, place)
    return low, high
