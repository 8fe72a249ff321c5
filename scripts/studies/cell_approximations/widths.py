"""Exact cells' widths in all directions, and exact relations of their traction.

Along a side F = (kappa^2 - beta) t + 2 kappa' n is the force in the edge (tension
positive), and F - sigma J r is constant, J the quarter turn. In mid-side F lies along the
chord; at an adhesion t is at right angles to the radius. With the adhesions at the radius
rho = R_0 - Delta that leaves

    T = 2 tan(pi / N) (sigma rho + beta - kappa_0^2),

and for two adhesions kappa_0^2 = sigma rho + beta. Integrated along a side the
equilibrium is T = sigma l + 2 pi beta / N - int kappa^3 ds: what T = sigma l leaves out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.exact.cell import RegularCell

_POINTS, _DIRECTIONS, _NODES = 1000, 720, 400


@dataclass(frozen=True)
class Widths:
    """Widths of a cell over all directions, as parts of perimeter / pi.

    Of a convex curve the mean is 1 (Cauchy).
    """

    least: float
    most: float
    mean: float

    @property
    def spread(self) -> float:
        """How much the largest exceeds the least, as a part of perimeter / pi."""
        return self.most - self.least


def widths(cell: RegularCell) -> Widths:
    """Return the least, largest and mean width."""
    outline = cell.outline(_POINTS)
    angle = np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    along = outline @ np.stack([np.cos(angle), np.sin(angle)])
    found = np.ptp(along, axis=0) * np.pi / cell.perimeter
    return Widths(float(found.min()), float(found.max()), float(found.mean()))


def traction_by_forces(cell: RegularCell) -> float:
    """Return T = 2 tan(pi / N) (sigma rho + beta - kappa_0^2)."""
    return float(2 * np.tan(cell.side.angle) * (pull(cell) - cell.kappa_adhesion**2))


def pull(cell: RegularCell) -> float:
    """Return sigma rho + beta."""
    return cell.sigma_hat * (1 - cell.extension) + cell.beta_hat


def cubed_curvature(cell: RegularCell) -> float:
    """Return the integral of kappa^3 along a side."""
    nodes, shares = np.polynomial.legendre.leggauss(_NODES)
    return float(cell.side.h * (shares @ cell.side.curvature(nodes) ** 3))


def traction_by_integration(cell: RegularCell) -> float:
    """Return T = sigma l + 2 pi beta / N - int kappa^3 ds."""
    line = 2 * cell.side.angle * cell.beta_hat
    return cell.sigma_hat * 2 * cell.side.h + line - cubed_curvature(cell)
