"""Where an eight in contact opens: at the twisted film whose waist is as wide as the line.

Strands of a loop of diameter d that touch in one point push each other until, on unloading,
that force has come to zero. The film there is one of a loop without a diameter: the
unstable twisted film (docs/true-film.md), its waist being d. So it has no kinks, and few
harmonics say it to many digits. Twisted films are followed here in their waist, which
falls all the way from where they leave the flat ones; the load is an unknown.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import cbrt, ceil, exp, log, nan, sqrt

import numpy as np
from numpy.polynomial import Chebyshev
from scipy.interpolate import KroghInterpolator
from scipy.optimize import brentq

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.checks import checked_diameter
from eulerplateau.exact.conformal.basis import Basis, make_basis
from eulerplateau.exact.conformal.branch import BranchError
from eulerplateau.exact.conformal.equilibrium import (
    ConformalFilm,
    Direction,
    correct,
    precondition,
)
from eulerplateau.exact.conformal.families import TWISTED
from eulerplateau.exact.conformal.geometry import waist
from eulerplateau.exact.conformal.held_waist import width_gradient

# The film to begin with, where Newton's method starts (to be converged): its waist, the
# first harmonics of x, y and z in 1e-5 L, beta and load.
_WIDEST = 0.1
_COEFFICIENTS = (
    (19287, 2450, -234, -361, -132, -4, 21, 11, 2, -1),
    (6453, 1474, -181, -298, -110, -4, 18, 10, 2, -1),
    (-2814, -266, 220, 133, 28, -9, -9, -3, 0, 1),
)
_BETA, _LOAD = -70.3, 1742.0
_BEGIN, _FIRST_HARMONICS = 20, 48
# Harmonics per logarithm of the width, in blocks: films of one number extrapolate best.
_HARMONICS, _BLOCK = 21, 24
# The crowding of the grid: the neck's conformal length is a power of its width, nearly.
_CROWDING, _AT, _POWER = 2.7e-5, 0.01, 2.3
# Steps in the logarithm of the width: first, longest and shortest; corrections up to which
# they grow, and at most; films that the next is extrapolated from.
_FIRST, _LONGEST, _SHORTEST = 0.02, 0.5, 1e-3
_GROWTH, _EASY, _HARD = 1.5, 6, 10
_KNOWN = 6
# The load by the logarithm of the width, from those films: `scripts/fishing_line
# --coefficients` prints these numbers. Good to 1e-4.
_LOADS = Chebyshev(
    (
        914.244217,
        610.704242,
        181.885317,
        40.762236,
        2.276929,
        -3.872812,
        -2.582042,
        -0.983505,
        -0.214170,
        0.015454,
        0.040925,
        0.022421,
        0.007456,
        0.001150,
        -0.000431,
        -0.000440,
        -0.000204,
        -0.000059,
        -0.000008,
    ),
    domain=(log(5e-4), log(_WIDEST)),
)


def quick_opening_load(diameter: float) -> float:
    """Return sigma_hat at which an eight opens whose twist escapes, to 1e-4, at once.

    Raises SpecError unless 5e-4 <= diameter <= 0.1, in L. `twisted_film` knows more digits.
    """
    found = log(checked_diameter(diameter))
    if found < _LOADS.domain[0]:
        raise SpecError("diameter", f"found {diameter:g}; should be 0.0005 or more")
    return float(_LOADS(found))


def quick_opening_load_by_width(width: float) -> float:
    """Return that for a line of a diameter in units of (alpha / sigma)^(1/3).

    NaN where the diameter is less or more, in units of L, than `quick_opening_load` takes.
    """

    def too_wide(size: float) -> float:
        return exp(size) * cbrt(float(_LOADS(size))) - width

    low, high = _LOADS.domain
    if not too_wide(low) <= 0 <= too_wide(high):
        return nan
    return float(_LOADS(brentq(too_wide, low, high)))


def twisted_film(width: float) -> ConformalFilm:
    """Return the unstable twisted film with a waist of this width, at its load.

    It is where an eight in contact of a loop of this diameter opens. Raises SpecError
    unless 0 < width <= 0.1, in L, and BranchError where harmonics do not resolve it.
    """
    *_, film = twisted_films(width)
    return film


def twisted_films(narrowest: float) -> Iterator[ConformalFilm]:
    """Yield twisted films of falling waist, from 0.1 L to one as narrow as is asked for."""
    end = log(checked_diameter(narrowest))
    known, step = [_first()], _FIRST
    yield known[0]
    while (done := log(waist(known[-1]))) > end + 1e-12:
        there = max(done - step, end)
        found = _beyond(known[-_KNOWN:], there)
        if found is None:
            step /= 2
            if step < _SHORTEST:
                problem = f"no twisted film found beyond a waist of {exp(done):g}"
                raise BranchError(problem, "unresolved")
            continue
        known.append(found)
        yield found
        if found.corrections <= _EASY:
            step = min(_GROWTH * step, _LONGEST)


def _first() -> ConformalFilm:
    """Return the film to begin with."""
    basis = make_basis(_FIRST_HARMONICS, TWISTED, _crowding(_WIDEST))
    c = np.zeros(basis.size)
    for part, begin in zip(basis.slices, _COEFFICIENTS, strict=True):
        c[part][: len(begin)] = begin
    film = _as_wide(basis, 1e-5 * c, _BETA, _LOAD, _WIDEST, _BEGIN)
    if film is None:
        raise BranchError("no twisted film found to begin with")
    return film


def _beyond(known: Sequence[ConformalFilm], there: float) -> ConformalFilm | None:
    """Return the film whose waist has a logarithm, extrapolated from known ones."""
    width = exp(there)
    basis = make_basis(_harmonics(width), TWISTED, _crowding(width))
    widths = [log(waist(film)) for film in known]
    values = [
        [*basis.embed(film.basis, film.coefficients), film.beta, log(film.load)]
        for film in known
    ]
    ahead = KroghInterpolator(widths, np.array(values))(there)
    return _as_wide(basis, ahead[:-2], ahead[-2], exp(ahead[-1]), width, _HARD)


def _as_wide(
    basis: Basis, guess: FloatArray, beta: float, load: float, width: float, limit: int
) -> ConformalFilm | None:
    """Return the film near a guess (size,) that has this waist; None if Newton fails.

    The guess is given the waist first, by the change that bends it least.
    """
    across = width_gradient(basis)
    least = precondition(basis) ** 2 * across
    guess = guess + (width - across @ guess) / (across @ least) * least
    normal = across / basis.wavenumbers**2
    held = Direction(normal / sqrt(across @ normal), 0.0)
    return correct(basis, guess, beta, load, held, limit)


def _harmonics(width: float) -> int:
    return max(_BLOCK * ceil(_HARMONICS * log(1 / width) / _BLOCK), _FIRST_HARMONICS)


def _crowding(width: float) -> float:
    return float(_CROWDING * (width / _AT) ** _POWER)
