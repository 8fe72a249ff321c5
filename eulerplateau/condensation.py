"""Static condensation: the film's interior eliminated exactly, once per mesh.

With the Laplacian split into interior (i) and loop (b),

    [L_ii L_ib] [x_i]   [ 0 ]
    [L_bi L_bb] [x_b] = [ f ]      x_i = -L_ii^-1 L_ib x_b,   f = S x_b,
                                   S = L_bb - L_bi L_ii^-1 L_ib,

S is the discrete Dirichlet-to-Neumann map; a relaxed film has the energy
load * tr(x_b^T S x_b).

The interior is eliminated part by part (dissection.py). A part is one dense block: with
what the parts before it have left on it and on the vertices around it, it is condensed in
the same way, and the last to remain is the loop (the multifrontal method; Duff and Reid
1983).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_solve, cholesky, solve_triangular
from scipy.sparse import csc_array, csr_array
from threadpoolctl import threadpool_limits

from eulerplateau.dissection import dissect
from eulerplateau.mesh import FloatArray, IntArray


@dataclass(frozen=True)
class _Part:
    """Vertices start ... stop - 1 of the order, which hang on those `around` them.

    In equilibrium x[start:stop] = extension @ x[around]; `factor` is Cholesky's, lower.
    """

    start: int
    stop: int
    around: IntArray
    extension: FloatArray
    factor: FloatArray


@dataclass(frozen=True)
class Condensation:
    """A factorised interior.

    Attributes
    ----------
    stiffness : (n_b, n_b) float, symmetric
        S, per unit of load.
    """

    stiffness: FloatArray
    _order: IntArray
    _parts: tuple[_Part, ...]

    def force(self, x_loop: FloatArray) -> FloatArray:
        """Return the gradient of tr(x_b^T S x_b) (n_b, 3)."""
        return 2 * self.stiffness @ x_loop

    def displacement(self, x_loop: FloatArray, moved: FloatArray) -> FloatArray:
        """Return how the film (n_v, 3) follows a displacement of its loop (n_b, 3)."""
        return self.extend(moved)

    def solve(self, forces: FloatArray) -> FloatArray:
        """Return L^-1 f (n, m) for forces (n, m), of a matrix that was factorised whole."""
        ordered = forces[self._order]
        for part in self._parts:
            own = ordered[part.start : part.stop]
            ordered[part.around] += part.extension.T @ own
            ordered[part.start : part.stop] = cho_solve(
                (part.factor, True), own, check_finite=False
            )
        for part in reversed(self._parts):
            ordered[part.start : part.stop] += part.extension @ ordered[part.around]
        x = np.empty_like(ordered)
        x[self._order] = ordered
        return x

    def extend(self, x_loop: FloatArray) -> FloatArray:
        """Return the relaxed film (n_v, m) on a loop (n_b, m), coordinate by coordinate."""
        ordered = np.empty((len(self._order), x_loop.shape[1]))
        ordered[len(ordered) - len(x_loop) :] = x_loop
        for part in reversed(self._parts):
            ordered[part.start : part.stop] = part.extension @ ordered[part.around]
        x = np.empty_like(ordered)
        x[self._order] = ordered
        return x


def factorise(matrix: csc_array, pieces: list[IntArray]) -> Condensation:
    """Factorise a symmetric matrix (n, n), its rows eliminated piece by piece, to `solve`.

    Raises LinAlgError unless it is positive definite. The caller sees to it that BLAS has
    one thread.
    """
    return _condense(matrix.tocsr(), np.zeros(0, dtype=np.int64), pieces)


def condense(laplacian: csc_array, loop: IntArray, interior: IntArray) -> Condensation:
    """Eliminate `interior` from `laplacian` (n_v, n_v), symmetric.

    Raises LinAlgError unless what is eliminated is positive definite.
    """
    rows = laplacian.tocsr()
    pieces = dissect(rows, loop, interior)
    # Blocks of a hundred rows: two threads would mostly wait for each other.
    with threadpool_limits(1, user_api="blas"):
        found = _condense(rows, loop, pieces)
    # A translation costs nothing. Where slivers make weights of 1e8 that cancel, rounding
    # would have it cost something, and leave a pull on the loop that nothing balances.
    diagonal = np.diag_indices_from(found.stiffness)
    found.stiffness[diagonal] -= found.stiffness.sum(axis=1)
    return found


def _condense(rows: csr_array, loop: IntArray, pieces: list[IntArray]) -> Condensation:
    order = np.concatenate([*pieces, loop])
    rows = rows[order][:, order]
    rows.sort_indices()
    n_i = len(order) - len(loop)
    stiffness = rows[n_i:, n_i:].toarray()
    stops = np.cumsum([len(piece) for piece in pieces], dtype=np.int64)
    return Condensation(stiffness, order, tuple(_eliminate(rows, stops, stiffness)))


def _eliminate(rows: csr_array, stops: IntArray, stiffness: FloatArray) -> list[_Part]:
    """Return the eliminated parts; add to S (n_b, n_b) what they leave on the loop."""
    n = rows.shape[0]
    local = np.empty(n, dtype=np.int64)
    parts: list[_Part] = []
    # What eliminated parts left, waiting for the part that holds their first neighbour.
    waiting: dict[int, list[tuple[IntArray, FloatArray]]] = {}
    n_i = n - len(stiffness)
    start = 0
    for number, stop in enumerate(stops.tolist()):
        left = waiting.pop(number, [])
        entries = slice(rows.indptr[start], rows.indptr[stop])
        column, value = rows.indices[entries], rows.data[entries]
        row = np.repeat(np.arange(stop - start), np.diff(rows.indptr[start : stop + 1]))
        later = column >= start
        row, column, value = row[later], column[later], value[later]
        touched = np.unique(np.concatenate([column, *(around for around, _ in left)]))
        around = touched[np.searchsorted(touched, stop) :]
        own = stop - start
        local[start:stop] = np.arange(own)
        local[around] = np.arange(own, own + len(around))
        front = np.zeros((own + len(around), own + len(around)))
        front[row, local[column]] = value
        for below, remainder in left:
            place = local[below]
            front[np.ix_(place, place)] += remainder
        extension, remainder, factor = _condense_dense(front, own)
        parts.append(_Part(start, stop, around, extension, factor))
        if len(around) and around[0] < n_i:
            owner = int(np.searchsorted(stops, around[0], side="right"))
            waiting.setdefault(owner, []).append((around, remainder))
        elif len(around):
            stiffness[np.ix_(around - n_i, around - n_i)] += remainder
        start = stop
    return parts


def _condense_dense(
    front: FloatArray, own: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Eliminate the first `own` rows of a symmetric matrix.

    Returns -F_11^-1 F_12, F_22 - F_21 F_11^-1 F_12, symmetric to the last bit, and the
    factor of F_11.
    """
    factor = cholesky(front[:own, :own], lower=True, check_finite=False)
    half = solve_triangular(factor, front[:own, own:], lower=True, check_finite=False)
    extension = solve_triangular(factor, half, lower=True, trans=1, check_finite=False)
    return -extension, front[own:, own:] - half.T @ half, factor
