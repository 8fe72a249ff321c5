"""The same transitions of polygons, and what they tend to with ever shorter edges."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from eulerplateau.arrays import FloatArray
from eulerplateau.cells import (
    Cell,
    CellEquilibrium,
    cell_near,
    explore_cell,
    regular_sites,
    solve_cell,
)
from eulerplateau.exact.cell import RegularCell


def special_points(
    edges: int,
    parameter: str,
    window: tuple[float, float],
    fixed: float,
    exact: RegularCell,
) -> list[tuple[str, int, float]]:
    """Return kind, multiplicity and value of the special points up to the first fold.

    The branch starts next to an exact cell, in the window.
    """
    pair = (exact.sigma_hat, fixed) if parameter == "load" else (fixed, exact.ks_hat)
    start = near_exact(exact, edges, *pair)
    found = []
    points = explore_cell(start.cell, parameter, window, fixed, start, special_points=0)
    for point in points:
        if point.special is not None:
            found.append((point.special.kind, point.special.multiplicity, point.value))
            if point.special.kind == "fold":
                break
    return found


def near_exact(
    exact: RegularCell, edges: int, sigma_hat: float, ks_hat: float
) -> CellEquilibrium:
    """Return the polygon's equilibrium next to an exact cell."""
    n = exact.side.adhesions
    x = exact.outline(edges)
    turned = (x[:, 0] + 1j * x[:, 1]) * np.exp(2j * np.pi * (0.5 / n + 0.25))
    places: FloatArray = np.stack([turned.real, turned.imag], axis=-1)
    cell = Cell(regular_sites(n), edges)
    return cell_near(cell, places, sigma_hat, ks_hat)


def inflection(adhesions: int, edges: int, ks_hat: float, guess: float) -> float:
    """Return the contractility at which the middle of a side is straight."""
    cell = Cell(regular_sites(adhesions), edges)

    def curvature(load: float) -> float:
        return float(solve_cell(cell, load, ks_hat).kappa_mid.mean())

    return float(brentq(curvature, 0.8 * guess, 1.2 * guess, xtol=1e-9))
