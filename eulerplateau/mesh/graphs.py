"""Graphs as pairs of vertices: their neighbours, and what hangs together.

SciPy knows both, and takes longer to load than some sweeps to carry out.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import IntArray


def components(one: IntArray, other: IntArray, n: int) -> IntArray:
    """Return the number of the component (n,) of each of n vertices.

    Those of an edge, one (m,) and other (m,), are in the same. Components are numbered by
    their first vertices.
    """
    # In every round a component joins the first beside it, which leaves a quarter or so.
    root = np.arange(n)
    while len(one):
        a, b = root[one], root[other]
        apart = np.flatnonzero(a != b)
        one, other, a, b = one[apart], other[apart], a[apart], b[apart]
        np.minimum.at(root, np.maximum(a, b), np.minimum(a, b))
        while not np.array_equal(above := root[root], root):
            root = above
    return np.unique(root, return_inverse=True)[1]


def neighbours_by_vertex(edges: IntArray, n: int) -> tuple[IntArray, IntArray]:
    """Return the neighbours of n vertices, one vertex after the other, by edges (m, 2).

    First where those of each begin (n + 1,), where they end being where the next ones
    begin; then neighbours (2 m,).
    """
    start, end = np.concatenate([edges, edges[:, ::-1]]).T
    first = np.append(0, np.cumsum(np.bincount(start, minlength=n)))
    return first, end[np.argsort(start, kind="stable")]


def around(
    first: IntArray, neighbours: IntArray, vertices: IntArray
) -> tuple[IntArray, IntArray]:
    """Return the neighbours (m,) of vertices (k,), and before that of which (m,) they are.

    By number, 0 to k - 1; `first` and `neighbours` as from `neighbours_by_vertex`.
    """
    begin, counts = first[vertices], first[vertices + 1] - first[vertices]
    whose = np.repeat(np.arange(len(vertices)), counts)
    ahead = np.repeat(begin - np.cumsum(counts) + counts, counts)
    return whose, neighbours[np.arange(len(whose)) + ahead]
