"""The loads between which strands of an eight touch in one point.

Below the lower one the eight opens: the force with which the strands push each other has
come to zero. Above the upper one a point of contact is not enough: beside it the strands
would be nearer than their diameter.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import chain, pairwise
from typing import Self

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.brent import zero_between
from eulerplateau.branches.conformal.contact_eight import reached, touching
from eulerplateau.branches.conformal.films import checked
from eulerplateau.branches.conformal.touching import Touching, in_contact, way
from eulerplateau.exact import checked_diameter
from eulerplateau.exact.conformal import TWISTED, make_basis, twisted_film
from eulerplateau.loop import LoopEnergy

# Where the search begins, the load up to which it goes, and to what part one is found.
_MIDDLE = 1700.0
_HIGHEST = 5100.0
_FOUND = 1e-9
# Strands that cross by less, in degrees, are about to lie along each other.
_CLOSED = 20.0


@dataclass(frozen=True)
class Forceless(Touching):
    """A film whose strands touch without force, at the load at which they do.

    Its `others` are beta and that load.
    """

    @property
    def tensions(self) -> FloatArray:
        """The multipliers (2,) of length and distance, beta and 0."""
        return np.array([self.others[0], 0.0])

    def with_unknowns(self, x: FloatArray, others: FloatArray) -> Self:
        """Return the film, or the guess, with other unknowns."""
        values = {**self.values, "load": float(others[1])}
        family = replace(self.family, values=values)
        return replace(self, family=family, x=x, others=others)

    def by_others(self, energy: LoopEnergy, slopes: FloatArray) -> FloatArray:
        """Return how what does not balance (size, 2) changes with the others."""
        return np.column_stack([slopes[0], energy.rate("load", self.x)])


def opening_load(
    diameter: float, twist_ratio: float = 0.0, link: float = 0.0
) -> float | None:
    """Return sigma_hat at which an eight opens when it is unloaded.

    Parameters are those of `thick_eight`. Where twist costs nothing it is the load of the
    twisted film as wide. That is also the one of a rod turned by as many turns as the film
    writhes, which has no twist; from there films whose strands touch without force are
    followed in the turns, their load an unknown, in seconds. None where Newton's method
    finds none on the way, or strands come to lie along each other. Raises SpecError for
    wrong parameters, and BranchError where harmonics do not resolve the twisted film.
    """
    checked(_MIDDLE, twist_ratio, link)
    free = twisted_film(diameter)
    if twist_ratio == 0:
        return free.load
    values = {"load": free.load, "twist_ratio": 0.0, "link": 0.0, "diameter": diameter}
    film = in_contact(free, values)
    values |= {
        "twist_ratio": twist_ratio,
        "link": film.family.twist(free.load).writhe(film.x),
    }
    family = replace(film.family, values=values)
    others = np.array([film.others[0], free.load])
    start = Forceless(family, film.x, others, film.corrections)
    for found in way(start, {**values, "link": abs(link)}):
        if found.values["link"] == abs(link):
            return found.values["load"]
        if found.crossing.angle < _CLOSED:
            break
    return None


def splitting_load(
    diameter: float, twist_ratio: float = 0.0, link: float = 0.0
) -> float | None:
    """Return sigma_hat beyond which one point of contact is not enough.

    Parameters are those of `thick_eight`. Films in contact are followed, in minutes: None
    if there is no such load below 5100, before Newton's method fails. Raises SpecError for
    wrong parameters, NoFilmError where no film is found to begin with.
    """
    return _crossed(_middle(diameter, twist_ratio, link), _HIGHEST, _convexity)


def _middle(diameter: float, twist_ratio: float, link: float) -> Touching:
    """Return the film with which a search begins."""
    checked(_MIDDLE, twist_ratio, link)
    values = {"load": _MIDDLE, "twist_ratio": twist_ratio, "link": abs(link)}
    return touching({**values, "diameter": checked_diameter(diameter)})


def _crossed(
    start: Touching, load: float, what: Callable[[Touching], float]
) -> float | None:
    """Return the first load on the way to one at which something vanishes, if it does."""
    films = chain([start], way(start, {**start.values, "load": load}))
    for near in pairwise(films):
        if what(near[0]) * what(near[1]) < 0:
            break
    else:
        return None

    def at(value: float) -> float:
        closest = min(near, key=lambda film: abs(film.values["load"] - value))
        return what(reached(closest, {**closest.values, "load": value}, 1.0))

    low, high = sorted(film.values["load"] for film in near)
    return zero_between(at, low, high, 2e-12, _FOUND)


def _convexity(film: Touching) -> float:
    """Return the convexity for ever more harmonics: its error falls as one over them."""
    basis = film.basis
    finer = film.in_basis(make_basis(3 * basis.harmonics // 2, TWISTED, basis.crowding))
    return film.convexity if finer is None else 3 * finer.convexity - 2 * film.convexity
