"""A triangulated disk: positions, triangles, the loop that bounds it, and its checks.

SciPy is imported where it is needed: it is slow to load, and who only reads and draws
stored shapes can do without.
"""

from __future__ import annotations

import hashlib
import logging
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError
from eulerplateau.mesh.graphs import around, components, neighbours_by_vertex
from eulerplateau.mesh.shape import Shape
from eulerplateau.mesh.triangles import directed_edges

# Below this ratio of twice the area to the longest edge squared, rounding alone decides
# the triangle's orientation. Slivers of aspect ratio 1e8 are still well above it.
_ZERO_AREA = 1e-14

# Shorter loop edges, in units of L: rounding of their ends alone turns them so much that
# of the forces, and so of the shape and its stability, few digits would be left.
_SHORTEST_EDGE = 1e-5

# Farther from the origin than this many times its own size, a mesh has lost digits that its
# energies would show: an offset of D sizes costs up to 100 eps D, here 1e-11.
_FAR = 1e-11 / (100 * float(np.finfo(np.float64).eps))

_log = logging.getLogger(__name__)


@dataclass(frozen=True, repr=False)
class Disk:
    """A checked triangulated disk in units of the length L of its loop.

    Attributes
    ----------
    x : (n_v, 3) float
        Rest positions divided by L, the mean of the loop's vertices at the origin.
    triangles : (n_t, 3) int
        Vertex numbers, counter-clockwise seen from the side the film's normal points to.
    loop : (n_b,) int
        Boundary vertices, cyclic, with the film on the left (counter-clockwise).
    rest_lengths : (n_b,) float
        Length s_v of the loop edge from loop[v] to loop[v + 1]; they sum to 1.
    length : float
        L in the units the mesh came in.
    """

    x: FloatArray
    triangles: IntArray
    loop: IntArray
    rest_lengths: FloatArray
    length: float

    def __repr__(self) -> str:
        """Return one line: how many vertices, triangles and loop vertices, and L."""
        sizes = f"{self.n_v} vertices, {len(self.triangles)} triangles"
        return f"<Disk: {sizes}, {self.n_b} on the loop, length {self.length:.6g}>"

    @classmethod
    def from_triangles(cls, points: ArrayLike, triangles: ArrayLike) -> Disk:
        """Check `points` (n_v, 3), in any unit, and `triangles` (n_t, 3); scale to L = 1.

        Logs a warning if the mesh lies so far from the origin that digits are lost. Raises
        MeshError naming the first vertex, edge or triangle that is wrong.
        """
        given: FloatArray = np.asarray(points, dtype=np.float64)
        corners: IntArray = np.array(triangles, dtype=np.int64)
        _check_arrays(given, corners)
        loop = trace_disk(len(given), corners)
        # A power of two takes squares out of reach of overflow, and rounds nothing.
        exponent = int(np.frexp(np.abs(given).max())[1])
        scaled = np.ldexp(given, -exponent)
        centre = scaled[loop].mean(axis=0)
        centred = scaled - centre
        _check_geometry(centred, corners)
        _warn_if_far(centre, centred)
        chords = centred[np.roll(loop, -1)] - centred[loop]
        lengths = np.linalg.norm(chords, axis=1)
        total = float(lengths.sum())
        short = lengths < _SHORTEST_EDGE * total
        ends = np.stack([loop, np.roll(loop, -1)], axis=1)
        problem = f"is shorter than {_SHORTEST_EDGE:g} of the loop: merge its two vertices"
        _refuse_edge(ends, short, problem)
        length = float(np.ldexp(total, exponent))
        return cls(centred / total, corners, loop, lengths / total, length)

    def with_triangles(self, triangles: IntArray) -> Disk:
        """Return the mesh with other triangles (n_t, 3) on the same vertices and loop.

        Or with more vertices inside, behind those of the loop. Inside, vertices rest where
        each is the mean of its neighbours (Tutte 1963), which leaves no triangle turned
        over if the loop is convex.
        """
        from scipy.sparse import coo_array, diags_array
        from scipy.sparse.linalg import splu

        n_v = int(triangles.max()) + 1
        start, end = np.unique(directed_edges(triangles), axis=0).T
        between = coo_array((np.ones(len(start)), (start, end)), shape=(n_v, n_v))
        joined = (between + between.T).tocsr()
        joined.data[:] = 1.0
        degree = diags_array(joined.sum(axis=1))
        interior = np.setdiff1d(np.arange(n_v), self.loop)
        rows = (degree - joined).tocsr()[interior]
        x = np.zeros((n_v, 3))
        x[self.loop] = self.x[self.loop]
        if len(interior):
            pull = rows[:, self.loop] @ x[self.loop]
            x[interior] = -splu(rows[:, interior].tocsc()).solve(pull)
        return replace(self, x=x, triangles=triangles)

    def parts(self, loop: IntArray) -> IntArray:
        """Return into how many equal parts each loop edge (n_b,) is cut in a finer loop.

        loop : (m,) int, this mesh's vertices among others, whose numbers are beyond these
        """
        parts: IntArray = np.diff(np.flatnonzero(loop < self.n_v), append=len(loop))
        return parts

    def with_loop(self, loop: IntArray) -> Disk:
        """Return the mesh on a finer loop (m,), of which it has no triangles yet."""
        if len(loop) == self.n_b:
            return self
        parts, start = self.parts(loop), self.x[self.loop]
        step = (np.roll(start, -1, axis=0) - start) / parts[:, None]
        past = np.arange(len(loop)) - np.repeat(np.cumsum(parts) - parts, parts)
        x = np.zeros((int(loop.max()) + 1, 3))
        x[loop] = np.repeat(start, parts, axis=0)
        x[loop] += past[:, None] * np.repeat(step, parts, axis=0)
        rest_lengths = np.repeat(self.rest_lengths / parts, parts)
        return replace(self, x=x, loop=loop, rest_lengths=rest_lengths)

    @property
    def n_v(self) -> int:
        """Number of vertices."""
        return len(self.x)

    @property
    def n_b(self) -> int:
        """Number of loop vertices, which is also the number of loop edges."""
        return len(self.loop)

    @cached_property
    def shape(self) -> Shape:
        """The disk at rest, as a shape."""
        return Shape(self.x, self.triangles, self.loop)

    @cached_property
    def edges(self) -> IntArray:
        """All edges (n_e, 2), each once, as sorted vertex pairs."""
        return np.unique(np.sort(directed_edges(self.triangles), axis=1), axis=0)

    @cached_property
    def interior_edges(self) -> IntArray:
        """Edges (n_e - n_b, 2) that do not belong to the loop."""
        ends = np.sort(np.stack([self.loop, np.roll(self.loop, -1)], axis=1), axis=1)
        on_loop = np.isin(self.edges @ (self.n_v, 1), ends.astype(np.int64) @ (self.n_v, 1))
        return self.edges[~on_loop]

    @cached_property
    def interior(self) -> IntArray:
        """Vertices (n_v - n_b,) that do not belong to the loop, ascending."""
        return np.setdiff1d(np.arange(self.n_v), self.loop)

    @cached_property
    def second_ring(self) -> tuple[IntArray, IntArray]:
        """The vertices at most two edges from each loop vertex, itself left out.

        Where in the second array (n,) those of loop vertex v begin (n_b,), and vertices.
        """
        graph = neighbours_by_vertex(self.edges, self.n_v)
        row, column = around(*graph, self.loop)
        whose, beyond = around(*graph, column)
        ends = np.concatenate([row, row[whose]]), np.concatenate([column, beyond])
        row, column = np.divmod(np.unique(ends[0] * self.n_v + ends[1]), self.n_v)
        other = column != self.loop[row]
        return np.searchsorted(row[other], np.arange(self.n_b)), column[other]

    @cached_property
    def digest(self) -> str:
        """SHA-256 of positions and triangles: the mesh's identity in run.json."""
        content = self.x.tobytes() + self.triangles.tobytes()
        return hashlib.sha256(content).hexdigest()


def _check_arrays(points: FloatArray, triangles: IntArray) -> None:
    if points.ndim != 2 or points.shape[1] != 3:
        raise MeshError("mesh", None, f"points have shape {points.shape}, not (n_v, 3)")
    if triangles.ndim != 2 or triangles.shape[1] != 3 or len(triangles) == 0:
        raise MeshError(
            "mesh", None, f"triangles have shape {triangles.shape}, not (n_t, 3), n_t > 0"
        )
    _refuse("vertex", ~np.isfinite(points).all(axis=1), "a coordinate is not finite")
    outside = ((triangles < 0) | (triangles >= len(points))).any(axis=1)
    _refuse("triangle", outside, f"uses a vertex outside 0 ... {len(points) - 1}")
    repeated = (triangles == np.roll(triangles, 1, axis=1)).any(axis=1)
    _refuse("triangle", repeated, "names the same vertex twice")
    used = np.bincount(triangles.ravel(), minlength=len(points)) > 0
    _refuse("vertex", ~used, "belongs to no triangle")


def trace_disk(n_v: int, triangles: IntArray) -> IntArray:
    """Return the loop; raise MeshError unless the triangles form an oriented disk."""
    half = directed_edges(triangles)
    key = np.sort(half, axis=1) @ np.array([n_v, 1])
    _, first, side, count = np.unique(
        key, return_index=True, return_inverse=True, return_counts=True
    )
    _refuse_edge(half[first], count > 2, "belongs to more than two triangles")
    _, forward, twice = np.unique(
        half @ np.array([n_v, 1]), return_index=True, return_counts=True
    )
    _refuse_edge(
        half[forward],
        twice > 1,
        "is passed in the same direction by both its triangles: orient them alike",
    )
    by_edge, last = np.argsort(side, kind="stable") // 3, np.cumsum(count) - 1
    inner = last[count == 2]
    piece = components(by_edge[inner - 1], by_edge[inner], len(triangles))
    if piece.any():
        stray, pieces = int(np.flatnonzero(piece)[0]), int(piece.max()) + 1
        raise MeshError(
            "triangle", stray, f"is not joined by an edge to triangle 0: {pieces} pieces"
        )
    loop = _trace_loop(n_v, half[count[side] == 1])
    euler = n_v - len(first) + len(triangles)
    if euler != 1:
        raise MeshError("mesh", None, f"Euler characteristic {euler}; a disk has 1")
    return loop


def _trace_loop(n_v: int, border: IntArray) -> IntArray:
    """Order the directed boundary edges (n_b, 2) into one cycle."""
    if len(border) == 0:
        raise MeshError("mesh", None, "the surface is closed; a disk has a boundary")
    leaving = np.bincount(border[:, 0], minlength=n_v)
    _refuse("vertex", leaving > 1, "the boundary passes here more than once")
    follower = np.full(n_v, -1)
    follower[border[:, 0]] = border[:, 1]
    loop = [int(border[:, 0].min())]
    while (after := int(follower[loop[-1]])) != loop[0]:
        loop.append(after)
    if len(loop) != len(border):
        stray = int(np.setdiff1d(border[:, 0], loop)[0])
        raise MeshError("vertex", stray, "lies on a second boundary loop; a disk has one")
    return np.array(loop, dtype=np.int64)


def _check_geometry(points: FloatArray, triangles: IntArray) -> None:
    half = directed_edges(triangles)
    lengths = np.linalg.norm(points[half[:, 1]] - points[half[:, 0]], axis=1)
    _refuse_edge(half, lengths == 0.0, "has no length: its two vertices coincide")
    a, b, c = points[triangles].transpose(1, 0, 2)
    longest = lengths.reshape(-1, 3).max(axis=1)[:, None]
    doubled = np.linalg.norm(np.cross((b - a) / longest, (c - a) / longest), axis=1)
    _refuse("triangle", doubled <= _ZERO_AREA, "has no area")


def _warn_if_far(centre: FloatArray, centred: FloatArray) -> None:
    size = float(np.linalg.norm(np.ptp(centred, axis=0)))
    away = float(np.linalg.norm(centre)) / size
    if away > _FAR:
        loss = 100 * float(np.finfo(np.float64).eps) * away
        _log.warning(
            "the mesh lies %.2g times its size from the origin: expect relative errors "
            "of up to %.1g, and move it to the origin where it is made",
            away,
            loss,
        )


def _refuse(kind: str, mask: ArrayLike, problem: str) -> None:
    wrong = np.asarray(mask)
    if wrong.any():
        raise MeshError(kind, int(np.flatnonzero(wrong)[0]), problem)


def _refuse_edge(edges: IntArray, mask: ArrayLike, problem: str) -> None:
    wrong = np.asarray(mask)
    if wrong.any():
        start, end = edges[np.flatnonzero(wrong)[0]]
        raise MeshError("edge", (int(start), int(end)), problem)
