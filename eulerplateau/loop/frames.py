"""Which way a rod's cross-sections point along its loop: its material frame.

A direction across the rod that is carried along without turning about it (parallel
transport) comes back turned by the loop's writhe. The rod's own turn with its twist, which
is the same everywhere: together, round the loop, by what it was given before it was welded.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.loop import differences
from eulerplateau.loop.writhe_kernels import transported


def directors(x: FloatArray, twist: float) -> FloatArray:
    """Return directions (n, 3) across the edges of a loop x (n, 3), turning with the rod.

    In the middle of each edge. `twist` is in turns, right-handed ones positive. The weld is
    at the first vertex, where the first direction and the last differ by what twist and
    writhe together are no whole number of turns.
    """
    edges = differences(x)
    lengths = np.linalg.norm(edges, axis=1)
    tangents = edges / lengths[:, None]
    # Any direction will do to begin with: the axis along which the first edge is shortest.
    first = np.cross(tangents[0], np.eye(3)[np.abs(tangents[0]).argmin()])
    unturned = transported(tangents, first / np.linalg.norm(first))
    middles = (np.cumsum(lengths) - 0.5 * lengths) / lengths.sum()
    angle = 2 * np.pi * twist * middles[:, None]
    turned: FloatArray = np.cos(angle) * unturned
    turned += np.sin(angle) * np.cross(tangents, unturned)
    return turned
