"""Finer triangles inside a soap film near places where strands of its loop cross.

There the film is a helicoid as narrow as the strands are apart, and elsewhere nearly flat.
Along a strand its normal turns by a right angle over about that width: triangles that end
on longer edges of the loop are thin or cannot follow, so that these are cut there as well.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.linalg import LinAlgError

from eulerplateau.arrays import BoolArray, FloatArray, IntArray
from eulerplateau.film.harmonic import follower
from eulerplateau.film.repair import mend_triangles
from eulerplateau.film.tiling import Tiling

# How long edges may be over their distance from the nearest place.
_GROWTH = 0.2
# How long edges from the loop inwards may be over the loop's own, at the least: on one of
# those shorter ones make thin triangles.
_AT_LOOP = 0.7
# By how much an edge is too long where refinement begins, again too: it leaves none that is
# too long at all, and as the place moves on along the loop edges slide and stretch.
_SLACK = 1.3
# In one round no triangle is halved twice; triangles are mended once in so many.
_ROUNDS, _MENDED = 60, 3
# How often a film is smoothed at the end.
_SMOOTHED = 5


@dataclass(frozen=True)
class EdgeSizes:
    """How long edges of a film may be, the longer the farther away from places (k, 3)."""

    places: FloatArray
    finest: float

    def at(self, x: FloatArray) -> FloatArray:
        """Return the length (n,) that edges may have whose middles are at x (n, 3)."""
        away = np.linalg.norm(x[:, None] - self.places, axis=2).min(axis=1)
        sizes: FloatArray = np.maximum(self.finest, _GROWTH * away)
        return sizes


@dataclass(frozen=True)
class Finer:
    """How fine a film is to be.

    Attributes
    ----------
    sizes : of its edges inside
    parts : (n_b,) int, into how many equal ones each edge of its loop is cut
    x_loop : (m, 3) float, where the vertices of that finer loop are
    most : how many vertices it may come to
    """

    sizes: EdgeSizes
    parts: IntArray
    x_loop: FloatArray
    most: int


def refined(
    tiling: Tiling, x: FloatArray, sizes: EdgeSizes, most: int
) -> tuple[Tiling, FloatArray]:
    """Return a film (n_v, 3) whose edges inside are as short as they should be.

    Vertices are added behind those there are, up to `most` in all; the loop stays.
    The film as it was if no edge is too long by a third.
    """
    edges = _Edges.of(tiling, x)
    if not (edges.inside & (edges.lengths > _SLACK * edges.allowed(sizes))).any():
        return tiling, x
    for number in range(_ROUNDS):
        halved = _halved(tiling, x, sizes)
        if halved is None or halved[0].n_v > most:
            break
        tiling, x = halved if number % _MENDED else _smoothed(*halved)
    for _ in range(_SMOOTHED):
        tiling, x = _smoothed(tiling, x)
    return mend_triangles(tiling, x)


def _smoothed(tiling: Tiling, x: FloatArray) -> tuple[Tiling, FloatArray]:
    """Return the film (n_v, 3) with better triangles and, if that takes area, harmonic.

    With the cotangent weights of what it was (Pinkall and Polthier 1993): where the mesh's
    film was too coarse for its waist it lies in folds, and so does a finer one at first.
    """
    tiling, x = mend_triangles(tiling, x)
    try:
        after = follower(tiling, tiling.sides(x)).extend(x[tiling.loop])
    except LinAlgError:
        return tiling, x
    return (tiling, after) if tiling.change(x, after) < 0.0 else (tiling, x)


def with_cut_loop(tiling: Tiling, x: FloatArray, finer: Finer) -> tuple[Tiling, FloatArray]:
    """Return a film (n_v, 3) whose loop is finer: itself if all parts are 1.

    Vertices are added behind those there are.
    """
    parts, x_loop = finer.parts, finer.x_loop
    if len(x_loop) == len(parts):
        return tiling, x
    ends = np.column_stack([tiling.loop, np.roll(tiling.loop, -1)])
    edge = np.repeat(np.arange(len(parts)), parts)
    added = np.diff(edge, prepend=-1) == 0
    loop = np.empty_like(edge)
    loop[~added] = tiling.loop
    loop[added] = tiling.n_v + np.arange(added.sum())
    triangles, left = tiling.triangles, np.flatnonzero(parts > 1)
    while len(left):
        side = _sides_at(triangles, ends[left])
        # A triangle in a corner has two edges of the loop: one after the other is cut.
        triangle, first = np.unique(side // 3, return_index=True)
        apex = np.zeros_like(parts)
        apex[left[first]] = triangles[triangle, (side[first] + 2) % 3]
        now = np.isin(edge, left[first])
        fan = np.column_stack([loop, np.roll(loop, -1), apex[edge]])[now]
        triangles = np.concatenate([np.delete(triangles, triangle, axis=0), fan])
        left = np.delete(left, first)
    inside = np.setdiff1d(np.arange(tiling.n_v), loop)
    return mend_triangles(Tiling(triangles, loop, inside), np.vstack([x, x_loop[added]]))


def _sides_at(triangles: IntArray, ends: IntArray) -> IntArray:
    """Return which sides of triangles, 3 t + j, lead from one vertex to another (k, 2)."""
    n_v = int(triangles.max()) + 1
    number = (triangles * n_v + np.roll(triangles, -1, axis=1)).ravel()
    order = np.argsort(number)
    side: IntArray = order[np.searchsorted(number, ends @ (n_v, 1), sorter=order)]
    return side


@dataclass(frozen=True)
class _Edges:
    """The edges of a film: n_e of them, and those of each triangle.

    Attributes
    ----------
    of_triangles : (n_t, 3) int, those from each corner to the next
    middles : (n_e, 3) float
    lengths : (n_e,) float
    inside : (n_e,) bool, whether they belong to two triangles
    least : (n_e,) float, how long they may be wherever they are
    """

    of_triangles: IntArray
    middles: FloatArray
    lengths: FloatArray
    inside: BoolArray
    least: FloatArray

    def allowed(self, sizes: EdgeSizes) -> FloatArray:
        """Return how long edges may be (n_e,)."""
        allowed: FloatArray = np.maximum(sizes.at(self.middles), self.least)
        return allowed

    @classmethod
    def of(cls, tiling: Tiling, x: FloatArray) -> _Edges:
        """Return those of a film (n_v, 3)."""
        corners = tiling.triangles
        ends = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2), axis=2)
        first, place, count = np.unique(
            ends @ (tiling.n_v, 1), return_inverse=True, return_counts=True
        )
        one, other = x[first // tiling.n_v], x[first % tiling.n_v]
        loop = x[tiling.loop]
        chords = np.linalg.norm(np.roll(loop, -1, axis=0) - loop, axis=1)
        least = np.zeros(tiling.n_v)
        least[tiling.loop] = _AT_LOOP * 0.5 * (chords + np.roll(chords, 1))
        return cls(
            place.reshape(corners.shape),
            0.5 * (one + other),
            np.linalg.norm(one - other, axis=1),
            count == 2,
            np.maximum(least[first // tiling.n_v], least[first % tiling.n_v]),
        )


def _halved(
    tiling: Tiling, x: FloatArray, sizes: EdgeSizes
) -> tuple[Tiling, FloatArray] | None:
    """Return a film some of whose edges that are too long are halved; None if none is.

    Those that are the longest such edge of both their triangles (Rivara 1984).
    """
    edges = _Edges.of(tiling, x)
    long = edges.inside & (edges.lengths > edges.allowed(sizes))
    if not long.any():
        return None
    # Ranks, in place of lengths: on a mesh with a symmetry these are equal in pairs.
    rank = np.zeros(len(long), dtype=np.int64)
    rank[np.flatnonzero(long)[np.argsort(edges.lengths[long])]] = 1 + np.arange(long.sum())
    side = rank[edges.of_triangles].argmax(axis=1)
    longest = np.take_along_axis(edges.of_triangles, side[:, None], axis=1)[:, 0]
    halved = long & (np.bincount(longest, minlength=len(long)) == 2)
    number = tiling.n_v + np.cumsum(halved) - 1
    cut = halved[longest]
    turn = (side[cut, None] + np.arange(3)) % 3
    one, other, apex = np.take_along_axis(tiling.triangles[cut], turn, axis=1).T
    middle = number[longest[cut]]
    parts = [(one, middle, apex), (middle, other, apex)]
    triangles = [tiling.triangles[~cut], *(np.column_stack(part) for part in parts)]
    more = np.arange(tiling.n_v, tiling.n_v + halved.sum())
    finer = Tiling(
        np.concatenate(triangles), tiling.loop, np.concatenate([tiling.interior, more])
    )
    return finer, np.vstack([x, edges.middles[halved]])
