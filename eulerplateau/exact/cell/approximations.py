"""The paper's approximate cell: curvature a parabola, width constant, length by a quartic.

Each formula is a function of its own, so that each can be measured against the exact cell
(scripts/cell_approximations). Units alpha = R_0 = 1; `side` is the length l of a side.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from eulerplateau.arrays import FloatArray

if TYPE_CHECKING:
    from eulerplateau.exact.cell.regular import RegularCell


def parabola(
    s: ArrayLike, side: float, sigma_hat: float, kappa_adhesion: float
) -> FloatArray:
    """Return kappa(s) = kappa_0 + sigma s (s - l) / 4 for s in [0, l] (eq. curvature)."""
    s = np.asarray(s, dtype=np.float64)
    return kappa_adhesion + 0.25 * sigma_hat * s * (s - side)


def parabola_kappa_adhesion(adhesions: int, side: float, sigma_hat: float) -> float:
    """Return kappa_0 = sigma l^2 / 24 + 2 pi / (N l), by the turning of the tangent."""
    return sigma_hat * side**2 / 24 + 2 * np.pi / (adhesions * side)


def parabola_traction(side: float, sigma_hat: float) -> float:
    """Return T = sigma l (eq. traction-length)."""
    return sigma_hat * side


def constant_width(adhesions: int, side: float) -> float:
    """Return the width N l / pi of a curve of constant width (Barbier's theorem)."""
    return adhesions * side / np.pi


def quartic_side(adhesions: int, sigma_hat: float, ks_hat: float) -> float:
    """Return the length of a side: the positive root of the quartic (eq. traction).

    Its left side less its right rises with l, so that there is one.
    """
    n = adhesions
    across = 1 + np.cos(np.pi / n)
    linear = n / np.pi + across * sigma_hat / (2 * ks_hat) - np.pi / (4 * n)
    roots = np.roots([sigma_hat / 768, 0.0, 0.0, linear, -across])
    real = roots[np.abs(roots.imag) < 1e-9 * np.abs(roots)].real
    return float(real[real > 0].min())


def errors(cell: RegularCell) -> dict[str, float]:
    """Return the relative error of each formula, the others' arguments taken exact.

    kappa: the largest error along a side over the largest curvature, kappa_0 and l exact.
    kappa_adhesion, traction, width: l exact. side, quartic_traction: nothing exact.
    """
    n, sigma = cell.side.adhesions, cell.sigma_hat
    side = cell.perimeter / n
    u = np.linspace(-1, 1, 401)
    exact = cell.side.curvature(u)
    near = parabola(0.5 * (u + 1) * side, side, sigma, cell.kappa_adhesion)
    quartic = quartic_side(n, sigma, cell.ks_hat)
    return {
        "kappa": float(np.abs(near - exact).max() / np.abs(exact).max()),
        "kappa_adhesion": parabola_kappa_adhesion(n, side, sigma) / cell.kappa_adhesion - 1,
        "traction": parabola_traction(side, sigma) / cell.traction - 1,
        "width": constant_width(n, side) / cell.width - 1,
        "side": quartic / side - 1,
        "quartic_traction": parabola_traction(quartic, sigma) / cell.traction - 1,
    }
