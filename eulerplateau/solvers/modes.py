"""The lowest modes of an equilibrium, as displacements of the whole film."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.solvers.condensed import loop_energy
from eulerplateau.solvers.equilibrium import Equilibrium
from eulerplateau.solvers.large_loops.subspace_model import (
    lowest_modes as lowest_on_large_loops,
    subspace_model,
)
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.second_variation import LoopEnergy, tangent_model


def lowest_modes(problem: Problem, found: Equilibrium, count: int) -> dict[str, FloatArray]:
    """Return up to `count` modes {"mode_0": (n_v, 3), ...}, the lowest eigenvalue first.

    The film follows the loop; the largest displacement is 1. On loops beyond DENSE_LOOP
    vertices as many modes are known as are unstable or neutral, and one more.
    """
    problem = problem.at(found.x)
    energy = loop_energy(problem, found.load)
    x_loop = found.x[problem.loop_vertices]
    if isinstance(energy, LoopEnergy) and not energy.dense:
        model = subspace_model(energy, x_loop)
        columns = lowest_on_large_loops(energy, model)[1][:, :count]
    else:
        model = tangent_model(energy, x_loop)
        columns = model.basis @ model.eigen[1][:, :count]
    modes = {}
    for number, column in enumerate(columns.T):
        displacement = (column / model.scale).reshape(-1, 3)
        moved = problem.condensed.displacement(x_loop, displacement)
        largest = float(np.linalg.norm(moved, axis=1).max())
        modes[f"mode_{number}"] = moved / largest
    return modes
