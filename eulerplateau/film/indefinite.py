"""A sparse symmetric matrix that need not be definite, factorised front by front.

By the same fronts as Cholesky's (elimination.py), the rows of each by Bunch and Kaufman's
L D L^T, pivots chosen among them. Where no block of rows is eliminated before what makes it
regular that is stable, and by Sylvester's law the pivots count the negative eigenvalues.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError
from scipy.linalg.blas import dgemm
from scipy.linalg.lapack import dsytrf, dsytrs

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.compiling import njit
from eulerplateau.film.elimination import Elimination
from eulerplateau.film.front_kernels import factorise_fronts
from eulerplateau.film.solve_kernels import solve_symmetric_rows

# Rows of fronts up to which compiled loops are faster than LAPACK; columns of its blocks.
_COMPILED, _COLUMNS = 256, 32


@dataclass(frozen=True)
class IndefiniteFactor:
    """A factorised matrix (n, n); `n_negative` of its eigenvalues are negative."""

    n_negative: int
    _order: IntArray
    _packed: tuple[IntArray, IntArray, IntArray, IntArray, FloatArray]

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Return the solution (n, m) for right-hand sides (n, m)."""
        found = np.empty(rhs.shape)
        solve_symmetric_rows(*self._packed, self._order, rhs, found)
        return found


def factorise_indefinite(elimination: Elimination, entries: FloatArray) -> IndefiniteFactor:
    """Factorise a symmetric matrix with these entries (m,), kept rows last.

    Raises LinAlgError if a pivot vanishes. The caller sees to it that BLAS has one thread.
    """
    # Factors and responses F_11^-1 F_12 at once where they are read: copies are as large.
    rows, size = elimination.room
    pivots, data = np.empty(rows, dtype=np.int64), np.empty(size)
    fill = _fill if elimination.largest <= _COMPILED else _fill_by_lapack
    negative = fill(elimination, entries, pivots, data)
    packed = (*elimination.hung, pivots, data)
    return IndefiniteFactor(negative, elimination.order, packed)


def _fill(
    elimination: Elimination, entries: FloatArray, pivots: IntArray, data: FloatArray
) -> int:
    """Fill in pivots (n,) and data by compiled loops; return the negative eigenvalues."""
    negative = factorise_fronts(entries, *elimination.packed, pivots, data)
    if negative < 0:
        raise LinAlgError("a pivot vanishes")
    return negative


def _fill_by_lapack(
    elimination: Elimination, entries: FloatArray, pivots: IntArray, data: FloatArray
) -> int:
    """Fill in the same by LAPACK, which is faster with fronts that do not fit a cache."""
    filled, negative = 0, 0
    remainders: dict[int, FloatArray] = {}
    for number, front in elimination.filled:
        own = front.stop - front.start
        block = front.assemble(entries, remainders)
        factor, chosen, failed = dsytrf(block[:own, :own], lower=1, lwork=_COLUMNS * own)
        if failed:
            raise LinAlgError("a pivot vanishes")
        pivots[front.start : front.stop] = chosen
        negative += negative_pivots(factor, chosen)
        here = data[filled : (filled := filled + own * front.size)]
        here[: own * own] = factor.ravel("F")
        if own < front.size:
            below = block[own:, :own]
            response = dsytrs(factor, chosen, below.T, lower=1)[0]
            remainders[number] = dgemm(-1.0, below, response, 1.0, block[own:, own:])
            here[own * own :] = response.ravel("F")
    return negative


@njit(cache=True)
def negative_pivots(factor: FloatArray, pivots: IntArray) -> int:
    """Count negative eigenvalues in Bunch and Kaufman's D; 2 x 2 pivots have one each."""
    twice = 0
    for j in range(pivots.shape[0]):
        if pivots[j] < 0:
            twice += 1
        elif factor[j, j] < 0.0:
            twice += 2
    return twice // 2
