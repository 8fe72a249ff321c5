"""Where a film passes through itself: triangles that cross one another."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray, IntArray, cross
from eulerplateau.errors import MeshError

# Distances below this, relative to the extent of the shape, count as contact: a thousand
# times the rounding of a coordinate.
_CONTACT = 1e-13
# Of a strip's width: far above rounding, and far below any triangle.
_SLACK = 1e-9
# Pairs that are compared at a time.
_AT_ONCE = 1 << 18


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
    extent, corners = np.ptp(x, axis=0), triangles.T
    contact = _CONTACT * float(extent.max())
    found = [np.empty((2, 0), dtype=np.int64)]
    for near in _near(corners, (x - x.min(axis=0)).T[np.argsort(-extent)]):
        one, other = (np.take(x.T, corners[:, place], axis=1) for place in near)
        found.append(near[:, _cross(one, other, contact)])
    pairs: IntArray = np.concatenate(found, axis=1).T
    return pairs


def _near(corners: IntArray, x: FloatArray) -> Iterator[IntArray]:
    """Yield pairs (2, m) of triangles that share no vertex and whose boxes meet.

    The film is cut into strips across axis 0, about as wide as two triangles. In each,
    triangles are sorted by where they begin along axis 1, and each is compared with those
    that begin before it ends: few, if axis 2 is the shortest. corners : (3, n_t); x :
    (3, n_v), from 0 on.
    """
    places = np.take(x, corners, axis=1)
    low, high = places.min(axis=1), places.max(axis=1)
    width = 2 * float((high[0] - low[0]).mean()) or 1.0
    first = np.floor(low[0] / width)
    many = (np.floor(high[0] / width) - first).astype(np.int64) + 1
    triangle = np.repeat(np.arange(len(many)), many)
    strip = np.arange(len(triangle)) - np.repeat(np.cumsum(many) - many, many)
    strip = strip + first[triangle]
    # One number says both the strip and the place in it, but for rounding.
    span = 2 * float(x[1].max()) or 1.0
    begin, end = strip + (low[1] / span)[triangle], strip + (high[1] / span)[triangle]
    order = np.argsort(begin)
    triangle, new = triangle[order], (strip == first[triangle])[order]
    behind = np.searchsorted(begin[order], end[order] + _SLACK, side="right")
    stops = np.cumsum(behind - np.arange(1, len(order) + 1))
    start = 0
    while start < len(order):
        before = stops[start - 1] if start else 0
        stop = max(start + 1, int(np.searchsorted(stops, before + _AT_ONCE)))
        counts = np.diff(stops[start:stop], prepend=before)
        ahead = behind[start:stop] - stops[start:stop] + before
        one = np.repeat(np.arange(start, stop), counts)
        other = np.arange(len(one)) + np.repeat(ahead, counts)
        # Two that meet in several strips count in the first of them, new to one.
        kept = np.flatnonzero(new.take(one) | new.take(other))
        one, other = triangle.take(one.take(kept)), triangle.take(other.take(kept))
        # Along axis 1 they meet, but for the slack.
        for lower, upper in zip(low[::2], high[::2], strict=True):
            meets = lower.take(other) <= upper.take(one)
            meets &= lower.take(one) <= upper.take(other)
            kept = np.flatnonzero(meets)
            one, other = one.take(kept), other.take(kept)
        apart, others = np.ones(len(one), dtype=bool), corners.take(other, axis=1)
        for column in corners.take(one, axis=1):
            apart &= (column != others).all(axis=0)
        yield np.stack([one[apart], other[apart]])
        start = stop


def _cross(one: FloatArray, other: FloatArray, contact: float) -> BoolArray:
    """Return which (m,) triangles cross (Moeller's interval test, 1997).

    one, other : (3, 3, m), by axis, by corner, by pair.
    """
    found = np.zeros(one.shape[2], dtype=bool)
    normal, over, there = _heights(one, other, contact)
    place = np.flatnonzero(there)
    if not len(place):
        return found
    one, other, normal, over = (a[..., place] for a in (one, other, normal, over))
    another, under, there = _heights(other, one, contact)
    # Both triangles meet the common line of their planes in an interval; compare the two
    # along the coordinate axis closest to that line.
    axis = np.abs(cross(normal.T, another.T)).argmax(axis=1)
    pair = np.arange(len(place))
    low, high = _interval(one[axis, :, pair].T, under)
    least, most = _interval(other[axis, :, pair].T, over)
    common = np.minimum(high, most) - np.maximum(low, least)
    found[place] = there & (common > 10.0 * contact)
    return found


def _heights(
    face: FloatArray, other: FloatArray, contact: float
) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Return twice the area vector (3, m) of each face, heights, and what straddles it.

    Heights (3, m) are those of the corners of `other` over the face times twice its area,
    zero where that is contact; a triangle straddles that has corners on both sides.
    """
    own, away = face - face[:, :1], other - face[:, :1]
    normal = cross(own[:, 1].T, own[:, 2].T).T
    height = (normal[:, None] * away).sum(axis=0)
    # A coordinate's rounding error moves the product by at most about that times this
    # square, also where the triangle is a sliver and its normal is lost in rounding.
    square = np.maximum((own * own).sum(axis=0), (away * away).sum(axis=0)).max(axis=0)
    height[np.abs(height) <= contact * square] = 0.0
    return normal, height, (height.min(axis=0) < 0.0) & (height.max(axis=0) > 0.0)


def _interval(corner: FloatArray, height: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the ends (m,) of the segments in which triangles that straddle meet a plane.

    Along an axis, of corners (3, m) with these heights (3, m) over the plane.
    """
    after = np.roll(height, -1, axis=0)
    at, between = height == 0.0, height * after < 0.0
    share = np.divide(height, height - after, out=np.zeros_like(height), where=between)
    place = corner + share * (np.roll(corner, -1, axis=0) - corner)
    meets = at | between
    low = np.where(meets, place, np.inf).min(axis=0)
    return low, np.where(meets, place, -np.inf).max(axis=0)
