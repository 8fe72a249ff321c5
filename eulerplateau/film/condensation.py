"""Static condensation: the film's interior eliminated exactly, once per mesh.

With the Laplacian split into interior (i) and loop (b),

    [L_ii L_ib] [x_i]   [ 0 ]
    [L_bi L_bb] [x_b] = [ f ]      x_i = -L_ii^-1 L_ib x_b,   f = S x_b,
                                   S = L_bb - L_bi L_ii^-1 L_ib,

S is the discrete Dirichlet-to-Neumann map; a relaxed film has the energy
load * tr(x_b^T S x_b).

A small interior is one dense block (parts.py). A larger one is eliminated part by part
(elimination.py), by compiled loops: they are loaded where there is one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film.parts import Parts, eliminate, parts_of
from eulerplateau.threads import one_thread

if TYPE_CHECKING:
    from eulerplateau.film.elimination import Elimination

# Up to this many vertices inside are eliminated at once.
_DENSE = 512


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
    _parts: Parts

    def force(self, x_loop: FloatArray) -> FloatArray:
        """Return the gradient of tr(x_b^T S x_b) (n_b, 3)."""
        return 2 * self.stiffness @ x_loop

    def displacement(self, x_loop: FloatArray, moved: FloatArray) -> FloatArray:
        """Return how the film (n_v, 3) follows a displacement of its loop (n_b, 3)."""
        return self.extend(moved)

    def solve(self, forces: FloatArray) -> FloatArray:
        """Return L_ii^-1 f for forces f (n_i,) or (n_i, m) on the interior rows.

        Those are the rows 0 ... n_i - 1.
        """
        from eulerplateau.film.solve_kernels import solve_rows

        n_i = len(forces)
        rows = np.ascontiguousarray(forces).reshape(n_i, -1)
        found = np.empty(rows.shape)
        solve_rows(*self._parts.packed, self._order, rows, found)
        return found.reshape(forces.shape)

    def carry(self, forces: FloatArray) -> FloatArray:
        """Return f_b - L_bi L_ii^-1 f_i (n_b, m): what forces (n, m) come to on the loop.

        The adjoint of `extend`.
        """
        ordered = forces[self._order]
        for part in self._parts.each:
            ordered[part.around] += part.pulled(ordered[part.start : part.stop])[1]
        return ordered[len(ordered) - len(self.stiffness) :]

    def extend(self, x_loop: FloatArray) -> FloatArray:
        """Return the relaxed film (n_v, m) on a loop (n_b, m), coordinate by coordinate."""
        ordered = np.empty((len(self._order), x_loop.shape[1]))
        ordered[len(ordered) - len(x_loop) :] = x_loop
        for part in reversed(self._parts.each):
            ordered[part.start : part.stop] = part.unfolded(ordered[part.around])
        x = np.empty_like(ordered)
        x[self._order] = ordered
        return x

    def unfold(self, x_loop: FloatArray, inside: FloatArray) -> FloatArray:
        """Return `extend` of a loop (n_b, m), plus C inside (n, m).

        C is the factor of L_ii = (C C^T)^-1: in these variables (n_i, m), each a
        displacement from rest, the stiffness of the interior is 1.
        """
        ordered = np.empty((len(self._order), x_loop.shape[1]))
        ordered[len(inside) :] = x_loop
        for part in reversed(self._parts.each):
            ordered[part.start : part.stop] = part.unfolded(
                ordered[part.around], inside[part.start : part.stop]
            )
        x = np.empty_like(ordered)
        x[self._order] = ordered
        return x

    def fold(self, forces: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what forces (n, m) are on a loop (n_b, m) and on variables (n_i, m).

        The adjoint of `unfold`.
        """
        ordered = forces[self._order]
        inside = np.empty((len(ordered) - len(self.stiffness), ordered.shape[1]))
        for part in self._parts.each:
            own, left = part.pulled(ordered[part.start : part.stop])
            ordered[part.around] += left
            inside[part.start : part.stop] = own
        return ordered[len(inside) :], inside


def factorise(elimination: Elimination, entries: FloatArray) -> Condensation:
    """Eliminate what is to be eliminated of a symmetric matrix with these entries (m,).

    Raises LinAlgError unless that is positive definite. The caller sees to it that BLAS has
    one thread.
    """
    from eulerplateau.film.elimination import mirror

    remainders: dict[int, FloatArray] = {}
    *inner, kept = elimination.fronts
    # Factors at once where they stay: copies are as large.
    parts = parts_of(
        [front.start for front in inner],
        [front.stop for front in inner],
        [front.around for front in inner],
    )
    for number, front in enumerate(inner):
        own = front.stop - front.start
        block = front.assemble(entries, remainders)
        part = parts.each[number]
        part.half[...], remainders[number], part.factor[...] = eliminate(block, own)
    stiffness = kept.assemble(entries, remainders)
    mirror(stiffness)
    return Condensation(stiffness, elimination.order, parts)


def condense(
    row: IntArray, column: IntArray, values: FloatArray, loop: IntArray, interior: IntArray
) -> Condensation:
    """Eliminate `interior` from a symmetric matrix (n_v, n_v) with entries (m,).

    Those with the same place are summed. Raises LinAlgError unless what is eliminated is
    positive definite.
    """
    # Blocks of a hundred rows: two threads would mostly wait for each other.
    with one_thread():
        reduce = _at_once if len(interior) <= _DENSE else _in_parts
        found = reduce(row, column, values, loop, interior)
    # A translation costs nothing. Where slivers make weights of 1e8 that cancel, rounding
    # would have it cost something, and leave a pull on the loop that nothing balances.
    diagonal = np.diag_indices_from(found.stiffness)
    found.stiffness[diagonal] -= found.stiffness.sum(axis=1)
    return found


def _at_once(
    row: IntArray, column: IntArray, values: FloatArray, loop: IntArray, interior: IntArray
) -> Condensation:
    order, own = np.concatenate([interior, loop]), len(interior)
    n = len(order)
    place = np.empty(n, dtype=np.int64)
    place[order] = np.arange(n)
    flat = np.bincount(place[row] * n + place[column], values, minlength=n * n)
    block: FloatArray = flat.astype(np.float64, copy=False).reshape(n, n)
    if not own:
        return Condensation(block, order, parts_of([], [], []))
    parts = parts_of([0], [own], [np.arange(own, n)])
    (part,) = parts.each
    part.half[...], rest, part.factor[...] = eliminate(block, own)
    stiffness = np.tril(rest) + np.tril(rest, -1).T
    return Condensation(stiffness, order, parts)


def _in_parts(
    row: IntArray, column: IntArray, values: FloatArray, loop: IntArray, interior: IntArray
) -> Condensation:
    from scipy.sparse import csr_array

    from eulerplateau.film.dissection import Graph, dissect
    from eulerplateau.film.elimination import plan

    n = len(loop) + len(interior)
    rows = csr_array((values, (row, column)), shape=(n, n))
    graph = Graph(rows.indptr.astype(np.int64), rows.indices.astype(np.int64))
    pieces = dissect(graph, loop, interior)
    row = np.repeat(np.arange(n), np.diff(rows.indptr))
    return factorise(plan(row, rows.indices, pieces, loop), rows.data)
