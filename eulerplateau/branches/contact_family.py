"""Films on loops with a diameter as families of energies: with the gaps that are closed.

Loaded only for loops that have a diameter.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.film_family import FilmFamily
from eulerplateau.branches.gap_bounds import NO_TOUCH, GapBounds, Touch
from eulerplateau.branches.point import BranchPoint, point_near
from eulerplateau.loop import (
    LEAST,
    Gaps,
    LoopEnergy,
    Strands,
    strands_of,
    with_gaps_held,
)
from eulerplateau.solvers import Equilibrium, equilibrium_in_contact

# Gaps in units of L that are closed, or nearly; and times that what touches is changed
# until nothing pulls and nothing overlaps.
_CLOSED = 1e-6
_CHANGES = 40


@dataclass(frozen=True)
class ContactFamily(FilmFamily):
    """A film on a loop with a diameter, good as long as the same gaps are closed."""

    strands: Strands = field(kw_only=True)
    touch: Touch = NO_TOUCH

    def energy(self, value: float) -> LoopEnergy:
        """Return the energy at a value of the parameter, its gaps closed."""
        bounds = self.bounds(value)
        held = with_gaps_held(super().energy(value), bounds.strands, self.touch.gaps)
        return replace(held, bounds=bounds)

    def strands_at(self, value: float) -> Strands:
        """Return the strands at a value of the parameter."""
        problem, _ = self.at(value)
        diameter = problem.loop.diameter
        if diameter == self.strands.diameter:
            return self.strands
        # Copied with what is known of its curves.
        made, other = copy(self.strands), strands_of(problem.loop)
        object.__setattr__(made, "diameter", other.diameter)
        object.__setattr__(made, "apart", other.apart)
        return made

    def near(self, x: FloatArray) -> ContactFamily:
        """Return the film made anew at a loop (n_b, d), if it has turned, and its gaps."""
        film, touch = self.film, GapBounds(self.strands, self.touch).settled(x)
        if not film.energy(self.problem.loop, 1.0).holds(x):
            film = film.renewed(x)
        return replace(self, film=film, touch=touch)

    def beyond(self, point: BranchPoint, which: int) -> tuple[ContactFamily, str]:
        """Return the family beyond a point where one of its margins vanishes."""
        bounds = self.bounds(point.value)
        touch, what = bounds.beyond(point.x, point.model.tensions, which)
        return replace(self, touch=touch), what

    def bounds(self, value: float) -> GapBounds:
        """Return what keeps the strands apart at a value of the parameter."""
        return GapBounds(self.strands_at(value), self.touch)

    def equilibrium(self, point: BranchPoint) -> Equilibrium:
        """Return the equilibrium at a point of a branch of it, with its contacts."""
        problem, load = self.at(point.value)
        strands, x = self.strands_at(point.value), point.x
        gaps, _ = strands.at(x, self.touch.gaps)
        found = equilibrium_in_contact(problem, strands, load, self.film, point.model, gaps)
        return replace(problem.classified(found), iterations=point.corrections)

    def kept(self, x: FloatArray) -> Mapping[str, NDArray[Any]]:
        """Return what makes the film again, and which gaps are closed."""
        own = {**vars(self.touch.gaps), "line": self.touch.line}
        touch = {f"touch.{name}": array for name, array in own.items()}
        return {**self.film.kept(x), **touch}

    def restored(self, kept: Mapping[str, NDArray[Any]]) -> ContactFamily:
        """Return the family that this was kept of."""
        s, t, slides, line = (
            kept[f"touch.{name}"] for name in ("s", "t", "slides", "line")
        )
        film, touch = self.film.restored(kept), Touch(Gaps(s, t, slides), line)
        return replace(self, film=film, touch=touch)


def touching(
    family: FilmFamily, x: FloatArray, value: float, gaps: Gaps | None
) -> tuple[ContactFamily, FloatArray]:
    """Return a family as one of contact, and the loop (n_b, d) next to x that is at rest.

    Its gaps are closed: those that are given, or all but closed at x, less what pulls, and
    what overlaps besides. Where Newton's method comes to nothing it is x.
    """
    strands = strands_of(family.problem.at(family.parameter, value, family.load)[0].loop)
    if gaps is None:
        gaps, _ = strands.near(x, _CLOSED)
    made = ContactFamily(**vars(family), strands=strands)
    near: Gaps | None = gaps
    for _ in range(_CHANGES):
        assert near is not None
        made = replace(made, touch=Touch(near, np.zeros(len(near), dtype=bool)))
        found = point_near(made, x, value, LEAST[family.parameter])
        if found is None:
            break
        x, bounds = found.x, made.bounds(value)
        near = bounds.mended(x, found.model.tensions)
        if near is None:
            told = bounds.told(x, found.model.tensions)
            return replace(made, touch=replace(bounds, touch=told).settled(x)), x
    return made, x
