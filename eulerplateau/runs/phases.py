"""A phase diagram of a cell as data: its lines, its regions, the shapes in them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.arrays import FloatArray

if TYPE_CHECKING:
    from eulerplateau.cells import CellEquilibrium

REGIONS = ("convex", "inflected", "unlike sides", "collapsed")


@dataclass(frozen=True)
class Line:
    """A line of the diagram, by points located one by one.

    Attributes
    ----------
    name : "inflection", "symmetry lost", "symmetry regained" or "fold"
    sigma_hat, ks_hat : (n,) float
    """

    name: str
    sigma_hat: FloatArray
    ks_hat: FloatArray

    def at(self, sigma_hat: FloatArray) -> FloatArray:
        """Return its stiffness between its points; infinite where it does not reach."""
        if not len(self.sigma_hat):
            return np.full_like(sigma_hat, np.inf)
        x, y = np.log(self.sigma_hat), np.log(self.ks_hat)
        inside = np.interp(np.log(sigma_hat), x, y, left=np.inf, right=np.inf)
        return np.exp(inside)


@dataclass(frozen=True)
class PhaseDiagram:
    """A phase diagram, computed.

    Attributes
    ----------
    folder : Path
    sigma_hat, ks_hat : (low, high), the window
    lines : Line, by name
    points : (sigma_hat, ks_hat), of the special points by name
    sigma_p : float or None, from which on there are stars
    shapes : by the region, the cell that is solved for in its middle
    room : by the region, how far its middle is from its border, as a part of the axes
    """

    folder: Path
    sigma_hat: tuple[float, float]
    ks_hat: tuple[float, float]
    lines: dict[str, Line]
    points: dict[str, tuple[float, float]]
    sigma_p: float | None
    shapes: dict[str, CellEquilibrium]
    room: dict[str, float]
    seconds: float

    def regions(self, sigma_hat: FloatArray, ks_hat: FloatArray) -> Any:
        """Return the region, by its place in REGIONS, of points of the plane."""
        at = {name: line.at(sigma_hat) for name, line in self.lines.items()}
        region = np.where(ks_hat > at["inflection"], 1, 0)
        unlike = (ks_hat > at["symmetry lost"]) & (ks_hat < at["symmetry regained"])
        return np.where(ks_hat > at["fold"], 3, np.where(unlike, 2, region))
