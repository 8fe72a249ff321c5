"""Films of given writhe at many loads: what becomes of every rod follows from them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice, pairwise
from math import pi

import numpy as np

from eulerplateau.branches import BranchPoint
from eulerplateau.branches.conformal import (
    film_of,
    films_by_writhe,
    smooth_family,
    stiffness,
    tail,
)
from eulerplateau.exact.conformal import edge, waist

# Of so many films one is looked at among loops of any symmetry.
_LOOKED_AT = 6
# Writhe that is none.
NONE = 1e-9
LOADS = (
    *(100.0, 500.0, 1000.0, 1200.0, 1400.0, 1500.0, 1600.0, 1700.0),
    *(1800.0, 1900.0, 2000.0, 2100.0, 2200.0, 2300.0),
)


@dataclass(frozen=True)
class Row:
    """One film of given writhe.

    `moment` holds it there; a rod of C/B above `ratio` makes it stable if `index`, the
    unstable modes at its writhe, is 0: None where only films of its own symmetry were
    looked at, among which there is none. `balance` is max |F' + sigma T| / sigma.
    """

    load: float
    writhe: float
    moment: float
    energy: float
    ratio: float
    index: int | None
    waist: float
    balance: float
    tail: float
    harmonics: int

    def link(self, twist_ratio: float) -> float:
        """Return the link of a rod of another C/B that has this shape."""
        return self.writhe + self.moment / (4 * pi * twist_ratio)

    def total(self, twist_ratio: float) -> float:
        """Return its energy with the twist of such a rod."""
        return self.energy + self.moment**2 / (4 * twist_ratio)


def rows_at(load: float) -> list[Row]:
    """Return the films at a load, from flat to a waist of 0.005 L."""
    return [_row(point, number) for number, point in enumerate(films_by_writhe(load))]


def first_rows(load: float) -> list[Row]:
    """Return the first films at a load, which hardly writhe."""
    return [_row(point, 1) for point in islice(films_by_writhe(load, step=0.5), 4)]


def _row(point: BranchPoint, number: int) -> Row:
    family, film = smooth_family(point), film_of(point)
    twist = family.twist(point.value)
    moment = twist.moment(point.x)
    return Row(
        load=family.values["load"],
        writhe=twist.writhe(point.x),
        moment=moment,
        energy=film.energy,
        ratio=-stiffness(point) / (8 * pi**2),
        index=_index(point, number),
        waist=waist(film),
        balance=edge(film).force_balance(film.load, film.beta, moment),
        tail=tail(point),
        harmonics=film.basis.harmonics,
    )


def _index(point: BranchPoint, number: int) -> int | None:
    """Return the Morse index at given writhe, every so often among all loops."""
    own = point.stability.n_unstable
    whole = own or number % _LOOKED_AT == 0
    return smooth_family(point).in_space(point).n_unstable if whole else None


def ratio_at_no_writhe(rows: list[Row]) -> tuple[float, float]:
    """Return C/B above which the flat film is stable, or its pitchfork supercritical.

    And how that changes with the writhe: with its square beside lobes, with the writhe
    itself beside the disk. Of the first rows, by a polynomial through four of them.
    """
    lobes = abs(rows[0].writhe) < NONE
    near = rows[:4]
    at = np.array([row.writhe**2 if lobes else row.writhe for row in near])
    curve = np.polynomial.Polynomial.fit(at, [row.ratio for row in near], 3).convert()
    return float(curve.coef[0]), float(curve.coef[1])


def stable_links(rows: list[Row], twist_ratio: float) -> list[tuple[float, float]]:
    """Return the ranges of link over which films of these rows are stable."""
    ranges: list[list[float]] = []
    inside = False
    for row in rows:
        stable = not row.index and twist_ratio > row.ratio
        if stable and not inside:
            ranges.append([])
        if stable:
            ranges[-1].append(row.link(twist_ratio))
        inside = stable
    return [(min(part), max(part)) for part in ranges]


def widest_at(rows: list[Row], twist_ratio: float, link: float) -> float:
    """Return the widest waist of a stable film at a link; 0 if there is none."""
    widest = 0.0
    for before, after in pairwise(rows):
        low, high = before.link(twist_ratio), after.link(twist_ratio)
        stable = twist_ratio > max(before.ratio, after.ratio)
        if stable and low <= link <= high:
            widest = max(widest, before.waist, after.waist)
    return widest
