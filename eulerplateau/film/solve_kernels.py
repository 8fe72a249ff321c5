"""Solutions with the fronts of a Cholesky factor, one after the other: compiled loops.

Arrays in, arrays out. Fronts are small, and a call of BLAS for each would cost more than
its work. The factor of front p is data[first[p]:], column by column: C (n, n), then F_21
C^-T (n_around, n), see elimination.py.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from eulerplateau.arrays import FloatArray, IntArray


@njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
def solve_fronts(
    starts: IntArray,
    stops: IntArray,
    pointer: IntArray,
    around: IntArray,
    first: IntArray,
    data: FloatArray,
    columns: FloatArray,
) -> None:
    """Replace columns (m, N) of right-hand sides, in the order of the rows, by solutions.

    Front p has rows starts[p] ... stops[p] - 1 and hangs on the rows
    around[pointer[p]:pointer[p + 1]]. Rows of no front are held: they become zero.
    """
    widest, inside = 0, stops[-1] if len(stops) else 0
    for p in range(len(starts)):
        widest = max(widest, pointer[p + 1] - pointer[p])
    beyond = np.empty(widest)
    for c in range(len(columns)):
        x = columns[c]
        for p in range(len(starts)):
            start, n = starts[p], stops[p] - starts[p]
            rows = around[pointer[p] : pointer[p + 1]]
            m, at = len(rows), first[p]
            own, left = x[start : start + n], beyond[:m]
            left[:] = 0.0
            for j in range(n):
                value = own[j] / data[at + j]
                own[j] = value
                column = data[at : at + n]
                for i in range(j + 1, n):
                    own[i] -= column[i] * value
                at += n
            for j in range(n):
                column, value = data[at : at + m], own[j]
                for i in range(m):
                    left[i] += column[i] * value
                at += m
            for i in range(m):
                x[rows[i]] -= left[i]
        x[inside:] = 0.0
        for p in range(len(starts) - 1, -1, -1):
            start, n = starts[p], stops[p] - starts[p]
            rows = around[pointer[p] : pointer[p + 1]]
            m, at = len(rows), first[p]
            own, known = x[start : start + n], beyond[:m]
            for i in range(m):
                known[i] = x[rows[i]]
            for j in range(n - 1, -1, -1):
                pull = 0.0
                beside = data[at + n * n + j * m : at + n * n + (j + 1) * m]
                for i in range(m):
                    pull += beside[i] * known[i]
                column = data[at + j * n : at + (j + 1) * n]
                for i in range(j + 1, n):
                    pull += column[i] * own[i]
                own[j] = (own[j] - pull) / column[j]
