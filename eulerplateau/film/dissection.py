"""Nested dissection: a planar graph cut into ever smaller pieces by small separators.

George (1973): eliminate the pieces first and the separators after them, and a
factorisation of a planar graph's matrix fills in as little as it can, n log n.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from eulerplateau.arrays import IntArray
from eulerplateau.compiling import njit

# Pieces of this many vertices are dense matrices that BLAS multiplies well.
LARGEST = 128
# Directions along which a piece may be cut.
_LANDMARKS = 8


class Graph(NamedTuple):
    """Which vertices have edges in common: those of v are indices[indptr[v]:indptr[v + 1]].

    One may be listed more than once, and be v itself.
    """

    indptr: IntArray
    indices: IntArray


def graph_of(row: IntArray, column: IntArray, n: int) -> Graph:
    """Return the graph of n vertices with the edges from row (m,) to column (m,)."""
    order = np.argsort(row, kind="stable")
    indptr = np.searchsorted(row[order], np.arange(n + 1))
    return Graph(indptr, column[order])


def dissect(
    graph: Graph, around: IntArray, inside: IntArray, largest: int = LARGEST
) -> list[IntArray]:
    """Cut the vertices `inside` a graph into parts, to be eliminated in this order.

    Vertices of two parts are neighbours only if one of the parts separates the other from
    the rest. Distances are counted in edges, from landmarks among the vertices `around`:
    vertices at one distance from a landmark separate the nearer from the farther. Pieces
    have up to `largest` vertices.
    """
    if len(inside) <= largest:
        return [inside] if len(inside) else []
    landmarks = around[np.linspace(0, len(around), _LANDMARKS, endpoint=False, dtype=int)]
    distance = _edges_away(graph, landmarks)[:, inside]
    # Pieces are numbered like a heap: 1 falls into 2 and 3, n into 2 n and 2 n + 1.
    piece = np.ones(len(inside), dtype=np.int64)
    active = np.arange(len(inside))
    while len(active):
        active = active[np.argsort(piece[active], kind="stable")]
        first = np.flatnonzero(np.diff(piece[active], prepend=0))
        size = np.diff(first, append=len(active))
        side = _sides(distance[:, active], first, size)
        # Separators keep the number of the piece they cut.
        piece[active] = np.where(side == 0, piece[active], 2 * piece[active] + (side > 0))
        active = active[side != 0]
        large = np.bincount(piece[active], minlength=1) > largest
        active = active[large[piece[active]]]
    order = np.argsort(-piece, kind="stable")
    cuts = np.flatnonzero(np.diff(piece[order])) + 1
    return list(np.split(inside[order], cuts))


def _sides(distance: IntArray, first: IntArray, size: IntArray) -> IntArray:
    """Return -1, 0 or 1 for vertices on the near side, the separator and the far side.

    distance : (landmarks, n), vertices sorted by piece; piece p has size[p] vertices from
    first[p]. Each piece is cut at the median distance from the landmark which it extends
    farthest from.
    """
    extent = np.maximum.reduceat(distance, first, axis=1)
    extent -= np.minimum.reduceat(distance, first, axis=1)
    axis = np.repeat(extent.argmax(axis=0), size)
    chosen = distance[axis, np.arange(len(axis))]
    number = np.repeat(np.arange(len(size)), size)
    ranked = chosen[np.lexsort((chosen, number))]
    side: IntArray = np.sign(chosen - np.repeat(ranked[first + size // 2], size))
    return side


def _edges_away(graph: Graph, sources: IntArray) -> IntArray:
    """Return the number of edges (m, n) between each of m sources and every vertex.

    It is n where none leads there.
    """
    n = len(graph.indptr) - 1
    steps = np.full((len(sources), n), n, dtype=np.int64)
    _count_edges(graph.indptr, graph.indices, sources, steps)
    return steps


@njit(cache=True)
def _count_edges(
    indptr: IntArray, indices: IntArray, sources: IntArray, steps: IntArray
) -> None:
    """Fill in `steps` (m, n), so far n: breadth first from each of the sources (m,)."""
    n = steps.shape[1]
    reached = np.empty(n, dtype=np.int64)
    for source in range(sources.shape[0]):
        away = steps[source]
        away[sources[source]] = 0
        reached[0] = sources[source]
        first, last = 0, 1
        while first < last:
            vertex = reached[first]
            first += 1
            for entry in range(indptr[vertex], indptr[vertex + 1]):
                other = indices[entry]
                if away[other] == n:
                    away[other] = away[vertex] + 1
                    reached[last] = other
                    last += 1
