"""Where the distance of strands is least, as searches of strand_kernels find it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.strand_kernels import nearest_to_places, settle_each

# Where on each edge minima of a flat distance are sought from, in parts of it.
_BEGUN = 0.0, 0.25, 0.5, 0.75


def flat_minima(
    x: FloatArray, pieces: FloatArray, knots: FloatArray, reach: float, apart: float
) -> FloatArray:
    """Return where distances below reach are least: rows s, t, D, d2D/ds2 (k, 4).

    Along strands that lie beside each other, where D is flat, Newton's method from where
    two chords are nearest may leave a minimum for another: it begins at more places of each
    edge. Arguments are those of strand_kernels.nearest_pairs.
    """
    curve, limits = (x, pieces, knots), (reach, apart)
    rows = [
        rows_of(partial(nearest_to_places, *curve, np.full(len(x), part), *limits), 6)
        for part in _BEGUN
    ]
    s, t = np.vstack(rows)[:, 3:5].T.copy()
    held = np.zeros(len(s), dtype=bool)
    found: FloatArray = settle_each(pieces, knots, s, t, held)
    found[:, :2] %= knots[-1]
    off = np.abs(found[:, 0] - found[:, 1])
    along = np.minimum(off, knots[-1] - off)
    kept: FloatArray = found[(found[:, 2] < reach) & (along >= apart)]
    return kept


def rows_of(look: Callable[[FloatArray], int], columns: int) -> FloatArray:
    """Return all rows that a search finds, which is told how many it has room for."""
    room = 64
    while True:
        found = np.empty((room, columns))
        count = look(found)
        if count <= room:
            return found[:count]
        room = 2 * count
