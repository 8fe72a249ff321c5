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
from functools import cached_property
from itertools import accumulate
from typing import TYPE_CHECKING

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film.parts import Part, eliminate
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
    _parts: tuple[Part, ...]

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
        return solve_rows(*self._packed, self._order, rows).reshape(forces.shape)

    @cached_property
    def _packed(
        self,
    ) -> tuple[IntArray, IntArray, IntArray, IntArray, IntArray, FloatArray]:
        """All parts as arrays, for solve_kernels.py; the parts are then views of these."""
        parts = list(self._parts)
        counts = [len(part.around) for part in parts]
        starts = np.array([part.start for part in parts], dtype=np.int64)
        stops = np.array([part.stop for part in parts], dtype=np.int64)
        own = (stops - starts).tolist()
        sizes = [n * (n + m) for n, m in zip(own, counts, strict=True)]
        around = [np.zeros(0, dtype=np.int64), *(part.around for part in parts)]
        data, filled = np.empty(sum(sizes)), 0
        object.__setattr__(self, "_parts", ())  # so that they go as they are copied
        for number, part in enumerate(parts):
            views = []
            for piece in (part.factor, part.half):
                here = data[filled : (filled := filled + piece.size)]
                views.append(here.reshape(piece.shape, order="F"))
                views[-1][...] = piece
            parts[number] = Part(part.start, part.stop, part.around, views[1], views[0])
        object.__setattr__(self, "_parts", tuple(parts))
        pointer = np.array([0, *accumulate(counts)], dtype=np.int64)
        first = np.array([0, *accumulate(sizes)], dtype=np.int64)[:-1]
        return starts, stops, pointer, np.concatenate(around), first, data

    def carry(self, forces: FloatArray) -> FloatArray:
        """Return f_b - L_bi L_ii^-1 f_i (n_b, m): what forces (n, m) come to on the loop.

        The adjoint of `extend`.
        """
        ordered = forces[self._order]
        for part in self._parts:
            ordered[part.around] += part.pulled(ordered[part.start : part.stop])[1]
        return ordered[len(ordered) - len(self.stiffness) :]

    def extend(self, x_loop: FloatArray) -> FloatArray:
        """Return the relaxed film (n_v, m) on a loop (n_b, m), coordinate by coordinate."""
        ordered = np.empty((len(self._order), x_loop.shape[1]))
        ordered[len(ordered) - len(x_loop) :] = x_loop
        for part in reversed(self._parts):
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
        for part in reversed(self._parts):
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
        for part in self._parts:
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

    parts: list[Part] = []
    remainders: dict[int, FloatArray] = {}
    *inner, kept = elimination.fronts
    for number, front in enumerate(inner):
        own = front.stop - front.start
        block = front.assemble(entries, remainders)
        half, remainders[number], factor = eliminate(block, own)
        parts.append(Part(front.start, front.stop, front.around, half, factor))
    stiffness = kept.assemble(entries, remainders)
    mirror(stiffness)
    return Condensation(stiffness, elimination.order, tuple(parts))


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
        return Condensation(block, order, ())
    half, rest, factor = eliminate(block, own)
    stiffness = np.tril(rest) + np.tril(rest, -1).T
    return Condensation(stiffness, order, (Part(0, own, np.arange(own, n), half, factor),))


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
