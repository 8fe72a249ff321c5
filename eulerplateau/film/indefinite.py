"""A sparse symmetric matrix that need not be definite, factorised front by front.

By the same fronts as Cholesky's (elimination.py), the rows of each by Bunch and Kaufman's
L D L^T, pivots chosen among them. Where no block of rows is eliminated before what makes it
regular that is stable, and by Sylvester's law the pivots count the negative eigenvalues.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import LinAlgError
from scipy.linalg.blas import dgemm
from scipy.linalg.lapack import dsytrf, dsytrs

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.compiled import njit
from eulerplateau.film.elimination import Elimination
from eulerplateau.film.solve_kernels import solve_symmetric_fronts

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


@dataclass(frozen=True)
class IndefiniteFactor:
    """A factorised matrix (n, n); `n_negative` of its eigenvalues are negative."""

    n_negative: int
    _order: IntArray
    _parts: tuple[_Part, ...]

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Return the solution (n, m) for right-hand sides (n, m)."""
        columns = np.ascontiguousarray(rhs[self._order].T)
        solve_symmetric_fronts(*self._packed, columns)
        x = np.empty((len(self._order), len(columns)))
        x[self._order] = columns.T
        return x

    @cached_property
    def _packed(self) -> tuple[IntArray, IntArray, IntArray, IntArray, FloatArray]:
        """All parts as arrays, for solve_kernels.py."""
        parts = self._parts
        starts = np.array([part.start for part in parts])
        counts = np.cumsum([0, *(len(part.around) for part in parts)])
        around = np.concatenate([part.around for part in parts])
        pieces = [piece for part in parts for piece in (part.factor, part.response)]
        return (
            starts,
            counts,
            around,
            np.concatenate([part.pivots for part in parts]),
            np.concatenate([piece.ravel("F") for piece in pieces]),
        )


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
