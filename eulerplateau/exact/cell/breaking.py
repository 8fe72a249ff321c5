"""Where a regular cell loses its symmetry: a wave along its sides costs nothing any more.

The stable cell becomes unstable against unlike sides (stability.py) often before it reaches
the fold of its own symmetric shapes, and then earlier on a stiffer substrate too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from eulerplateau.errors import SpecError
from eulerplateau.exact.cell.transitions import Stretch, Transition, stable_stretch
from eulerplateau.exact.checks import finite, whole_number

# Shapes along the curve between which a wave is looked for that becomes unstable. With
# many adhesions it may do so for a small part of the curve only.
_BRACKETS = 16


@dataclass(frozen=True)
class SymmetryBreaking(Transition):
    """A point where a wave of number q has an eigenvalue zero.

    Attributes
    ----------
    q : int, from 1 to N / 2; two modes at once unless it is N / 2
    """

    q: int


def symmetry_breaking(adhesions: int, sigma_hat: float) -> SymmetryBreaking | None:
    """Return where the stable cell first loses its symmetry as the substrate stiffens.

    None if it does not before the fold, or on no substrate. Raises SpecError up to
    sigma_hat = 1, where cells do not pull.
    """
    n = whole_number("adhesions", adhesions, 2)
    sigma = finite("sigma_hat", sigma_hat)
    if sigma <= 1.0:
        raise SpecError("sigma_hat", f"found {sigma:g}; should be above 1: cells pull")
    stretch = stable_stretch(n, sigma)
    found = [point for q in range(1, n // 2 + 1) if (point := _lost(stretch, q))]
    return min(found, key=lambda point: point.ks_hat, default=None)


def _lost(stretch: Stretch, q: int) -> SymmetryBreaking | None:
    """Return where a wave first becomes unstable along a stretch of shapes."""

    def lowest(c: float) -> float:
        return stretch.at(c).cell.waves.lowest(q)

    # Next to the circle k_s is next to nothing, and the wave stable.
    places = np.linspace(stretch.round, stretch.end, _BRACKETS + 1)[1:]
    values = [lowest(float(c)) for c in places]
    for i in range(1, len(places)):
        unstable = float(places[i])
        if values[i] >= 0:
            # On a stiffer substrate still it may be stable again: what lies between?
            if i + 1 == len(places) or values[i] > min(values[i - 1], values[i + 1]):
                continue
            bounds = (float(places[i + 1]), float(places[i - 1]))
            dip = minimize_scalar(lowest, bounds=bounds, method="bounded")
            unstable = float(dip.x)
            if dip.fun >= 0:
                continue
        before = float(places[i - 1])
        c = float(brentq(lowest, unstable, before, xtol=1e-14, rtol=1e-14))
        point = stretch.at(c)
        return SymmetryBreaking(point.sigma_hat, point.ks_hat, point.cell, q)
    return None
