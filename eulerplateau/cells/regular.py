"""A cell on a regular polygon: which of its displacements are as symmetric as the polygon.

The polygon's N rotations and N mirrors take adhesions to adhesions and permute the
vertices. A displacement that all of them leave as it is keeps a symmetric cell symmetric.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.cells.cell import Cell
from eulerplateau.cells.equilibrium import CellEquilibrium
from eulerplateau.errors import SpecError
from eulerplateau.solvers import Stability, tangent_model
from eulerplateau.threads import one_thread

# How far, in units of the circumradius, a symmetric cell may be from its image.
_SYMMETRIC = 1e-6


@dataclass(frozen=True)
class _Operation:
    """A rotation or mirror: the vector at vertex v, turned, goes to vertex images[v]."""

    turn: FloatArray
    images: IntArray

    def __call__(self, vectors: FloatArray) -> FloatArray:
        """Return the image (n, 2) of vectors (n, 2) at the vertices."""
        moved = np.empty_like(vectors)
        moved[self.images] = vectors @ self.turn.T
        return moved


def symmetric_index(found: CellEquilibrium) -> int:
    """Return how many unstable modes are as symmetric as the polygon of the sites.

    Raises SpecError if the sites are no regular polygon of equally stiff adhesions, or if
    the cell is not symmetric.
    """
    cell = found.cell
    centre, operations = _operations(cell)
    off = max(
        float(np.abs(g(found.x - centre) - found.x + centre).max()) for g in operations
    )
    if off > _SYMMETRIC * float(np.abs(cell.sites.points - centre).max()):
        raise SpecError("cell", f"is not symmetric: its images differ by {off:.1g}")
    with one_thread():
        model = tangent_model(cell.energy(found.sigma_hat, found.ks_hat), found.x)
        modes = model.basis.T.reshape(-1, cell.size, 2)
        averages = np.array([_average(operations, mode).ravel() for mode in modes])
        shares, vectors = np.linalg.eigh(averages @ model.basis)
        kept = vectors[:, shares > 0.5]
        values = np.linalg.eigvalsh(kept.T @ model.hessian @ kept)
    eps = float(np.finfo(np.float64).eps)
    return Stability(values, 10 * eps * float(np.abs(model.eigenvalues).max())).n_unstable


def symmetric_part(cell: Cell, mode: FloatArray) -> float:
    """Return the part of a displacement's square (n, 2) that is symmetric, in [0, 1].

    Raises SpecError if the sites are no regular polygon of equally stiff adhesions.
    """
    average = _average(_operations(cell)[1], mode)
    return float((average**2).sum() / (mode**2).sum())


def _average(operations: list[_Operation], mode: FloatArray) -> FloatArray:
    images: FloatArray = np.mean([operation(mode) for operation in operations], axis=0)
    return images


def _operations(cell: Cell) -> tuple[FloatArray, list[_Operation]]:
    """Return the centre (2,) of a regular polygon, and its rotations and mirrors."""
    points, weights = cell.sites.points, cell.sites.weights
    sides, m, n = len(points), cell.edges_per_side, cell.size
    centre = points.mean(axis=0)
    arm = (points - centre) @ np.array([1.0, 1.0j])
    regular = arm[0] * np.exp(2j * np.pi * np.arange(sides) / sides)
    if np.abs(arm - regular).max() > 1e-9 * abs(arm[0]) or np.ptp(weights) > 0:
        raise SpecError("sites", "are no regular polygon of equally stiff adhesions")
    v = np.arange(n)
    across = arm[0] / abs(arm[0])
    # Of complex numbers a mirror across the line along `across` is across^2 conj(z).
    c, s = (across**2).real, (across**2).imag
    mirror = np.array([[c, s], [s, -c]])
    operations = []
    for k in range(sides):
        angle = 2 * np.pi * k / sides
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        operations.append(_Operation(turn, (v + k * m) % n))
        operations.append(_Operation(turn @ mirror, (k * m - v) % n))
    return centre, operations
