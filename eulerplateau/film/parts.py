"""Dense blocks of a symmetric matrix, of each of which the first rows are eliminated."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate

import numpy as np
from numpy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.lapack import dpotrf, dsyrk, dtrsm


@dataclass(frozen=True)
class Part:
    """Rows start ... stop - 1 of the order, which hang on those `around` them.

    With the factor C, Cholesky's and lower, of what is eliminated, in equilibrium
    x[start:stop] = -C^-T half^T x[around].

    Attributes
    ----------
    half : (n_around, n) float, F_21 C^-T
    factor : (n, n) float
    """

    start: int
    stop: int
    around: IntArray
    half: FloatArray
    factor: FloatArray

    def unfolded(self, x: FloatArray, inside: FloatArray | None = None) -> FloatArray:
        """Return x[start:stop] (n, m) of x[around]: in equilibrium, plus C^-T inside."""
        own = -self.half.T @ x
        if inside is not None:
            own += inside
        found: FloatArray = dtrsm(1.0, self.factor, own, lower=1, trans_a=1)
        return found

    def pulled(self, own: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return C^-1 f and what that leaves of forces f (n, m) on the rows around."""
        inside: FloatArray = dtrsm(1.0, self.factor, own, lower=1)
        return inside, -self.half @ inside


@dataclass(frozen=True)
class Parts:
    """The parts of a factor, first eliminated first, and what compiled loops read of them.

    Attributes
    ----------
    packed : starts, stops, pointer, around, first, data
        As solve_kernels.solve_fronts takes them; the parts' arrays are views of the last.
    """

    each: tuple[Part, ...]
    packed: tuple[IntArray, IntArray, IntArray, IntArray, IntArray, FloatArray]


def parts_of(starts: list[int], stops: list[int], around: list[IntArray]) -> Parts:
    """Return the parts of these rows, their arrays yet to be filled in."""
    own = [stop - start for start, stop in zip(starts, stops, strict=True)]
    counts = [len(rows) for rows in around]
    first = [0, *accumulate(n * (n + m) for n, m in zip(own, counts, strict=True))]
    data = np.empty(first.pop())
    each = []
    for start, n, rows, at in zip(starts, own, around, first, strict=True):
        below = at + n * n
        factor = data[at:below].reshape((n, n), order="F")
        half = data[below : below + len(rows) * n].reshape((len(rows), n), order="F")
        each.append(Part(start, start + n, rows, half, factor))
    numbers = (starts, stops, [0, *accumulate(counts)], first)
    begins, ends, pointer, places = (np.array(n, dtype=np.int64) for n in numbers)
    beside = np.concatenate([np.zeros(0, dtype=np.int64), *around])
    return Parts(tuple(each), (begins, ends, pointer, beside, places, data))


def eliminate(block: FloatArray, own: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Eliminate the first `own` rows of a symmetric matrix, given below its diagonal.

    Returns F_21 C^-T, F_22 - F_21 F_11^-1 F_12 below its diagonal, and C, the factor of
    F_11.
    """
    factor, failed = dpotrf(block[:own, :own], lower=True)
    if failed:
        raise LinAlgError("what is eliminated is not positive definite")
    if own == len(block):
        return np.zeros((0, own)), np.zeros((0, 0)), factor
    half = dtrsm(1.0, factor, block[own:, :own], side=1, lower=1, trans_a=1)
    rest = dsyrk(-1.0, half, beta=1.0, c=block[own:, own:], lower=1)
    return half, rest, factor
