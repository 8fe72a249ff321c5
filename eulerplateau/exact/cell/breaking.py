"""Where a regular cell loses its symmetry: a wave along its sides costs nothing any more.

The stable cell becomes unstable against unlike sides (stability.py) often before it reaches
the fold of its own symmetric shapes, and then earlier on a stiffer substrate too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from eulerplateau.errors import SpecError
from eulerplateau.exact.cell.transitions import Stretch, Transition, stable_stretch
from eulerplateau.exact.checks import finite, whole_number

# Shapes along the curve between which an eigenvalue changes its sign at most once.
_BRACKETS = 16


@dataclass(frozen=True)
class SymmetryBreaking(Transition):
    """A point where a wave of number q has an eigenvalue zero.

    Attributes
    ----------
    q : int, from 1 to N / 2; two modes at once unless it is N / 2
    lost : bool, whether the wave is unstable on a substrate a little stiffer, or stable
    """

    q: int
    lost: bool


def symmetry_breaking(adhesions: int, sigma_hat: float) -> tuple[SymmetryBreaking, ...]:
    """Return where waves lose and regain their stability as the substrate stiffens.

    From next to nothing up to the fold, or where there is none up to a rigid substrate; the
    softest comes first. Raises SpecError up to sigma_hat = 1, where cells do not pull.
    """
    n = whole_number("adhesions", adhesions, 2)
    sigma = finite("sigma_hat", sigma_hat)
    if sigma <= 1.0:
        raise SpecError("sigma_hat", f"found {sigma:g}; should be above 1: cells pull")
    stretch = stable_stretch(n, sigma)
    found = [point for q in range(1, n // 2 + 1) for point in _crossings(stretch, q)]
    return tuple(sorted(found, key=lambda point: point.ks_hat))


def _crossings(stretch: Stretch, q: int) -> Iterator[SymmetryBreaking]:
    """Yield where a wave's lowest eigenvalue changes its sign along a stretch."""

    def lowest(c: float) -> float:
        return stretch.at(c).cell.waves.lowest(q)

    # Next to the circle k_s is next to nothing, and the wave stable.
    places = np.linspace(stretch.round, stretch.end, _BRACKETS + 1)[1:]
    stable = np.array([lowest(place) >= 0 for place in places])
    for place in np.flatnonzero(stable[1:] != stable[:-1]):
        ends = places[place + 1], places[place]
        point = stretch.at(float(brentq(lowest, *ends, xtol=1e-14, rtol=1e-14)))
        lost = bool(stable[place])
        yield SymmetryBreaking(point.sigma_hat, point.ks_hat, point.cell, q, lost)
