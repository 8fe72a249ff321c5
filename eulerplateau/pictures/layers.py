"""What hides what: triangles cut where they pass through each other, and put in layers.

To sort triangles by the depths of their middles is not enough where a film passes through
itself or turns over. Here each pair that overlaps in the picture is compared where it does.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray, IntArray

# Parts of the picture's extent below which lengths, and of its square areas, are rounding.
_ROUNDING = 1e-9
# So many pairs at a time are looked at: of a fine mesh all would fill the memory.
_BLOCK = 500_000


def cut_where_crossing(x: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray]:
    """Return triangles no two of which pass through each other, and whose parts they are.

    Parameters
    ----------
    x : (n_v, 3) float
    triangles : (n_t, 3) int

    Returns
    -------
    corners : (n, 3, 3) float
    parents : (n,) int, numbers of `triangles`
    """
    # Numba, which it loads, is for figures with films drawn as vectors alone.
    from eulerplateau.mesh import crossing_pairs

    corners = x[triangles]
    pairs = crossing_pairs(x, triangles)
    cut = {int(one): [corners[one]] for one in np.unique(pairs)}
    for one, other in np.concatenate([pairs, pairs[:, ::-1]]):
        cut[one] = [part for whole in cut[one] for part in _cut(whole, corners[other])]
    fans = {own: np.concatenate([_fan(part) for part in many]) for own, many in cut.items()}
    whole = np.setdiff1d(np.arange(len(triangles)), list(cut))
    parts = np.concatenate([corners[whole], *fans.values()])
    parents = [whole, *(np.full(len(fan), own) for own, fan in fans.items())]
    return parts, np.concatenate(parents)


def layers(before: IntArray, depth: FloatArray) -> IntArray:
    """Return the layer (n,) each of n things is painted in, from 0, the lowest.

    Parameters
    ----------
    before : (m, 2) int, pairs of which the first is to be painted before the second
    depth : (n,) float, greater nearer to the eye: decides among things that would have to
        be painted each before the next, in a ring
    """
    n = len(depth)
    ring = _rings(before, n)
    inside = np.lexsort((depth, ring))
    chained = ring[inside[:-1]] == ring[inside[1:]]
    chain = np.stack([inside[:-1], inside[1:]], axis=1)[chained]
    apart = ring[before[:, 0]] != ring[before[:, 1]]
    lower, upper = np.concatenate([before[apart], chain]).T
    found = np.zeros(n, dtype=np.intp)
    while True:
        raised = found.copy()
        np.maximum.at(raised, upper, found[lower] + 1)
        if (raised == found).all():
            return found
        found = raised


def _rings(before: IntArray, n: int) -> IntArray:
    """Return the number (n,) of the ring of each of n things; most are alone in theirs."""
    left, fewer = before, before[:0]
    while len(left):
        later = np.zeros(n, dtype=bool)
        later[left[:, 1]] = True
        fewer = left[later[left[:, 0]]]
        if len(fewer) == len(left):
            break
        left = fewer
    if not len(left):
        return np.arange(n)
    from scipy.sparse import coo_array  # slow to load, and few films need it
    from scipy.sparse.csgraph import connected_components

    graph = coo_array((np.ones(len(before)), (before[:, 0], before[:, 1])), shape=(n, n))
    ring: IntArray = connected_components(graph, connection="strong")[1]
    return ring


def overlaps(corners: FloatArray) -> IntArray:
    """Return the pairs (m, 2) of triangles that overlap in the picture, the farther first.

    Which is farther is asked in the middle of where they overlap.

    Parameters
    ----------
    corners : (n, 3, 3) float; to the right, upwards, towards the eye
    """
    extent = float(np.ptp(corners[..., :2], axis=(0, 1)).max())
    area = _cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    flat = np.where((area < 0)[:, None, None], corners[:, ::-1], corners)
    solid = np.abs(area) > _ROUNDING * extent**2
    found = [
        _overlapping(flat, pairs, _ROUNDING * extent)
        for pairs in _boxes_meet(flat[..., :2], solid)
    ]
    return np.concatenate([np.empty((0, 2), dtype=np.intp), *found])


def _overlapping(corners: FloatArray, pairs: IntArray, tolerance: float) -> IntArray:
    """Return of pairs (m, 2) of counter-clockwise triangles those that overlap, sorted."""
    first, second = corners[pairs[:, 0]], corners[pairs[:, 1]]
    own, other = _with_middle(first), _with_middle(second)
    met = _edges_meet(first, second)
    common = _inside(own, second, tolerance), _inside(other, first, tolerance)
    use = np.concatenate([*common, np.isfinite(met[..., 0])], axis=1)
    points = np.where(use[..., None], np.concatenate([own, other, met], axis=1), 0.0)
    seen = use.any(axis=1)
    middle = points[seen].sum(axis=1) / use[seen].sum(axis=1)[:, None]
    swapped = _depth(second[seen], middle) < _depth(first[seen], middle)
    return np.where(swapped[:, None], pairs[seen, ::-1], pairs[seen])


def _cut(polygon: FloatArray, face: FloatArray) -> list[FloatArray]:
    """Return a convex polygon (k, 3) cut by a triangle's plane, in two if it crosses it."""
    normal = np.cross(face[1] - face[0], face[2] - face[0])
    height = (polygon - face[0]) @ (normal / np.linalg.norm(normal))
    height[np.abs(height) <= _ROUNDING * np.ptp(polygon, axis=0).max()] = 0.0
    if not (height > 0).any() or not (height < 0).any():
        return [polygon]
    ring, heights = [], []
    for corner, after, h, k in zip(
        polygon, np.roll(polygon, -1, 0), height, np.roll(height, -1), strict=True
    ):
        ring.append(corner)
        heights.append(h)
        if h * k < 0:
            ring.append(corner + h / (h - k) * (after - corner))
            heights.append(0.0)
    points, side = np.array(ring), np.array(heights)
    return [points[side >= 0], points[side <= 0]]


def _fan(polygon: FloatArray) -> FloatArray:
    """Return the triangles (k - 2, 3, 3) of a convex polygon (k, 3)."""
    first = np.broadcast_to(polygon[0], polygon[2:].shape)
    return np.stack([first, polygon[1:-1], polygon[2:]], axis=1)


def _boxes_meet(flat: FloatArray, solid: BoolArray) -> Iterator[IntArray]:
    """Yield the pairs (m, 2) of `solid` triangles (n, 3, 2) whose boxes meet, in blocks."""
    low, high = flat.min(axis=1), flat.max(axis=1)
    order = np.flatnonzero(solid)[np.argsort(low[solid, 0], kind="stable")]
    ends = np.searchsorted(low[order, 0], high[order, 0])
    counts = np.maximum(ends - np.arange(len(order)) - 1, 0)
    blocks = np.flatnonzero(np.diff(np.cumsum(counts) // _BLOCK)) + 1
    for own in np.split(np.arange(len(order)), blocks):
        many = counts[own]
        first = np.repeat(own, many)
        step = np.arange(len(first)) - np.repeat(np.cumsum(many) - many, many)
        one, other = order[first], order[first + 1 + step]
        meet = (low[one, 1] < high[other, 1]) & (low[other, 1] < high[one, 1])
        yield np.stack([one, other], axis=1)[meet]


def _with_middle(corners: FloatArray) -> FloatArray:
    """Return the corners and the middles (m, 4, 2) of triangles (m, 3, 3)."""
    flat = corners[..., :2]
    return np.concatenate([flat, flat.mean(axis=1, keepdims=True)], axis=1)


def _edges_meet(first: FloatArray, second: FloatArray) -> FloatArray:
    """Return where edges of two triangles cross (m, 9, 2), NaN where they do not."""
    a, c = first[:, :, None, :2], second[:, None, :, :2]
    ab = np.roll(first, -1, axis=1)[:, :, None, :2] - a
    cd = np.roll(second, -1, axis=1)[:, None, :, :2] - c
    with np.errstate(divide="ignore", invalid="ignore"):
        along, beside = (_cross(c - a, way) / _cross(ab, cd) for way in (cd, ab))
        met = (np.minimum(along, beside) > _ROUNDING) & (
            np.maximum(along, beside) < 1 - _ROUNDING
        )
        points = np.where(met[..., None], a + along[..., None] * ab, np.nan)
    return points.reshape(len(first), 9, 2)


def _inside(points: FloatArray, corners: FloatArray, tolerance: float) -> BoolArray:
    """Whether points (m, k, 2) lie inside triangles (m, 3, 3), counter-clockwise ones."""
    start = corners[:, None, :, :2]
    edge = np.roll(corners, -1, axis=1)[:, None, :, :2] - start
    away = _cross(edge, points[:, :, None] - start) / np.linalg.norm(edge, axis=-1)
    inside: BoolArray = (away > tolerance).all(axis=2)
    return inside


def _depth(corners: FloatArray, points: FloatArray) -> FloatArray:
    """Return how near to the eye the planes of triangles (m, 3, 3) are at points (m, 2)."""
    a, b, c = corners.transpose(1, 0, 2)
    area = _cross(b - a, c - a)
    to = points - a[:, :2]
    along, beside = _cross(to, c - a) / area, _cross(b - a, to) / area
    depth: FloatArray = a[:, 2] + along * (b - a)[:, 2] + beside * (c - a)[:, 2]
    return depth


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    product: FloatArray = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product
