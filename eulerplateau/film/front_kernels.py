"""The fronts of an indefinite matrix factorised one after the other: compiled loops.

Arrays in, arrays out. Fronts are small, and calls of LAPACK for each would cost more than
its work. Helpers stay in this file (numba #1833).
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.compiling import njit

# Bunch and Kaufman's (1 + sqrt(17)) / 8: how large a diagonal entry is to be as a pivot.
_ALPHA = 0.6403882032022076


@njit(cache=True, error_model="numpy")
def factorise_fronts(
    values: FloatArray,
    starts: IntArray,
    pointer: IntArray,
    around: IntArray,
    first: IntArray,
    entries: IntArray,
    places: IntArray,
    onto: IntArray,
    into: IntArray,
    pivots: IntArray,
    data: FloatArray,
) -> int:
    """Fill in pivots (n,) and data; return the number of negative eigenvalues, or -1.

    As solve_kernels.solve_symmetric_fronts reads them. -1 where a pivot vanishes.
    Arguments are those of Elimination.packed, and the matrix's entries.
    """
    count, negative, at = len(first) - 1, 0, 0
    nothing = np.empty((0, 0))
    left = [nothing for _ in range(count)]
    waiting = np.full(count + 1, -1)
    after = np.full(count, -1)
    for p in range(count):
        stop = starts[p + 1] if p < count - 1 else len(pivots)
        own, hung = stop - starts[p], pointer[p + 1] - pointer[p]
        size = own + hung
        block = np.zeros((size, size))
        flat = block.reshape(-1)
        for e in range(first[p], first[p + 1]):
            flat[places[e]] += values[entries[e]]
        other = waiting[p]
        while other >= 0:
            place, rest = into[pointer[other] : pointer[other + 1]], left[other]
            for i in range(len(place)):
                row = block[place[i]]
                for j in range(i, len(place)):
                    row[place[j]] += rest[i, j]
            left[other] = nothing
            other = after[other]
        pivot = pivots[starts[p] : stop]
        found = eliminate_rows(block, pivot)
        if found < 0:
            return -1
        negative += found
        for j in range(own):
            for i in range(j, own):
                data[at + j * own + i] = block[j, i]
        at += own * own
        if hung:
            left[p] = block[own:, own:].copy()
            after[p], waiting[onto[p]] = waiting[onto[p]], p
            respond(block, pivot)
            for i in range(hung):
                for j in range(own):
                    data[at + i * own + j] = block[j, own + i]
            at += own * hung
    return negative


@njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
def eliminate_rows(a: FloatArray, pivots: IntArray) -> int:
    """Eliminate the first rows of a symmetric matrix, given above its diagonal.

    Row k becomes column k of L, D on the diagonal and beside it, as LAPACK's dsytf2 leaves
    the lower triangle; below remains what is left of the other rows. Pivots are chosen
    among the rows (len(pivots)) that are eliminated. Returns as `factorise_fronts` does.
    """
    own, size, k, negative = len(pivots), len(a), 0, 0
    while k < own:
        row, steps, chosen, below = a[k], 1, k, 0.0
        for i in range(k + 1, own):
            if abs(row[i]) > below:
                below, chosen = abs(row[i]), i
        here = abs(row[k])
        if not max(here, below) > 0.0:
            return -1
        if here >= _ALPHA * below:
            chosen = k
        else:
            beside = 0.0
            for j in range(k, chosen):
                beside = max(beside, abs(a[j, chosen]))
            for i in range(chosen + 1, own):
                beside = max(beside, abs(a[chosen, i]))
            if here >= _ALPHA * below * (below / beside):
                chosen = k
            elif abs(a[chosen, chosen]) < _ALPHA * beside:
                steps = 2
        last = k + steps - 1
        exchange(a, k, last, chosen)
        if steps == 1:
            negative += row[k] < 0.0
            for j in range(k + 1, size):
                part, other = row[j] / row[k], a[j]
                for i in range(j, size):
                    other[i] -= part * row[i]
                row[j] = part
            pivots[k] = chosen + 1
        else:
            negative += 1
            follower, between = a[k + 1], row[k + 1]
            one, two = follower[k + 1] / between, row[k] / between
            scale = 1.0 / ((one * two - 1.0) * between)
            for j in range(k + 2, size):
                part = scale * (one * row[j] - follower[j])
                rest = scale * (two * follower[j] - row[j])
                other = a[j]
                for i in range(j, size):
                    other[i] -= part * row[i] + rest * follower[i]
                row[j], follower[j] = part, rest
            pivots[k], pivots[k + 1] = -chosen - 1, -chosen - 1
        k += steps
    return negative


@njit(cache=True, error_model="numpy")
def exchange(a: FloatArray, k: int, last: int, chosen: int) -> None:
    """Exchange rows and columns `last` and `chosen` of what is left from row k on."""
    if chosen == last:
        return
    for i in range(chosen + 1, len(a)):
        a[last, i], a[chosen, i] = a[chosen, i], a[last, i]
    for j in range(last + 1, chosen):
        a[last, j], a[j, chosen] = a[j, chosen], a[last, j]
    a[last, last], a[chosen, chosen] = a[chosen, chosen], a[last, last]
    if last > k:
        a[k, last], a[k, chosen] = a[k, chosen], a[k, last]


@njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
def respond(a: FloatArray, pivots: IntArray) -> None:
    """Replace what `eliminate_rows` has left beside the eliminated rows by F_11^-1 F_12."""
    own, size = len(pivots), len(a)
    k = own - 1
    while k >= 0:
        two = pivots[k] < 0
        for r in range(k, k - 1 - two, -1):
            row = a[r]
            for i in range(k + 1, own):
                part, other = row[i], a[i]
                for c in range(own, size):
                    row[c] -= part * other[c]
        swapped = abs(pivots[k]) - 1
        if swapped != k:
            for c in range(own, size):
                a[k, c], a[swapped, c] = a[swapped, c], a[k, c]
        k -= 1 + two
