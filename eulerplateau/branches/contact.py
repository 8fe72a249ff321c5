"""What a family of films on a loop with a diameter knows of the gaps that are closed.

Loaded only for loops that have a diameter.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.family import Family
from eulerplateau.branches.gap_bounds import GapBounds
from eulerplateau.branches.places import NO_TOUCH, Touch, steady
from eulerplateau.branches.point import BranchPoint, point_near
from eulerplateau.film import FilmOfLoop
from eulerplateau.loop import (
    Contacts,
    Gaps,
    Loop,
    LoopEnergy,
    Strands,
    strands_of,
    with_gaps_held,
)
from eulerplateau.solvers import TangentModel, contacts_at

# Gaps in units of L that are closed, or nearly; and times that what touches is changed
# until nothing pulls and nothing overlaps.
_CLOSED = 1e-6
# Of places that are given, those so many edges from one before them are the same.
_BESIDE = 0.1
_CHANGES = 40


@dataclass(frozen=True)
class Contact:
    """Gaps of a loop that are closed: where its strands touch."""

    strands: Strands
    touch: Touch = NO_TOUCH

    def bounds(self, loop: Loop) -> GapBounds:
        """Return what keeps the strands apart of a loop, whatever its diameter."""
        strands = self.strands
        if loop.diameter != strands.diameter:
            # Copied with what is known of its curves.
            strands, other = copy(self.strands), strands_of(loop)
            object.__setattr__(strands, "diameter", other.diameter)
            object.__setattr__(strands, "apart", other.apart)
        return GapBounds(strands, self.touch)

    def held(self, energy: LoopEnergy, loop: Loop) -> LoopEnergy:
        """Return an energy of the loop, with the gaps kept closed."""
        bounds = self.bounds(loop)
        held = with_gaps_held(energy, bounds.strands, self.touch.gaps)
        return replace(held, bounds=bounds)

    def strands_on(self, loop: Loop) -> Strands:
        """Return the strands of a loop, whatever its diameter."""
        return self.bounds(loop).strands

    @property
    def gaps(self) -> Gaps:
        """The gaps that are closed."""
        return self.touch.gaps

    def with_closed(self, gaps: Gaps) -> Contact:
        """Return the same contacts closed at other gaps."""
        return replace(self, touch=self.touch.with_places(self.strands, gaps))

    def near(self, x: FloatArray) -> Contact:
        """Return the gaps of the kind, and at the places, they should be at x (n, d)."""
        touch = GapBounds(self.strands, self.touch).settled(x)
        return self if touch is self.touch else replace(self, touch=touch)

    def steady(self, x: FloatArray) -> Contact:
        """Return the same as it is held on the way from a loop x (n, d)."""
        touch = steady(self.strands, x, self.touch)
        return self if touch is self.touch else replace(self, touch=touch)

    def beyond(self, point: BranchPoint, loop: Loop, which: int) -> tuple[Contact, str]:
        """Return what is closed beyond a point where one of its margins vanishes."""
        bounds = self.bounds(loop)
        touch, what = bounds.beyond(point.x, point.model.tensions, which)
        return replace(self, touch=touch), what

    def contacts(
        self, model: TangentModel, loop: Loop, film: FilmOfLoop, energy: LoopEnergy
    ) -> Contacts:
        """Return the contacts at a point's model; `energy` is that without them."""
        strands = self.bounds(loop).strands
        gaps, _ = strands.at(model.x, self.touch.gaps)
        return contacts_at(strands, film, energy, model, gaps)

    def kept(self) -> Mapping[str, NDArray[Any]]:
        """Return which gaps are closed, for `restored`."""
        own = {**vars(self.touch.gaps), "line": self.touch.line}
        return {f"touch.{name}": array for name, array in own.items()}

    def restored(self, kept: Mapping[str, NDArray[Any]]) -> Contact:
        """Return the contact that this was kept of."""
        s, t, slides, line = (
            kept[f"touch.{name}"] for name in ("s", "t", "slides", "line")
        )
        return replace(self, touch=Touch(Gaps(s, t, slides), line))


def contact_near(
    loop: Loop,
    x: FloatArray,
    value: float,
    gaps: Gaps | None,
    family: Callable[[Contact], Family],
) -> tuple[Contact, FloatArray]:
    """Return what is closed at the equilibrium next to x (n, d), and its loop.

    The gaps that are given, of those next to each other one, or all but closed at x, less
    what pulls, and what overlaps besides; x itself where Newton's method comes to nothing.
    `family` makes the family of a contact, of whose parameter this is the value.
    """
    contact = Contact(strands_of(loop))
    near: Gaps | None = gaps
    if near is None:
        near, _ = contact.strands.near(x, _CLOSED)
        # Along a line strands may be closer between two vertices than at any.
        near = near.joined(contact.strands.nearest(x, _CLOSED))
        near = near[contact.strands.distinct(near)]
    near = near[contact.strands.distinct(near, _BESIDE)]
    for _ in range(_CHANGES):
        assert near is not None
        points = Touch(near, np.zeros(len(near), dtype=bool))
        contact = replace(contact, touch=points).near(x)
        found = point_near(family(contact), x, value, -np.inf)
        if found is None:
            break
        x, tensions, bounds = found.x, found.model.tensions, contact.bounds(loop)
        near = bounds.mended(x, tensions)
        if near is None:
            told = replace(contact, touch=bounds.told(x, tensions))
            contact = told.near(x)
            if contact is told:
                break
            near = contact.gaps
    return contact, x
