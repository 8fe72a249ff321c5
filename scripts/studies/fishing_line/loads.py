"""Where a loop whose twist escapes jumps and where it opens, by the line's diameter."""

from __future__ import annotations

from collections.abc import Iterator
from math import exp, log

import numpy as np
from numpy.polynomial import Chebyshev

from eulerplateau.arrays import FloatArray
from eulerplateau.exact import planar_film
from eulerplateau.exact.conformal import (
    crossing,
    lobes_twist,
    quick_opening_load,
    twisted_film,
    twisted_films,
)

DIAMETERS = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
# The interpolant of `quick_opening_load`: its ends, and its degree.
_THINNEST, _THICKEST, _DEGREE = 5e-4, 0.1, 18


def openings() -> Iterator[list[str]]:
    """Yield for each diameter where its eight opens, and what the film is like there."""
    yield ["d", "opens", "length", "angle", "E - E(flat)", "error of estimate"]
    jumps = lobes_twist()
    for film in map(twisted_film, DIAMETERS):
        at = crossing(film.basis, film.coefficients)
        flat = planar_film(2, film.load).energy
        off = quick_opening_load(round(at.distance, 9)) - film.load
        yield [
            f"{at.distance:g}",
            f"{film.load:.4f}",
            f"{(film.load / jumps) ** (1 / 3):.4f}",
            f"{at.angle:.2f}",
            f"{film.energy - flat:.4f}",
            f"{off:.0e}",
        ]


def free_waists() -> tuple[FloatArray, FloatArray]:
    """Return loads and waists of the unstable twisted films, down to the thinnest line."""
    films = list(twisted_films(DIAMETERS[-1]))
    waists = [crossing(film.basis, film.coefficients).distance for film in films]
    return np.array([film.load for film in films]), np.array(waists)


def flat_waist(load: float) -> float:
    """Return the least width of the flat film at a load, two lobes or disk."""
    x, y = planar_film(2, load).positions(np.array([0.25, 0.75]))
    return float(np.hypot(*(x - y)))


def coefficients() -> list[float]:
    """Return those of the load's Chebyshev series in the logarithm of the diameter."""

    def loads(logs: FloatArray) -> FloatArray:
        return np.array([twisted_film(exp(each)).load for each in logs])

    domain = log(_THINNEST), log(_THICKEST)
    found: list[float] = Chebyshev.interpolate(loads, _DEGREE, domain).coef.tolist()
    return found
