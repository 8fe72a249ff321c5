"""What is found of a cell: its shape, forces and energies, and how good they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.cells.cell import Cell
from eulerplateau.cells.touching import collapsed, touches
from eulerplateau.loop import FreeBending, edges_of
from eulerplateau.mesh import polygon_area
from eulerplateau.solvers import (
    RESIDUAL_TOLERANCE,
    RESOLVED_TURNING,
    Stability,
    Status,
    TangentModel,
)


@dataclass(frozen=True, eq=False, repr=False)
class CellEquilibrium:
    """An equilibrium of a cell, or the best a solver reached. Units: R0, alpha / R0.

    Attributes
    ----------
    x : (n, 2) float, the edge, counter-clockwise
    sigma_hat, ks_hat : floats, sigma R0^3 / alpha and k_s R0^3 / alpha
    bending_energy, film_energy, adhesion_energy, line_energy : floats, the energy's parts
    kappa_adhesion, kappa_mid : (N,) float
        Curvature at each adhesion and half-way to the next; positive where convex.
    displacements : (N, 2) float, r_i - p_i
    tangential : (N,) float
        Its part along the edge, zero in the limit of many edges: each side's length is
        free.
    forces : (N, 2) float
        On the substrate, 2 k_i (r_i - p_i), in units of alpha / R0^2.
    residual : float
        The largest unbalanced force over the largest of those it is the sum of.
    stability : Stability or None
        The spectrum of the second variation for the norm integral |p|^2 ds; None where
        there is none.
    """

    cell: Cell
    x: FloatArray
    sigma_hat: float
    ks_hat: float
    energy: float
    bending_energy: float
    film_energy: float
    adhesion_energy: float
    line_energy: float
    perimeter: float
    area: float
    kappa_adhesion: FloatArray
    kappa_mid: FloatArray
    displacements: FloatArray
    tangential: FloatArray
    forces: FloatArray
    residual: float
    iterations: int
    seconds: float
    stability: Stability | None
    status: Status

    @property
    def beta_hat(self) -> float:
        """The line tension, beta R0^2 / alpha."""
        return self.cell.beta_hat

    @property
    def extensions(self) -> FloatArray:
        """How far the springs are stretched (N,), |r_i - p_i|."""
        return np.hypot(self.displacements[:, 0], self.displacements[:, 1])

    @property
    def traction(self) -> FloatArray:
        """The size of the forces on the substrate (N,), in units of alpha / R0^2."""
        return np.hypot(self.forces[:, 0], self.forces[:, 1])

    @property
    def converged(self) -> bool:
        """Whether the tolerances are met."""
        return self.status is Status.CONVERGED

    @property
    def n_unstable(self) -> int | None:
        """The Morse index; None where it is not known."""
        return None if self.stability is None else self.stability.n_unstable

    def __repr__(self) -> str:
        """Return one line: where, energy, status, Morse index."""
        index = "" if self.n_unstable is None else f", {self.n_unstable} unstable"
        return (
            f"<CellEquilibrium at sigma_hat {self.sigma_hat:.6g}, "
            f"ks_hat {self.ks_hat:.6g}: energy {self.energy:.9g}, "
            f"{self.status.value}{index}, residual {self.residual:.1e}>"
        )


def measured(
    cell: Cell,
    x: FloatArray,
    sigma_hat: float,
    ks_hat: float,
    residual: float = np.nan,
    iterations: int = 0,
    seconds: float = 0.0,
    stability: Stability | None = None,
    status: Status = Status.NOT_FINITE,
) -> CellEquilibrium:
    """Return the record of a loop (n, 2): all that follows from its shape, and the rest."""
    edges, springs = edges_of(x), cell.adhesions(ks_hat)
    kappa = edges.turning / edges.means
    stretched = springs.extensions(x)
    area, perimeter = polygon_area(x), float(edges.lengths.sum())
    parts = {
        "bending_energy": FreeBending(cell.edge).energy(x),
        "film_energy": sigma_hat * area,
        "adhesion_energy": springs.energy(x),
        "line_energy": cell.beta_hat * perimeter,
    }
    return CellEquilibrium(
        cell=cell,
        x=x,
        sigma_hat=sigma_hat,
        ks_hat=ks_hat,
        energy=sum(parts.values()),
        **parts,
        perimeter=perimeter,
        area=area,
        kappa_adhesion=kappa[cell.vertices],
        kappa_mid=kappa[cell.vertices + cell.edges_per_side // 2],
        displacements=stretched,
        tangential=(stretched * cell.tangents(x)).sum(axis=1),
        forces=springs.force(x)[cell.vertices],
        residual=residual,
        iterations=iterations,
        seconds=seconds,
        stability=stability,
        status=status,
    )


def status_of(
    cell: Cell, model: TangentModel, stability: Stability, searched: Status
) -> Status:
    """Return the status of the loop that a search has come to.

    A stall with balanced forces is an equilibrium all the same, if it is a minimum. Where
    the edge has met itself there is none, whatever the forces.
    """
    if collapsed(model.x, cell.shares):
        return Status.COLLAPSED
    if touches(model.x):
        return Status.TOUCHING
    balanced = model.residual <= RESIDUAL_TOLERANCE
    if searched is Status.CONVERGED and not balanced:
        return Status.STALLED
    if searched is Status.STALLED and balanced:
        searched = Status.SADDLE if stability.n_unstable else Status.CONVERGED
    if searched is Status.CONVERGED and not resolved(model.x):
        return Status.UNRESOLVED
    return searched


def resolved(x: FloatArray) -> bool:
    """Return whether a loop (n, 2) turns by no more than 30 degrees at any vertex."""
    turning = np.degrees(np.abs(edges_of(x).turning).max())
    return bool(turning <= RESOLVED_TURNING)
