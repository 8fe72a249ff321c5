"""Thresholds of a disk on a mesh, within its plane and across it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.optimize import brentq

from eulerplateau.arrays import FloatArray
from eulerplateau.film import FILM_LOADS
from eulerplateau.loop import LoopEnergy, project_lengths
from eulerplateau.solvers import Problem, TangentModel, tangent_model
from scripts.studies.common import make_mesh

PI3 = np.pi**3
# sigma_hat, derived in docs/films.md. Springs have no planar one: their meshes are not
# round, and neither are their disks, which turn into ellipses without a threshold.
ACROSS = 96 * PI3
WITHIN = {"dirichlet": 192 * PI3, "area": 48 * PI3}

CIRCLE, HEXAGON = "circle", "regular hexagon"
MESHES: dict[tuple[str, str], list[dict[str, Any]]] = {
    **{
        (CIRCLE, name): [
            {"polygon": {"kind": "circle"}, "vertices": size, "algorithm": algorithm}
            for size in (130, 474, 1800, 7000)
        ]
        for algorithm, name in ((5, "Delaunay"), (6, "Frontal-Delaunay"))
    },
    # Edges that divide the hexagon's sides: Gmsh makes a lattice of equilateral triangles.
    (HEXAGON, "lattice"): [
        {"polygon": {"kind": "regular", "sides": 6}, "edge_length": 1 / count}
        for count in (6, 12, 24, 48)
    ],
}
EnergyAt = Callable[[float], LoopEnergy]
# Loads are tried upwards in steps of this share of the threshold, from half of it.
STEP = 0.05
CONVERGED, ITERATIONS = 1e-9, 40


@dataclass(frozen=True)
class Case:
    """A film on a mesh, and what MeshSpec says of the mesh."""

    film: str
    polygon: str
    mesh: str
    number: int

    @property
    def settings(self) -> dict[str, Any]:
        """The mesh's specification."""
        return MESHES[self.polygon, self.mesh][self.number]


@dataclass(frozen=True)
class Thresholds:
    """Tensions sigma_hat at which a disk gives way across its plane, and within it."""

    case: Case
    n_v: int
    n_b: int
    across: float
    within: float | None


def thresholds(case: Case) -> Thresholds:
    """Locate both thresholds of a case."""
    mesh = make_mesh(**case.settings)
    problem = Problem(mesh, case.film)
    energy = partial(problem.film.of_loop(mesh.shape).energy, problem.loop)
    turns = 2 * np.pi * np.arange(mesh.n_b) / mesh.n_b
    circle = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    start = project_lengths(problem.loop, circle / (2 * np.pi))
    assert start is not None
    per_load = FILM_LOADS[case.film].tension_per_load
    within = None
    if case.film in WITHIN and case.polygon == CIRCLE:
        within = per_load * first_zero(energy, start, 0, WITHIN[case.film] / per_load)
    across = per_load * first_zero(energy, start, 1, ACROSS / per_load)
    return Thresholds(case, mesh.n_v, mesh.n_b, across, within)


def first_zero(energy: EnergyAt, x: FloatArray, part: int, expected: float) -> float:
    """Return the load at which the lowest eigenvalue of a part of the spectrum vanishes."""

    def lowest(load: float, x: FloatArray) -> tuple[float, FloatArray]:
        model = planar_equilibrium(energy, x, load)
        return float(np.linalg.eigvalsh(parts(model)[part][1])[0]), model.x

    loads = expected * np.arange(0.5, 1.5, STEP)
    _, x = lowest(loads[0], x)
    for low, high in pairwise(loads):
        value, after = lowest(high, x)
        if value <= 0:
            return float(
                brentq(lambda load, x=x: lowest(load, x)[0], low, high, rtol=1e-10)
            )
        x = after
    raise ArithmeticError(f"no threshold up to {loads[-1]:g}")


def planar_equilibrium(energy: EnergyAt, x: FloatArray, load: float) -> TangentModel:
    """Return the equilibrium that Newton's method in the plane reaches from x (n_b, 3)."""
    project = energy(load).constraint.project
    for _ in range(ITERATIONS):
        model = tangent_model(energy(load), x)
        if model.residual <= max(CONVERGED, 10 * model.rounding):
            return model
        basis, hessian = parts(model)[0]
        step = basis @ np.linalg.solve(hessian, -(basis.T @ model.gradient))
        moved = project(x + model.displacement(step))
        if moved is None:
            break
        x = moved
    raise ArithmeticError(f"no planar equilibrium at the load {load:g}")


def parts(model: TangentModel) -> list[tuple[FloatArray, FloatArray]]:
    """Return basis and Hessian of the displacements in the plane, and of those across."""
    up = model.basis.reshape(len(model.x), 3, -1)[:, 2]
    # The tangent space at a flat loop is the sum of the two: squares of z are 0 or 1.
    share, vectors = np.linalg.eigh(up.T @ up)
    bases = vectors[:, share < 0.5], vectors[:, share > 0.5]
    return [(basis, basis.T @ model.hessian @ basis) for basis in bases]
