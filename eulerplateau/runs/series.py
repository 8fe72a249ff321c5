"""The curves of a diagram: the legs of a sweep, the branches of an exploration."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import groupby, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.runs.cubics import between, spline_slopes
from eulerplateau.runs.rows import BranchRecord, Record

# Of a row, whatever the run follows: a film or a cell.
Quantity = Callable[[Any], float | None]

# Points drawn from one point of a branch to the next.
_BETWEEN = 24


@dataclass(frozen=True)
class Piece:
    """A part of a curve drawn in one style: loads and values (n,).

    `solid` is a sweep with its load rising, or a stable stretch of a branch.
    """

    loads: FloatArray
    values: FloatArray
    solid: bool


@dataclass(frozen=True)
class Series(ABC):
    """Successive rows of a run that make one curve of its diagram.

    Attributes
    ----------
    rows : in sequence, of films or of cells (table.Record)
        The first is where it starts, also if that is another series' row.
    first : int, the number of the first row of its own in the run's table
    start : int or None, the number of the row it starts at, if that is another series'
    """

    rows: tuple[Any, ...]
    first: int = field(default=0, kw_only=True)
    start: int | None = field(default=None, kw_only=True)

    @property
    @abstractmethod
    def name(self) -> str:
        """What tells it from the run's other series."""

    @property
    @abstractmethod
    def group(self) -> str:
        """What the series drawn alike have in common."""

    @property
    def last(self) -> int:
        """The number of its last row in the run's table."""
        return self.first + len(self.rows) - 1 - (self.start is not None)

    @property
    def loads(self) -> FloatArray:
        """Loads (n,)."""
        return np.array([row.load for row in self.rows])

    def values(self, quantity: Quantity) -> FloatArray:
        """Return a quantity of its rows (n,); NaN where there is none, or no finite one."""
        found = [quantity(row) for row in self.rows]
        return np.array(
            [math.nan if v is None or not math.isfinite(v) else v for v in found],
            dtype=float,
        )

    @abstractmethod
    def pieces(self, values: FloatArray, jump: float = math.inf) -> Iterator[Piece]:
        """Yield the curve of `values` (n,) piece by piece.

        It has a gap where a value is NaN, or changes by more than `jump` from one point of
        a branch to the next.
        """


@dataclass(frozen=True)
class Leg(Series):
    """A part of a sweep, from where its load turns to where it turns again.

    A turning point ends one leg and starts the next.
    """

    rising: bool = field(default=True, kw_only=True)

    @property
    def name(self) -> str:
        """What tells it from a leg the other way."""
        varied = self.rows[0].load_name.word if self.rows else "load"
        return f"{varied} {'rising' if self.rising else 'falling'}"

    @property
    def group(self) -> str:
        """What the series drawn alike have in common."""
        return self.name

    def pieces(self, values: FloatArray, jump: float = math.inf) -> Iterator[Piece]:
        """Yield all its converged rows, unless there is nothing to be seen of them."""
        good = np.array([row.converged for row in self.rows], dtype=bool)
        if np.isfinite(values[good]).any():
            yield Piece(self.loads[good], values[good], self.rising)


@dataclass(frozen=True)
class Branch(Series):
    """One branch, from the special point it starts at.

    Attributes
    ----------
    rows : in sequence; the first is that special point
    number : int
    origin : int or None, the number of the special point it starts from
    """

    rows: tuple[Any, ...]
    number: int = field(default=0, kw_only=True)
    origin: int | None = field(default=None, kw_only=True)

    @property
    def name(self) -> str:
        """What tells it from the other branches."""
        return f"branch {self.number}"

    @property
    def group(self) -> str:
        """What branches drawn alike have in common: mirror images start together."""
        if self.start is None:
            return "the first branch"
        return f"from point {self.origin} at {self.rows[0].load:.6g}"

    @property
    def stable(self) -> NDArray[np.bool_]:
        """Whether it is stable between each point and the next (n - 1,).

        At a special point the critical eigenvalue has no sign: its neighbours tell.
        """
        found = []
        for pair in pairwise(self.rows):
            regular = [row for row in pair if row.special is None]
            found.append(all(row.n_unstable == 0 for row in regular or pair))
        return np.array(found, dtype=bool)

    @property
    def bridges(self) -> bool:
        """Whether it is stable and runs from one special point to another."""
        ends = self.rows[0].special, self.rows[-1].special
        return None not in ends and bool(self.stable.all())

    def stretches(
        self, apart: NDArray[np.bool_] | None = None
    ) -> Iterator[tuple[bool, slice]]:
        """Yield the stretches of like stability, and whether they are stable.

        A point and the next that are `apart` (n - 1,) belong to no stretch together, nor do
        those that are one: there the branch has a kink.
        """
        gaps = np.diff([row.arclength for row in self.rows]) == 0.0
        if apart is not None:
            gaps |= apart
        kinds = enumerate(zip(self.stable.tolist(), gaps.tolist(), strict=True))
        for (stable, gap), alike in groupby(kinds, key=lambda numbered: numbered[1]):
            places = [place for place, _ in alike]
            if not gap:
                yield stable, slice(places[0], places[-1] + 2)

    def pieces(self, values: FloatArray, jump: float = math.inf) -> Iterator[Piece]:
        """Yield its stretches of like stability, smooth."""
        within = np.abs(np.diff(values)) <= jump
        for stable, part in self.stretches(~within):
            yield Piece(self.smooth(self.loads, part), self.smooth(values, part), stable)

    def smooth(self, values: FloatArray, part: slice) -> FloatArray:
        """Return a part of `values` (n,), interpolated in the arclength, not in the load.

        Near a pitchfork the amplitude is linear in the arclength and the load quadratic.
        What is nowhere negative is not so between the points either, not even at a kink.
        """
        s = np.array([row.arclength for row in self.rows[part]])
        if self.rows[part][0] is self.rows[0] and self.start is not None:
            s[0] = 0.0
        places = np.arange(_BETWEEN * (len(s) - 1) + 1) / _BETWEEN
        known = values[part]
        fine = np.interp(places, np.arange(len(s)), s)
        fine = between(s, known, spline_slopes(s, known), fine)
        return fine if values[part].min() < 0.0 else np.maximum(fine, 0.0)


def read_legs(rows: Sequence[Record]) -> list[Leg]:
    """Split a sweep where its load turns; rows that are no two are one leg."""
    rises = (after.load >= row.load for row, after in pairwise(rows))
    found: list[Leg] = []
    for rising, alike in groupby(enumerate(rises), key=lambda numbered: numbered[1]):
        places = [place for place, _ in alike]
        begin, end = places[0], places[-1] + 2
        start, first = (begin, begin + 1) if found else (None, 0)
        found.append(Leg(tuple(rows[begin:end]), first=first, start=start, rising=rising))
    return found or [Leg(tuple(rows))]


def read_branches(rows: Sequence[BranchRecord]) -> list[Branch]:
    """Return the branches of a table, each continued back to where it starts from."""
    special: dict[int, int] = {}
    for place, row in enumerate(rows):
        if row.special is not None:
            special.setdefault(row.special, place)
    found = []
    for number, alike in groupby(enumerate(rows), key=lambda numbered: numbered[1].branch):
        members = list(alike)
        first, row = members[0]
        start = None if row.origin is None else special.get(row.origin)
        before = () if start is None else (rows[start],)
        own = (row for _, row in members)
        found.append(
            Branch(
                (*before, *own), first=first, start=start, number=number, origin=row.origin
            )
        )
    return found


def energy_above(*first: Series) -> Callable[[Series], FloatArray]:
    """Return the function that gives a branch's energy (n,) above that of branch `first`.

    Of a branch that was followed both ways, `first` are both. It compares at equal loads,
    and is NaN where `first` does not reach, or not without turning. At an equilibrium
    the energy's derivative is known (energy_rate), so that cubics interpolate the first
    branch's energy to fourth order in the step.
    """
    known = {row.load: row for series in first for row in _one_way(series.rows)}
    if len(known) < 2:
        return lambda branch: np.full(len(branch.rows), np.nan)
    loads = np.array(sorted(known))
    energy = np.array([known[load].energy for load in loads])
    slope = np.array([known[load].energy_rate for load in loads])

    def excess(branch: Series) -> FloatArray:
        places = branch.loads
        base = between(loads, energy, slope, places)
        base[(places < loads[0]) | (places > loads[-1])] = np.nan
        # Evaluated where it is known, a cubic is wrong by its rounding.
        for place, load in enumerate(places.tolist()):
            if load in known:
                base[place] = known[load].energy
        above: FloatArray = branch.values(lambda row: row.energy) - base
        return above

    return excess


def _one_way(rows: Sequence[Any]) -> list[Any]:
    """Return the rows up to where the load turns."""
    found = list(rows[:1])
    for row in rows[1:]:
        way = np.sign(row.load - found[-1].load)
        if way == 0:  # where the branch has a kink, it is told from both sides
            continue
        if len(found) > 1 and way != np.sign(found[1].load - found[0].load):
            break
        found.append(row)
    return found
