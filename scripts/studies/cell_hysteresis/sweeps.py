"""Minima followed in the contractility until there is none next to the last one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.cells import Cell, CellEquilibrium, regular_sites, solve_cell

_BISECTIONS = 10
# Vertices nearer than this along the edge are no contact.
_NEIGHBOURS = 6


@dataclass(frozen=True)
class End:
    """Where a sweep ends.

    Attributes
    ----------
    last : the last minimum
    after : what it goes over to at the next contractility
    """

    last: CellEquilibrium
    after: CellEquilibrium


def followed(start: CellEquilibrium, step: float, end: float) -> End | None:
    """Follow a minimum in steps of sigma_hat; return where it is lost, by bisection.

    None if it lasts up to `end`.
    """
    last, ks = start, start.ks_hat
    load = start.sigma_hat
    while (end - load) * step > 0:
        load += step
        after = solve_cell(start.cell, load, ks, last)
        if not kept(last, after):
            break
        last = after
    else:
        return None
    for _ in range(_BISECTIONS):
        load = 0.5 * (last.sigma_hat + after.sigma_hat)
        trial = solve_cell(start.cell, load, ks, last)
        if kept(last, trial):
            last = trial
        else:
            after = trial
    return End(last, after)


def kept(last: CellEquilibrium, after: CellEquilibrium) -> bool:
    """Return whether a minimum is still there, and as symmetric as before."""
    alike = np.ptp(after.extensions) < 1e-4 + np.ptp(last.extensions)
    return after.converged and bool(alike)


def light_start(edges: int, sigma_hat: float, ks_hat: float) -> CellEquilibrium:
    """Return the minimum at a contractility that hardly bends the cell."""
    return solve_cell(Cell(regular_sites(3), edges), sigma_hat, ks_hat)


def nearest(found: CellEquilibrium) -> tuple[float, float]:
    """Return the two places that are nearest to touching, in sides from an adhesion."""
    x, m = found.x, found.cell.edges_per_side
    n = len(x)
    gaps: FloatArray = np.hypot(*(x[:, None] - x[None]).transpose(2, 0, 1))
    i, j = np.indices(gaps.shape)
    gaps[np.minimum((i - j) % n, (j - i) % n) <= _NEIGHBOURS] = np.inf
    first, second = np.unravel_index(int(gaps.argmin()), gaps.shape)
    return float(first / m), float(second / m)
