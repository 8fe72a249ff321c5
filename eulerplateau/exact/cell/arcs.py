"""Cells without bending: circular arcs of radius beta / sigma between adhesions.

The limit alpha -> 0 with line tension beta > 0 (Bischofs et al. 2008). A side that spans a
chord d is a concave arc of half the opening angle phi, sin(phi) = sigma d / (2 beta); the
tension of two arcs pulls an adhesion inwards, 2 beta sin(pi / N + phi) = 2 k_s Delta.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from eulerplateau.errors import SpecError
from eulerplateau.exact.checks import finite, whole_number


@dataclass(frozen=True)
class ArcCell:
    """A cell of N arcs; lengths in units of R_0, forces in any unit.

    Attributes
    ----------
    adhesions : int, N
    opening : float, phi, half the angle of an arc
    arc_radius : float, beta / sigma; infinite without contractility
    extension : float, Delta
    traction : float, 2 k_s Delta
    perimeter, area, energy : float, the energy without bending
    """

    adhesions: int
    opening: float
    arc_radius: float
    extension: float
    traction: float
    perimeter: float
    area: float
    energy: float


def arc_cell(adhesions: int, sigma: float, stiffness: float, beta: float) -> ArcCell:
    """Return the cell of arcs that the springs hold.

    Raises SpecError where there is none: a side longer than 2 beta / sigma, or sides that
    meet before the adhesion, phi > pi / 2 - pi / N.
    """
    n = whole_number("adhesions", adhesions, 2)
    sigma, beta = finite("sigma", sigma), finite("beta", beta)
    k = finite("stiffness", stiffness)
    if not (beta > 0 and k > 0):
        raise SpecError("beta", "and stiffness should be above 0")
    angle = np.pi / n

    def opening(extension: float) -> float:
        return float(np.arcsin((1 - extension) * np.sin(angle) * sigma / beta))

    def excess(extension: float) -> float:
        return float(beta * np.sin(angle + opening(extension)) - k * extension)

    narrowest = (
        max(0.0, 1 - beta / (sigma * np.sin(angle)) * np.cos(angle)) if sigma else 0.0
    )
    if narrowest and excess(narrowest) < 0:
        raise SpecError("sigma", "is too large: the arcs meet before the adhesions")
    extension = float(brentq(excess, narrowest, 1.0, xtol=1e-15, rtol=1e-15))
    phi = opening(extension)
    half = (1 - extension) * np.sin(angle)
    length = half * phi / np.sin(phi) if phi else half
    bulge = 0.5 * half**2 * (phi / np.sin(phi) ** 2 - 1 / np.tan(phi)) if phi else 0.0
    area = 2.0 * n * (0.5 * half**2 / np.tan(angle) - bulge)
    perimeter = float(2 * n * length)
    return ArcCell(
        adhesions=n,
        opening=phi,
        arc_radius=beta / sigma if sigma else np.inf,
        extension=extension,
        traction=2 * k * extension,
        perimeter=perimeter,
        area=area,
        energy=sigma * area + beta * perimeter + n * k * extension**2,
    )
