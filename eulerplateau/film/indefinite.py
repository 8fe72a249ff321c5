"""A sparse symmetric matrix that need not be definite, factorised front by front.

By the same fronts as Cholesky's (elimination.py), the rows of each by Bunch and Kaufman's
L D L^T, pivots chosen among them. Where no block of rows is eliminated before what makes it
regular that is stable, and by Sylvester's law the pivots count the negative eigenvalues.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy.linalg import LinAlgError
from scipy.linalg.blas import dgemm
from scipy.linalg.lapack import dsytrf, dsytrs

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film.elimination import Elimination

# Columns of LAPACK's blocks.
_COLUMNS = 32


@dataclass(frozen=True)
class _Part:
    """Rows start ... stop - 1: their block's factor, and how they hang on those around.

    response : (n, n_around) float, F_11^-1 F_12
    """

    start: int
    stop: int
    around: IntArray
    response: FloatArray
    factor: FloatArray
    pivots: IntArray

    def solve(self, own: FloatArray) -> FloatArray:
        """Return F_11^-1 own (n, m)."""
        found: FloatArray = dsytrs(self.factor, self.pivots, own, lower=1)[0]
        return found


@dataclass(frozen=True)
class IndefiniteFactor:
    """A factorised matrix (n, n); `n_negative` of its eigenvalues are negative."""

    n_negative: int
    _order: IntArray
    _parts: tuple[_Part, ...]

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Return the solution (n, m) for right-hand sides (n, m)."""
        ordered = rhs[self._order]
        for part in self._parts:
            own = ordered[part.start : part.stop]
            ordered[part.around] -= part.response.T @ own
            ordered[part.start : part.stop] = part.solve(own)
        for part in reversed(self._parts):
            ordered[part.start : part.stop] -= part.response @ ordered[part.around]
        x = np.empty_like(ordered)
        x[self._order] = ordered
        return x


def factorise_indefinite(elimination: Elimination, entries: FloatArray) -> IndefiniteFactor:
    """Factorise a symmetric matrix with these entries (m,), kept rows last.

    Raises LinAlgError if a pivot vanishes. The caller sees to it that BLAS has one thread.
    """
    parts: list[_Part] = []
    remainders: dict[int, FloatArray] = {}
    negative = 0
    for number, front in enumerate(elimination.fronts):
        own = front.stop - front.start
        if not own:  # of nothing that is kept
            continue
        block = front.assemble(entries, remainders)
        factor, pivots, failed = dsytrf(block[:own, :own], lower=1, lwork=_COLUMNS * own)
        if failed:
            raise LinAlgError("a pivot vanishes")
        negative += negative_pivots(factor, pivots)
        below = block[own:, :own]
        response = np.zeros((own, 0))
        if len(below):
            response = dsytrs(factor, pivots, below.T, lower=1)[0]
            remainders[number] = dgemm(-1.0, below, response, 1.0, block[own:, own:])
        parts.append(_Part(front.start, front.stop, front.around, response, factor, pivots))
    return IndefiniteFactor(negative, elimination.order, tuple(parts))


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
