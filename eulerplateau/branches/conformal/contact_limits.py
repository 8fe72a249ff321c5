"""The loads between which strands of an eight touch in one point.

Below the lower one the eight opens: the force with which the strands push each other has
come to zero. Above the upper one a point of contact is not enough: beside it the strands
would be nearer than their diameter.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import chain, pairwise

from scipy.optimize import brentq

from eulerplateau.branches.conformal.contact_eight import (
    reached,
    touching,
)
from eulerplateau.branches.conformal.films import checked
from eulerplateau.branches.conformal.touching import Touching, way
from eulerplateau.exact import checked_diameter
from eulerplateau.exact.conformal import TWISTED, make_basis, twisted_film

# Where the search begins, the loads up to which it goes, and to what part one is found.
_MIDDLE = 1700.0
_LOWEST, _HIGHEST = 25.0, 5100.0
_FOUND = 1e-9


def opening_load(
    diameter: float, twist_ratio: float = 0.0, link: float = 0.0
) -> float | None:
    """Return sigma_hat at which an eight opens when it is unloaded.

    Parameters are those of `thick_eight`. Where twist costs nothing it is the load of the
    twisted film as wide, in seconds. With twist films in contact are followed, in minutes:
    None if there is no such load above 25, or below 5100, before Newton's method fails.
    Raises SpecError for wrong parameters, NoFilmError where no film is found to begin
    with, and BranchError where harmonics do not resolve the twisted one.
    """
    checked(_MIDDLE, twist_ratio, link)
    if twist_ratio == 0:
        return twisted_film(diameter).load
    start = _middle(diameter, twist_ratio, link)
    return _crossed(start, _LOWEST if start.force > 0 else _HIGHEST, _force)


def splitting_load(
    diameter: float, twist_ratio: float = 0.0, link: float = 0.0
) -> float | None:
    """Return sigma_hat beyond which one point of contact is not enough, as above."""
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
    return float(brentq(at, low, high, rtol=_FOUND))


def _force(film: Touching) -> float:
    return film.force


def _convexity(film: Touching) -> float:
    """Return the convexity for ever more harmonics: its error falls as one over them."""
    basis = film.basis
    finer = film.in_basis(make_basis(3 * basis.harmonics // 2, TWISTED, basis.crowding))
    return film.convexity if finer is None else 3 * finer.convexity - 2 * film.convexity
