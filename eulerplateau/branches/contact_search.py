"""Newton's method to equilibria of a loop whose strands touch, stable or not.

As deflation.search, but on the way no strand overlaps another, or passes through it. Gaps
that a step would close are closed from there on, and let go where strands pull at each
other: what is found is at rest with its gaps held, whatever its index so, and all strands
that touch push. What only rests by a strand that pulls is none of the equilibria.

Loaded only for loops that have a diameter.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import cast

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.contact import Contact, contact_near
from eulerplateau.branches.deflation import (
    AGREES,
    FIRST_RADIUS,
    MADE_ANEW,
    NEXT,
    SMALLEST_RADIUS,
    STEPS,
    Step,
    wider,
)
from eulerplateau.branches.everywhere import FilmOnLoop, apart_everywhere
from eulerplateau.branches.point import BranchPoint, across_values, point_near
from eulerplateau.interruption import heed
from eulerplateau.loop import Gaps, passed
from eulerplateau.solvers import (
    CLOSED,
    Keeping,
    Touching,
    change_of_energy,
    noise_of,
    separated,
)

# As deflation's, and as many changes of what touches.
_STEPS = 2 * STEPS


def apart(family: FilmOnLoop, x: FloatArray) -> FloatArray | None:
    """Return a loop near x (n, d) whose strands do not overlap; None if there is none.

    Or if it bends more than a rod so thick can.
    """
    strands = _contact(family).strands
    found = separated(strands, x)
    if found is None or strands.loop.is_too_thick(found):
        return None
    return found


def search(
    family: FilmOnLoop, x: FloatArray, value: float, step: Step
) -> BranchPoint | None:
    """Return the equilibrium to which steps lead from a loop x (n, d) without overlaps.

    None if to none, or to one at which strands would pull.
    """
    way = _Way(family, value)
    try:
        touching, _ = way.keeping.strands.near(x, CLOSED)
        state: Touching | None = way.keeping.at(x, touching, FIRST_RADIUS)
        for _ in range(_STEPS):
            heed()
            if state is None:
                return None
            way = way.near(state.model.x)
            if state.model.residual < NEXT:
                return way.settled(state)
            state = way.advanced(state, step)
    except LinAlgError:  # no film on this loop, no step, or strands that meet
        return None
    return None


def _contact(family: FilmOnLoop) -> Contact:
    assert isinstance(family.contact, Contact)
    return family.contact


@dataclass(frozen=True)
class _Way:
    """How a search goes on where a family's film is good, whatever touches."""

    family: FilmOnLoop
    value: float

    @cached_property
    def keeping(self) -> Keeping:
        """What leads to loops without overlaps; downhill or not is for the steps to say."""
        problem, load = self.family.at(self.value)
        energy = self.family.film.energy(problem.loop, load)
        return Keeping(energy, _contact(self.family).strands)

    def near(self, x: FloatArray) -> _Way:
        """Return the way on from a loop x (n, d): the film made anew, where it must be."""
        if self.keeping.energy.holds(x):
            return self
        film = self.family.film.renewed(x)
        return replace(self, family=self.family.on(film))

    def advanced(self, state: Touching, step: Step) -> Touching | None:
        """Return the state after a step, as long as it can be trusted; None if none can.

        The model is asked about the energy of where the step has led: beside the strands
        that stop it.
        """
        model, energy, keeping = state.model, self.keeping.energy, self.keeping
        change, radius = step(model), state.radius
        size = float(np.linalg.norm(change))
        while np.isfinite(size) and size > 0.0 and radius > SMALLEST_RADIUS:
            part = min(1.0, radius / size) * change
            straight = model.x + model.displacement(part)
            reached = keeping.cleared(model.x, straight, state.gaps, state.beside)
            if reached is not None:
                x, gaps = reached
                gained = change_of_energy(energy, model.x, x)
                noise = noise_of(energy, model.x, x - model.x, model.tensions)
                led = model.coefficients(x - model.x)
                trusted = gained is not None and wider(model, led, gained, radius, noise)
                if trusted:
                    return keeping.moved(state, x, gaps, trusted)
            radius = 0.4 * min(size, radius)
        return None

    def settled(self, state: Touching) -> BranchPoint | None:
        """Return the equilibrium next to a state; None if strands would pass before it.

        What touches is mended until none of it pulls, nothing else overlaps, and strands
        along each other are held where a descent would hold them; the film is made anew
        until it agrees with itself.
        """
        way, x, gaps, before = self, state.model.x, state.gaps, None
        for _ in range(MADE_ANEW):
            point = way._next_to(x, gaps)
            if point is None or passed(state.model.x, point.x):
                return None
            family, keeping = cast(FilmOnLoop, point.family), way.keeping
            gaps = _contact(family).touch.gaps
            mended = keeping.mended(keeping.at(point.x, gaps, FIRST_RADIUS))
            if mended is not None:
                x, gaps = mended.model.x, mended.gaps
                continue
            x, film = point.x, family.film.renewed(point.x)
            if film is family.film or (before is not None and _agrees(before, x)):
                return apart_everywhere(point, across_values(point.x, 1.0))
            way, before = replace(self, family=family.on(film)), x
        return None

    def _next_to(self, x: FloatArray, gaps: Gaps) -> BranchPoint | None:
        """Return the equilibrium next to a loop at which nothing pulls or overlaps."""
        problem, _ = self.family.at(self.value)

        def family(contact: Contact) -> FilmOnLoop:
            return self.family.on(self.family.film, contact)

        contact, x = contact_near(problem.loop, x, self.value, gaps, family)
        point = point_near(family(contact), x, self.value)
        if point is None:
            return None
        bounds = contact.bounds(problem.loop)
        ends = bounds.mended(point.x, point.model.tensions) is None
        return point if ends else None


def _agrees(before: FloatArray, x: FloatArray) -> bool:
    return float(np.abs(x - before).max()) < AGREES
