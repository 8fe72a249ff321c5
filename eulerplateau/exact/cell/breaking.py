"""Where a regular cell loses its symmetry: a wave along its sides costs nothing any more.

The stable cell becomes unstable against unlike sides (stability.py) often before it reaches
the fold of its own symmetric shapes, and then earlier on a stiffer substrate too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq, minimize_scalar

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


def symmetry_lost(adhesions: int, sigma_hat: float) -> SymmetryBreaking | None:
    """Return where the stable cell first loses its symmetry; None if it never does."""
    return next(iter(symmetry_breaking(adhesions, sigma_hat)), None)


def _crossings(stretch: Stretch, q: int) -> Iterator[SymmetryBreaking]:
    """Yield where a wave's lowest eigenvalue changes its sign along a stretch."""

    def lowest(c: float) -> float:
        return stretch.at(c).cell.waves.lowest(q)

    # Next to the circle k_s is next to nothing, and the wave stable.
    places = np.linspace(stretch.round, stretch.end, _BRACKETS + 1)[1:]
    known = _with_dips(lowest, [(float(c), lowest(float(c))) for c in places])
    for (before, above), (after, below) in pairwise(known):
        if (above >= 0) != (below >= 0):
            c = float(brentq(lowest, after, before, xtol=1e-14, rtol=1e-14))
            point = stretch.at(c)
            lost = above >= 0
            yield SymmetryBreaking(point.sigma_hat, point.ks_hat, point.cell, q, lost)


def _with_dips(
    lowest: Callable[[float], float], known: list[tuple[float, float]]
) -> list[tuple[float, float]]:
    """Return places and values, and between them where values dip below zero.

    With many adhesions a wave may be unstable for a small part of the curve only.
    """
    found = known[:1]
    for before, here, after in zip(known, known[1:], known[2:], strict=False):
        found.append(here)
        if 0 <= here[1] <= min(before[1], after[1]):
            ends = after[0], before[0]
            dip = minimize_scalar(lowest, bounds=ends, method="bounded")
            if dip.fun < 0:
                found.append((float(dip.x), float(dip.fun)))
    found += known[-1:]
    return sorted(found, reverse=True)
