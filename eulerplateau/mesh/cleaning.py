"""Make triangles that almost are a disk into one: pure functions on arrays.

Each has its law: turning triangles over and splitting polygons keeps every place and the
area, merging vertices moves none, and what is done already is not done again.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import BoolArray, FloatArray, IntArray
from eulerplateau.errors import MeshError
from eulerplateau.mesh.graphs import components
from eulerplateau.mesh.triangles import directed_edges, joints


def pieces(triangles: IntArray) -> int:
    """Return into how many pieces triangles fall that edges of two of them join."""
    one, other = joints(triangles)
    return int(components(one // 3, other // 3, len(triangles)).max()) + 1


def oriented(triangles: IntArray) -> tuple[IntArray, BoolArray]:
    """Return `triangles` (n_t, 3) alike in direction, and which (n_t,) were turned over.

    In every piece that shared edges join, the fewer are turned; of as many those that
    disagree with the first. Edges of more than two
    triangles join nothing. Raises MeshError of a surface with one side only.
    """
    n = len(triangles)
    half = directed_edges(triangles)
    one, other = joints(triangles)
    # Triangles disagree where both pass an edge in the same direction.
    same = half[one, 0] == half[other, 0]
    first, second = one // 3, other // 3
    # Two sheets, each triangle as it is on one and turned over on the other.
    start = np.concatenate([first, first + n])
    end = np.concatenate([second + same * n, second + ~same * n])
    sheet = components(start, end, 2 * n).reshape(2, n)
    if (sheet[0] == sheet[1]).any():
        raise MeshError(
            "mesh", None, "has only one side, as a Moebius strip: it cannot be oriented"
        )
    piece = np.minimum(*sheet)
    turned = sheet[0] != piece
    counts = np.bincount(piece), np.bincount(piece, weights=turned)
    turned ^= (2 * counts[1] > counts[0])[piece]
    return np.where(turned[:, None], triangles[:, ::-1], triangles), turned


def merged(
    points: FloatArray, triangles: IntArray, tolerance: float = 0.0
) -> tuple[IntArray, IntArray]:
    """Return `triangles` on the first of the vertices that coincide, and which were kept.

    Vertices coincide that lie within `tolerance` of each other, in a chain if need be. They
    become one only round a fan of triangles that then share edges: where a surface merely
    passes itself, or touches itself in a point, its vertices stay apart. Triangles that
    lose a side are left out; `kept` (n,) are the numbers of the others in `triangles`.
    """
    used, corner = np.unique(triangles, return_inverse=True)
    # For fans it counts where corners are, not which vertices they were.
    there = _places(points[used], tolerance)[corner.reshape(-1, 3)]
    kept = np.flatnonzero((there != np.roll(there, 1, axis=1)).all(axis=1))
    corners = there[kept]
    fan = _fans(corners)
    first = np.full(int(fan.max(initial=-1)) + 1, len(points))
    np.minimum.at(first, fan.ravel(), triangles[kept].ravel())
    return first[fan], kept


def split(
    points: FloatArray, corners: IntArray, sizes: IntArray
) -> tuple[IntArray, IntArray]:
    """Return triangles (n_t, 3) of polygons, and of which polygon (n_t,) each is a part.

    Each diagonal is the shortest that lies inside. Polygons of fewer than three corners
    are left out.

    Parameters
    ----------
    points : (n, 3) float
    corners : (m,) int, the vertices of all polygons, one polygon after the other
    sizes : (n_f,) int, how many corners each has
    """
    start = np.cumsum(sizes) - sizes
    parts, owners = [], []
    three, four = np.flatnonzero(sizes == 3), np.flatnonzero(sizes == 4)
    parts.append(corners[start[three, None] + np.arange(3)])
    owners.append(three)
    parts.append(_halves(points, corners[start[four, None] + np.arange(4)]))
    owners.append(np.repeat(four, 2))
    for polygon in np.flatnonzero(sizes > 4):
        around = corners[start[polygon] : start[polygon] + sizes[polygon]]
        parts.append(_ears(points, around))
        owners.append(np.full(len(parts[-1]), polygon))
    owner = np.concatenate(owners)
    order = np.argsort(owner, kind="stable")
    triangles: IntArray = np.concatenate(parts).astype(np.int64).reshape(-1, 3)
    return triangles[order], owner[order]


def _places(points: FloatArray, tolerance: float) -> IntArray:
    """Return the number of the place (n,) at which each vertex lies."""
    if tolerance == 0.0:
        _, place = np.unique(points, axis=0, return_inverse=True)
        return np.asarray(place.ravel(), dtype=np.int64)
    from scipy.spatial import cKDTree  # slow to load, and few meshes need it

    # A power of two takes squares out of reach of overflow, and rounds nothing.
    exponent = -int(np.frexp(np.abs(points).max())[1])
    tree = cKDTree(np.ldexp(points, exponent))
    near = tree.query_pairs(float(np.ldexp(tolerance, exponent)), output_type="ndarray")
    return components(near[:, 0], near[:, 1], len(points))


def _fans(corners: IntArray) -> IntArray:
    """Number the vertices (n_t, 3) of triangles so that each has a single fan.

    Corners at one place are the same vertex if edges of two triangles join their triangles
    one by one round it.
    """
    flat = corners.ravel()
    one, other = joints(corners)
    pairs = []
    for end in (one, _next_corner(one)):
        match = np.where(flat[other] == flat[end], other, _next_corner(other))
        pairs.append(np.stack([end, match]))
    start, end = np.concatenate(pairs, axis=1)
    return components(start, end, len(flat)).reshape(-1, 3)


def _next_corner(corner: IntArray) -> IntArray:
    """Return the corner to which the edge from `corner`, 3 t + j, of a triangle runs."""
    return corner // 3 * 3 + (corner + 1) % 3


def _halves(points: FloatArray, quads: IntArray) -> IntArray:
    """Return two triangles (2 n, 3) of each quadrangle (n, 4), one after the other."""
    ways = quads[:, [0, 1, 2, 0, 2, 3]], quads[:, [1, 2, 3, 1, 3, 0]]
    diagonal, inside = [], []
    for way in ways:
        x = points[way].reshape(-1, 2, 3, 3)
        normal = np.cross(x[:, :, 1] - x[:, :, 0], x[:, :, 2] - x[:, :, 0])
        diagonal.append(np.linalg.norm(x[:, 1, 1] - x[:, 1, 0], axis=1))
        # Both halves look the same way, and neither is flat.
        size = np.linalg.norm(x[:, 1, 1] - x[:, 1, 0], axis=1) ** 4
        inside.append((normal[:, 0] * normal[:, 1]).sum(axis=1) > 1e-24 * size)
    second = np.where(
        inside[0] == inside[1], diagonal[1] < diagonal[0], inside[1] & ~inside[0]
    )
    return np.where(second[:, None], ways[1], ways[0]).reshape(-1, 3)


def _ears(points: FloatArray, around: IntArray) -> NDArray[np.int64]:
    """Return the triangles (n - 2, 3) of one polygon, whose shortest ear is cut first."""
    plane = _flattened(points[around])
    left = list(range(len(around)))
    found = []
    while len(left) > 3:
        ring = np.array(left)
        before, after = np.roll(ring, 1), np.roll(ring, -1)
        length = np.linalg.norm(plane[after] - plane[before], axis=1)
        for place in np.argsort(length, kind="stable"):
            ear = before[place], ring[place], after[place]
            others = ring[~np.isin(ring, ear)]
            if _is_ear(plane[list(ear)], plane[others]):
                break
        else:  # none: the polygon crosses itself, or is flat
            place = int(np.argmin(length))
            ear = before[place], ring[place], after[place]
        found.append(ear)
        left.pop(int(place))
    found.append((left[0], left[1], left[2]))
    return around[np.array(found)]


def _flattened(x: FloatArray) -> FloatArray:
    """Return a polygon's corners in the plane (n, 2) that its area lies in."""
    centred = x - x.mean(axis=0)
    normal = np.cross(centred, np.roll(centred, -1, axis=0)).sum(axis=0)
    length = float(np.linalg.norm(normal))
    if length == 0.0:
        return np.ascontiguousarray(centred[:, :2])
    axes: FloatArray = np.linalg.svd((normal / length)[None])[2][1:]
    if np.cross(*axes) @ normal < 0:
        axes = axes[::-1]
    plane: FloatArray = centred @ axes.T
    return plane


def _is_ear(ear: FloatArray, others: FloatArray) -> bool:
    """Whether a corner (before, at, after) turns left with no other corner in its ear."""
    a, b, c = ear
    slack = 1e-12 * max(float(np.abs(ear - a).max()), 1e-300) ** 2
    if _turn(a, b, c) <= slack:
        return False
    inside = [_turn(p, q, others) >= -slack for p, q in ((a, b), (b, c), (c, a))]
    return not np.logical_and.reduce(inside).any()


def _turn(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """Return twice the signed area of the triangles a, b, c in the plane."""
    u, v = b - a, c - a
    area: FloatArray = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return area
