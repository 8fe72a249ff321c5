"""A coarser soap film for a rough start: its minimum is nearly that of the fine one.

Down from a rough start a large film takes dozens of steps, most of them where ways lead
down, each of several factorisations; from the coarse film's minimum it takes a few.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh import Disk
from eulerplateau.solvers.large_loops.coarse_start import CoarseLoop


def coarse_disk(disk: Disk, coarse: CoarseLoop) -> Disk:
    """Return a disk on some of the vertices of another's loop, as many as are kept.

    Its vertices inside are those of rings in the unit disk. Raises MeshError where the
    loop is such that they would lie outside it.
    """
    kept = coarse.kept
    triangles = ring_triangles(len(kept))
    x = np.zeros((int(triangles.max()) + 1, 3))
    x[: len(kept)] = disk.x[disk.loop[kept]]
    loop = np.arange(len(kept))
    whole = Disk(x, triangles, loop, coarse.loop.rest_lengths, disk.length)
    return whole.with_triangles(triangles)


def ring_triangles(n_b: int) -> IntArray:
    """Return triangles (n_t, 3) of a disk, its loop the first n_b vertices."""
    from scipy.spatial import Delaunay

    count = round(n_b / (2 * np.pi))
    rings = [_ring(round(n_b * j / count), j / count) for j in range(count, 0, -1)]
    points = np.concatenate([*rings, np.zeros((1, 2))])
    # In the plane SciPy's triangles are counter-clockwise.
    return np.asarray(Delaunay(points).simplices, dtype=np.int64)


def _ring(size: int, radius: float) -> FloatArray:
    angle = 2.0 * np.pi * np.arange(size) / size
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
