"""Where the entries of a sparse symmetric matrix go while part of it is eliminated.

The rows are eliminated part by part (dissection.py). A part is one dense block, a front:
with what the parts before it have left on it and on the rows around it, it is condensed,
and what that leaves waits for the front that holds the first of those rows (the
multifrontal method; Duff and Reid 1983). All this depends on the matrix's pattern alone: it
is found once and used for every matrix with that pattern.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.compiling import njit


@dataclass(frozen=True)
class _Front:
    """A dense block, of rows start ... stop - 1 and of those around them.

    Attributes
    ----------
    entries, places : (m,) int, which of the matrix's entries go where in the flat block
    left : of each front that leaves something here its number, and where in the block
    """

    start: int
    stop: int
    around: IntArray
    entries: IntArray
    places: IntArray
    left: list[tuple[int, IntArray]]

    @cached_property
    def size(self) -> int:
        """Rows of the block."""
        return self.stop - self.start + len(self.around)

    def assemble(self, values: FloatArray, remainders: dict[int, FloatArray]) -> FloatArray:
        """Return the block (size, size): own rows of the matrix and what others left.

        In LAPACK's order, and filled on and below the diagonal only.
        """
        n = self.size
        block = np.zeros((n, n))
        add_entries(values, self.entries, self.places, block.reshape(-1))
        for number, place in self.left:
            add_block(remainders.pop(number).T, place, block)
        return block.T


Packed = tuple[
    IntArray, IntArray, IntArray, IntArray, IntArray, IntArray, IntArray, IntArray
]


@dataclass(frozen=True)
class Elimination:
    """The order of a matrix's rows, parts first and kept rows last, and all fronts.

    The last front holds the rows that are kept.
    """

    order: IntArray
    fronts: tuple[_Front, ...]

    @cached_property
    def filled(self) -> list[tuple[int, _Front]]:
        """The fronts that have rows of their own, by their numbers."""
        return [
            (k, front) for k, front in enumerate(self.fronts) if front.stop > front.start
        ]

    @cached_property
    def hung(self) -> tuple[IntArray, IntArray, IntArray]:
        """Where each of these starts, and by a pointer the rows it hangs on, end to end."""
        fronts = [front for _, front in self.filled]
        return (
            np.array([front.start for front in fronts]),
            np.cumsum([0, *(len(front.around) for front in fronts)]),
            np.concatenate([front.around for front in fronts]),
        )

    @cached_property
    def largest(self) -> int:
        """Rows of the largest block of these."""
        return max(front.size for _, front in self.filled)

    @cached_property
    def room(self) -> tuple[int, int]:
        """Rows that are eliminated, and entries of them and of what is beside them."""
        own = [(front.stop - front.start, front.size) for _, front in self.filled]
        return sum(n for n, _ in own), sum(n * size for n, size in own)

    @cached_property
    def packed(self) -> Packed:
        """The same for compiled loops (front_kernels.py), fronts end to end.

        `hung`, then by a pointer which of the matrix's entries go where in each block, and
        of each front onto which other its remainder goes, and where in that one's block.
        """
        fronts = [front for _, front in self.filled]
        number = {k: at for at, (k, _) in enumerate(self.filled)}
        onto, into = np.full(len(fronts), len(fronts)), [front.around for front in fronts]
        for at, front in enumerate(fronts):
            for before, place in front.left:
                onto[number[before]], into[number[before]] = at, place
        return (
            *self.hung,
            np.cumsum([0, *(len(front.entries) for front in fronts)]),
            np.concatenate([front.entries for front in fronts]),
            np.concatenate([front.places for front in fronts]),
            onto,
            np.concatenate(into),
        )


def plan(
    row: IntArray, column: IntArray, pieces: list[IntArray], kept: IntArray
) -> Elimination:
    """Find where entries go while all rows but those `kept` are eliminated, in pieces.

    row, column : (m,), of the entries of a symmetric matrix. Those with the same place are
    summed; of two that mirror each other across parts the later row's may be missing.
    """
    order = np.concatenate([*pieces, kept])
    place: IntArray = np.empty(len(order), dtype=np.int32)
    place[order] = np.arange(len(order))
    row, column = place[row], place[column]
    stops = np.cumsum([*(len(piece) for piece in pieces), len(kept)], dtype=np.int64)
    starts = np.concatenate([[0], stops[:-1]])
    owner = np.searchsorted(stops, row, side="right")
    entries = np.flatnonzero(column >= starts[owner])
    entries = entries[np.argsort(owner[entries], kind="stable")]
    first = np.searchsorted(owner[entries], np.arange(len(stops) + 1))
    local = np.empty(len(order), dtype=np.int64)
    fronts: list[_Front] = []
    # Fronts whose remainder waits for the front that holds its first row.
    waiting: list[list[int]] = [[] for _ in stops]
    for number, (start, stop) in enumerate(
        zip(starts.tolist(), stops.tolist(), strict=True)
    ):
        mine = entries[first[number] : first[number + 1]]
        below = [fronts[before].around for before in waiting[number]]
        around = _each_once(np.concatenate([column[mine], *below]), stop)
        size = stop - start + len(around)
        local[start:stop] = np.arange(stop - start)
        local[around] = np.arange(stop - start, size)
        places = local[row[mine]] * size + local[column[mine]]
        # Numbers of half the size where they have room: there is one for every entry.
        kind = np.int32 if max(size * size, len(row)) < 1 << 31 else np.int64
        left = [(before, local[fronts[before].around]) for before in waiting[number]]
        fronts.append(
            _Front(start, stop, around, mine.astype(kind), places.astype(kind), left)
        )
        if len(around):
            waiting[int(np.searchsorted(stops, around[0], side="right"))].append(number)
    return Elimination(order, tuple(fronts))


def _each_once(numbers: IntArray, least: int) -> IntArray:
    """Return each of the numbers (m,) from the least on, in order (np.unique is slower)."""
    ordered = np.sort(numbers[numbers >= least])
    first = np.ones(len(ordered), dtype=bool)
    np.not_equal(ordered[1:], ordered[:-1], out=first[1:])
    return ordered[first].astype(np.int64)


def summed(place: IntArray, values: FloatArray, n: int) -> FloatArray:
    """Return zeros (n,) with the values (m,) added at their places (m,).

    Of values (m, d) each column apart, (n, d).
    """
    if values.ndim == 1:
        # float64 even where nothing is added.
        return np.bincount(place, values, minlength=n).astype(np.float64, copy=False)
    total = np.zeros((n, values.shape[1]))
    add_rows(place, np.ascontiguousarray(values), total)
    return total


@njit(cache=True)
def add_rows(place: IntArray, values: FloatArray, total: FloatArray) -> None:
    """Add rows of values (m, d) to rows `place` of `total` (n, d)."""
    for m in range(place.shape[0]):
        for d in range(values.shape[1]):
            total[place[m], d] += values[m, d]


@njit(cache=True)
def add_entries(
    values: FloatArray, entries: IntArray, places: IntArray, total: FloatArray
) -> None:
    """Add values[entries] to `total` (n,) at `places`."""
    for m in range(entries.shape[0]):
        total[places[m]] += values[entries[m]]


@njit(cache=True)
def add_block(block: FloatArray, place: IntArray, total: FloatArray) -> None:
    """Add the upper part of a block (m, m) to rows and columns `place` of `total` (n, n).

    Places (m,) ascend.
    """
    for i in range(place.shape[0]):
        for j in range(i, place.shape[0]):
            total[place[i], place[j]] += block[i, j]


@njit(cache=True)
def mirror(matrix: FloatArray) -> None:
    """Copy what is below the diagonal of a matrix (n, n) above it, tile by tile."""
    n, tile = matrix.shape[0], 32
    for top in range(0, n, tile):
        for left in range(0, top + tile, tile):
            for i in range(top, min(top + tile, n)):
                for j in range(left, min(left + tile, i)):
                    matrix[j, i] = matrix[i, j]
