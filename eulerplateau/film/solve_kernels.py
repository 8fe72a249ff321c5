"""Solutions with the fronts of a factor, one after the other: compiled loops.

Arrays in, arrays out. Fronts are small, and a call of BLAS for each would cost more than
its work.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.compiling import njit


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

    By Cholesky's factor, that of front p data[first[p]:], column by column: C (n, n), then
    F_21 C^-T (n_around, n), see elimination.py. Front p has rows starts[p] ... stops[p] - 1
    and hangs on the rows around[pointer[p]:pointer[p + 1]]. Rows of no front are held: they
    become zero.
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


@njit(cache=True, error_model="numpy")
def solve_rows(
    starts: IntArray,
    stops: IntArray,
    pointer: IntArray,
    around: IntArray,
    first: IntArray,
    data: FloatArray,
    order: IntArray,
    rhs: FloatArray,
    found: FloatArray,
) -> None:
    """Fill in the same of right-hand sides (n, m) of the first n rows, as rows (n, m).

    order : (N,), the place of each row in the factor
    """
    n, m = rhs.shape
    columns = np.zeros((m, len(order)))
    for k in range(n):
        for c in range(m):
            columns[c, k] = rhs[order[k], c]
    solve_fronts(starts, stops, pointer, around, first, data, columns)
    for k in range(n):
        for c in range(m):
            found[order[k], c] = columns[c, k]


@njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
def solve_symmetric_fronts(
    starts: IntArray,
    pointer: IntArray,
    around: IntArray,
    pivots: IntArray,
    data: FloatArray,
    columns: FloatArray,
) -> None:
    """Replace columns (m, N) of right-hand sides, in the order of the rows, by solutions.

    By a factor of indefinite.py, front after front in `data`, column by column: LAPACK's
    factor (n, n), then F_11^-1 F_12 (n, n_around). Front p has the rows from starts[p] on
    and hangs on the rows around[pointer[p]:pointer[p + 1]].
    """
    stops = np.append(starts[1:], columns.shape[1])
    for c in range(len(columns)):
        x, at = columns[c], 0
        for p in range(len(starts)):
            own, rows = x[starts[p] : stops[p]], around[pointer[p] : pointer[p + 1]]
            n, factor = len(own), at
            at += n * n
            for i in range(len(rows)):
                response, left = data[at : at + n], 0.0
                for j in range(n):
                    left += response[j] * own[j]
                x[rows[i]] -= left
                at += n
            _solve_pivoted(data[factor : factor + n * n], pivots[starts[p] : stops[p]], own)
        for p in range(len(starts) - 1, -1, -1):
            own, rows = x[starts[p] : stops[p]], around[pointer[p] : pointer[p + 1]]
            n = len(own)
            for i in range(len(rows) - 1, -1, -1):
                at -= n
                response, value = data[at : at + n], x[rows[i]]
                for j in range(n):
                    own[j] -= response[j] * value
            at -= n * n


@njit(cache=True, error_model="numpy")
def solve_symmetric_rows(
    starts: IntArray,
    pointer: IntArray,
    around: IntArray,
    pivots: IntArray,
    data: FloatArray,
    order: IntArray,
    rhs: FloatArray,
    found: FloatArray,
) -> None:
    """Fill in the same of right-hand sides as rows (N, m), placed by `order` (N,)."""
    n, m = rhs.shape
    columns = np.empty((m, n))
    for k in range(n):
        for c in range(m):
            columns[c, k] = rhs[order[k], c]
    solve_symmetric_fronts(starts, pointer, around, pivots, data, columns)
    for k in range(n):
        for c in range(m):
            found[order[k], c] = columns[c, k]


@njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
def _solve_pivoted(factor: FloatArray, pivots: IntArray, b: FloatArray) -> None:
    """Solve with Bunch and Kaufman's L D L^T as LAPACK's dsytrf leaves it, lower.

    factor : (n n,), column by column; b : (n,), replaced by the solution
    """
    n, k = len(b), 0
    while k < n:
        column = factor[k * n : (k + 1) * n]
        if pivots[k] > 0:
            _swap(b, k, pivots[k] - 1)
            for i in range(k + 1, n):
                b[i] -= column[i] * b[k]
            b[k] /= column[k]
            k += 1
            continue
        beside = factor[(k + 1) * n : (k + 2) * n]
        _swap(b, k + 1, -pivots[k] - 1)
        for i in range(k + 2, n):
            b[i] -= column[i] * b[k] + beside[i] * b[k + 1]
        between = column[k + 1]
        first, second = column[k] / between, beside[k + 1] / between
        one, other = b[k] / between, b[k + 1] / between
        b[k] = (second * one - other) / (first * second - 1)
        b[k + 1] = (first * other - one) / (first * second - 1)
        k += 2
    k = n - 1
    while k >= 0:
        two = pivots[k] < 0
        for row in range(k, k - 1 - two, -1):
            column, value = factor[row * n : (row + 1) * n], b[row]
            for i in range(k + 1, n):
                value -= column[i] * b[i]
            b[row] = value
        _swap(b, k, abs(pivots[k]) - 1)
        k -= 1 + two


@njit(cache=True)
def _swap(b: FloatArray, i: int, j: int) -> None:
    """Exchange two entries of b (n,)."""
    b[i], b[j] = b[j], b[i]
