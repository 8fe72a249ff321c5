"""Transitions of exact cells that are not located by one call."""

from __future__ import annotations

from math import log

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from eulerplateau.errors import SpecError
from eulerplateau.exact.cell import (
    RegularCell,
    SymmetryBreaking,
    folds,
    inflections,
    rigid_fold,
    symmetry_lost,
)

# Where the loss of symmetry is looked for, in units of the fold's rigid limit.
_LOADS, _BISECTIONS, _COARSE = (0.2, 1.2), 24, 12


def first_lost(adhesions: int) -> SymmetryBreaking:
    """Return the loss of symmetry at the least contractility that has one, by bisection."""
    low, high = (part * rigid_fold(adhesions).sigma_hat for part in _LOADS)
    found = symmetry_lost(adhesions, high)
    for _ in range(_BISECTIONS):
        middle = float(np.sqrt(low * high))
        point = symmetry_lost(adhesions, middle)
        low, high = (middle, high) if point is None else (low, middle)
        found = point or found
    if found is None:
        raise SpecError("adhesions", f"{adhesions} do not lose their symmetry")
    return found


def softest_lost(adhesions: int, first: float) -> SymmetryBreaking:
    """Return the loss of symmetry on the softest substrate, at loads above `first`."""

    def stiffness(log_load: float) -> float:
        point = symmetry_lost(adhesions, float(np.exp(log_load)))
        return np.inf if point is None else point.ks_hat

    logs = np.linspace(log(first) + 1e-3, log(6 * first), _COARSE)
    best = int(np.argmin([stiffness(float(at)) for at in logs]))
    bounds = logs[max(best - 1, 0)], logs[min(best + 1, len(logs) - 1)]
    options = {"xatol": 1e-4}
    least = minimize_scalar(stiffness, bounds=bounds, method="bounded", options=options)
    found = symmetry_lost(adhesions, float(np.exp(least.x)))
    if found is None:
        raise SpecError("adhesions", f"{adhesions} do not lose their symmetry")
    return found


def lost_at_stiffness(ks_hat: float, low: float, high: float) -> SymmetryBreaking:
    """Return where three adhesions lose their symmetry at ks_hat, between two loads."""

    def beyond(load: float) -> float:
        point = symmetry_lost(3, load)
        return 1.0 if point is None else point.ks_hat / ks_hat - 1

    found = symmetry_lost(3, float(brentq(beyond, low, high, xtol=1e-12, rtol=1e-14)))
    if found is None:
        raise SpecError("ks_hat", f"found {ks_hat:g}; should be one that breaks symmetry")
    return found


def along_load(ks_hat: float) -> dict[str, tuple[float, RegularCell]]:
    """Return what becomes of three adhesions as sigma_hat rises: loads and cells."""
    lower, upper = folds(3, ks_hat)
    inflected = inflections(3, ks_hat)
    places = {
        "inflection": inflected[0],
        "symmetry lost": lost_at_stiffness(ks_hat, 40.0, lower.sigma_hat),
        "fold": lower,
        "fold again": upper,
        "symmetric again": lost_at_stiffness(ks_hat, upper.sigma_hat, 5000.0),
        "convex again": inflected[1],
    }
    return {name: (place.sigma_hat, place.cell) for name, place in places.items()}
