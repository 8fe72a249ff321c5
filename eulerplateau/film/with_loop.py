"""A film and its loop together: one sparse matrix, in which nothing is eliminated.

Its unknowns, in this order, are the heights of the film inside (n_i), the displacements of
the loop (3 n_b), the tensions of its edges (n_b), and a few that hold the loop against
motions which cost nothing. Condensed to the loop it would be full; as it is, a nested
dissection of film and loop factorises it in as little as a film without one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film.dissection import dissect, graph_of
from eulerplateau.film.elimination import Elimination, plan
from eulerplateau.film.strip import NoStrip

_AXES = np.arange(3)
# Nodes of a piece: an indefinite block is factorised more slowly than another. Of films of
# few nodes smaller ones are faster; of larger ones they are too many.
_LARGEST, _SMALLER, _FEW = 48, 16, 512
# Bending couples a vertex of the loop to the two on either side.
_REACH = 2


@dataclass(frozen=True)
class LoopStiffness:
    """What a loop adds to the matrix of its film.

    Attributes
    ----------
    chain : (3, n_b) float
        Between vertex v and v, v + 1, v + 2: the same for all coordinates.
    along : (n_b, 3) float
        What edge v's tension does to vertex v + 1; to vertex v it does the opposite.
    held : (3 n_b, m) float
        Motions to which the solution is to be orthogonal; zero columns hold nothing.
    pinned : (k,) int, vertices to which springs are fixed before, and taken away after
        Without them the motions that are held would make the matrix singular.
    stiffness : float, of these springs, and the scale of `held`
    """

    chain: FloatArray
    along: FloatArray
    held: FloatArray
    pinned: IntArray
    stiffness: float

    @property
    def n_held(self) -> int:
        """Number of unknowns that hold the loop."""
        return int(self.held.shape[1]) + 3 * len(self.pinned)

    @property
    def entries(self) -> FloatArray:
        """The values (k,) of its entries; of those that hold, in the loop's rows only."""
        held, pinned = self.held.T, 3 * len(self.pinned)
        chain = np.repeat(self.chain, 3, axis=1)
        along = self.along.ravel()
        springs = np.full(3 * pinned, self.stiffness)
        idle = np.where(held.any(axis=1), 0.0, self.stiffness)
        pairs = [chain[0], chain[1], chain[1], chain[2], chain[2], -along, -along, along]
        motions = self.stiffness * held.ravel()
        return np.concatenate([*pairs, along, motions, idle, springs])

    def places(self, first: int) -> tuple[IntArray, IntArray]:
        """Return rows and columns (k,) of the entries, of unknowns from `first` on."""
        n, held = self.chain.shape[1], self.held.shape[1]
        # A column for each coordinate of each vertex, and of those after it.
        v = np.arange(n)
        at, after, second = (
            (first + 3 * ((v + step) % n)[:, None] + _AXES).ravel()
            for step in range(_REACH + 1)
        )
        tension = first + 3 * n + np.repeat(v, 3)
        motions = first + 4 * n + np.arange(held)
        springs = first + 4 * n + held + np.arange(3 * len(self.pinned))
        pinned = (first + 3 * self.pinned[:, None] + _AXES).ravel()
        pairs = (
            (at, at),
            (at, after),
            (after, at),
            (at, second),
            (second, at),
            (tension, at),
            (at, tension),
            (tension, after),
            (after, tension),
            (np.tile(at, held), np.repeat(motions, 3 * n)),
            (motions, motions),
            (pinned, springs),
            (springs, springs),
            (pinned, pinned),
        )
        row, column = zip(*pairs, strict=True)
        return np.concatenate(row), np.concatenate(column)


@dataclass(frozen=True)
class FilmWithLoop:
    """Where entries go while a film and its loop are eliminated together.

    Attributes
    ----------
    strip : which vertices of the film follow its loop
    known : the elimination, once it has been found
    """

    strip: NoStrip
    known: list[Elimination]

    def assemble(
        self, film: FloatArray, loop: LoopStiffness
    ) -> tuple[Elimination, FloatArray]:
        """Return the matrix of a film's entries (m,) and its loop's, to be factorised."""
        if not self.known:
            self.known.append(self._elimination(loop))
        return self.known[0], np.concatenate([film, loop.entries])

    def _elimination(self, loop: LoopStiffness) -> Elimination:
        """Return it: the same whatever is held, as all loops of a film pin the same."""
        up, (inside, on_loop), kept = self.strip.places
        first, second = loop.places(len(self.strip.interior))
        row = np.concatenate([up[0], inside, on_loop, kept[0], first])
        column = np.concatenate([up[1], on_loop, inside, kept[1], second])
        n = len(self.strip.interior) + 4 * len(self.strip.loop)
        film = len(row) - len(first)
        pieces = self._pieces(row[:film], column[:film])
        return plan(row, column, pieces, np.arange(n, n + loop.n_held))

    def _pieces(self, row: IntArray, column: IntArray) -> list[IntArray]:
        """Return the unknowns, but for those that hold the loop, in pieces.

        row, column : of the film's entries
        """
        n_i, n_b = len(self.strip.interior), len(self.strip.loop)
        # A node for each height, and one for each vertex of the loop.
        loop = n_i + np.arange(n_b)
        reach = [n_i + np.arange(step, n_b + step) % n_b for step in range(1, _REACH + 1)]
        row = np.concatenate([self._node(row), *(_REACH * [loop]), *reach])
        column = np.concatenate([self._node(column), *reach, *(_REACH * [loop])])
        graph = graph_of(row, column, n_i + n_b)
        largest = _SMALLER if n_i + n_b <= _FEW else _LARGEST
        pieces = dissect(graph, loop, np.arange(n_i + n_b), largest)
        owner = np.empty(n_i + n_b, dtype=np.int64)
        for number, piece in enumerate(pieces):
            owner[piece] = number
        # A tension is regular once a vertex it pulls at is there: it comes with the later.
        later = np.maximum(owner[loop], np.roll(owner[loop], -1))
        owner = np.concatenate([owner[:n_i], np.repeat(owner[loop], 3), later])
        order = np.argsort(owner, kind="stable")
        cuts = np.searchsorted(owner[order], np.arange(1, len(pieces)))
        return list(np.split(order, cuts))

    def _node(self, unknown: IntArray) -> IntArray:
        n_i = len(self.strip.interior)
        return np.where(unknown < n_i, unknown, n_i + (unknown - n_i) // 3)
