"""Compiled loops of the elimination."""

from __future__ import annotations

from numba import njit

from eulerplateau.arrays import FloatArray, IntArray


@njit(cache=True)
def add_block(block: FloatArray, place: IntArray, total: FloatArray) -> None:
    """Add a block (m, m) to the rows and columns `place` (m,) of `total` (n, n)."""
    for i in range(place.shape[0]):
        for j in range(place.shape[0]):
            total[place[i], place[j]] += block[i, j]
