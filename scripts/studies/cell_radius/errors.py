"""Errors of the interpolation formula, and how they vanish at its ends."""

from __future__ import annotations

from dataclasses import dataclass
from math import log

import numpy as np
from scipy.optimize import minimize_scalar

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.cell import cell_radius, interpolated_radius

STIFFNESSES = 10.0 ** np.arange(-2, 6)
# The paper's smooth muscle cells: 1.05 / 0.16.
MUSCLE = 1.05 / 0.16
TENSIONS = np.sort([*10.0 ** np.arange(-3, 5), MUSCLE])
# Where orders are measured, as k_s / sigma; a factor of two apart.
SOFT, STIFF = np.array([1e-4, 2e-4]), np.array([1e5, 2e5])


def error(stiffness: FloatArray | float, tension: FloatArray | float) -> FloatArray:
    """Return the formula's relative error."""
    exact = cell_radius(stiffness, tension, 1.0)
    found: FloatArray = interpolated_radius(stiffness, tension, 1.0) / exact - 1
    return found


@dataclass(frozen=True)
class Worst:
    """The formula's worst relative error at a tension, and its orders at both ends.

    An order is the power of k_s (soft), or of 1 / k_s (stiff), with which the error
    vanishes: 1 where only the limit is right, 2 where the slope is too.
    """

    tension: float
    stiffness: float
    error: float
    soft_order: float
    stiff_order: float


def worst(tension: float) -> Worst:
    """Return the worst case over all stiffnesses at a tension."""
    logs = np.linspace(log(1e-6), log(1e9), 2000)
    at = logs[np.argmin(error(np.exp(logs), tension))]
    found = minimize_scalar(
        lambda t: float(error(np.exp(t), tension)),
        bounds=(at - 0.1, at + 0.1),
        method="bounded",
        options={"xatol": 1e-8},
    )
    soft, stiff = (order(ends * tension, tension) for ends in (SOFT, STIFF))
    return Worst(tension, float(np.exp(found.x)), float(found.fun), soft, -stiff)


def order(stiffness: FloatArray, tension: float) -> float:
    """Return the power of the stiffness by which the error grows between two of them."""
    first, second = np.abs(error(stiffness, tension))
    return log(second / first) / log(stiffness[1] / stiffness[0])
