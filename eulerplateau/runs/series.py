"""Branches as they are drawn: read back from the rows of branches.csv."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby, pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline, CubicSpline

from eulerplateau.arrays import FloatArray
from eulerplateau.runs.states import is_planar
from eulerplateau.runs.table import BranchRow

# Points drawn from one point of a branch to the next.
_BETWEEN = 24


@dataclass(frozen=True)
class Branch:
    """One branch, from the special point it starts at.

    Attributes
    ----------
    number : int
    origin : int or None, the number of the special point it starts from
    rows : in sequence; the first is that special point
    """

    number: int
    origin: int | None
    rows: tuple[BranchRow, ...]

    @property
    def loads(self) -> FloatArray:
        """Loads (n,)."""
        return np.array([row.load for row in self.rows])

    @property
    def abs_kappa_n(self) -> FloatArray:
        """The loop's total normal curvature (n,)."""
        return np.array([row.abs_kappa_n for row in self.rows])

    @property
    def planar(self) -> NDArray[np.bool_]:
        """Which of the points are planar (n,)."""
        return np.array([is_planar(row) for row in self.rows])

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

    def smooth(self, values: FloatArray, part: slice) -> FloatArray:
        """Return a part of `values` (n,), interpolated in the arclength, not in the load.

        Near a pitchfork the amplitude is linear in the arclength and the load quadratic.
        """
        s = np.array([row.arclength for row in self.rows[part]])
        if self.rows[part][0] is self.rows[0] and self.origin is not None:
            s[0] = 0.0
        places = np.arange(_BETWEEN * (len(s) - 1) + 1) / _BETWEEN
        curve = CubicSpline(s, values[part])
        fine: FloatArray = curve(np.interp(places, np.arange(len(s)), s))
        return fine


def read_branches(rows: Sequence[BranchRow]) -> list[Branch]:
    """Return the branches of a table, each continued back to where it starts from."""
    special = {row.special: row for row in reversed(rows) if row.special is not None}
    found = []
    for number, alike in groupby(rows, key=lambda row: row.branch):
        members = list(alike)
        origin = members[0].origin
        if origin is not None:
            members.insert(0, special[origin])
        found.append(Branch(number, origin, tuple(members)))
    return found


def signed_twists(branch: Branch) -> list[FloatArray]:
    """Return the waist twist (n,) in degrees, of both sides if the branch is planar.

    A planar film is its own mirror image, and its twist, 0 or a number of half turns, has
    no sign: on a branch that leaves the plane it is that of the side the branch is on.
    """
    twist = np.array([row.waist_twist for row in branch.rows])
    if branch.planar.all():
        return [np.abs(twist), -np.abs(twist)]
    side = np.sign(twist[np.argmax(branch.abs_kappa_n)])
    return [np.where(branch.planar, side * np.abs(twist), twist)]


def energy_above(first: Branch) -> Callable[[Branch], FloatArray]:
    """Return the function that gives a branch's energy (n,) above that of `first`.

    It compares at equal loads, and is NaN where `first` does not reach, or not in one
    piece. At equilibrium dE/dload is the film's energy over the load, so that cubics
    interpolate the first branch's energy to fourth order in the step.
    """
    rising: list[BranchRow] = []
    for row in first.rows:
        if rising and row.load <= rising[-1].load:
            break
        rising.append(row)
    if len(rising) < 2:
        return lambda branch: np.full(len(branch.rows), np.nan)
    loads = np.array([row.load for row in rising])
    energy = np.array([row.energy for row in rising])
    slope = np.array([row.film_energy for row in rising]) / loads
    base = CubicHermiteSpline(loads, energy, slope, extrapolate=False)
    return lambda branch: np.array(
        [row.energy - float(base(row.load)) for row in branch.rows]
    )
