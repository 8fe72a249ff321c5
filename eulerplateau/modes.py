"""The lowest modes of an equilibrium, as displacements of the whole film."""

from __future__ import annotations

import numpy as np

from eulerplateau.loop_model import lowest_modes as lowest_on_large_loops
from eulerplateau.loop_model import subspace_model
from eulerplateau.mesh import FloatArray
from eulerplateau.newton import DENSE_LOOP, loop_energy
from eulerplateau.problem import Problem
from eulerplateau.solution import Equilibrium
from eulerplateau.tangent import tangent_model


def lowest_modes(problem: Problem, found: Equilibrium, count: int) -> dict[str, FloatArray]:
    """Return up to `count` modes {"mode_0": (n_v, 3), ...}, the lowest eigenvalue first.

    The film follows the loop; the largest displacement is 1. On loops beyond DENSE_LOOP
    vertices as many modes are known as are unstable or neutral, and one more.
    """
    energy = loop_energy(problem, found.load)
    x_loop = found.x[problem.loop_vertices]
    if len(x_loop) <= DENSE_LOOP:
        model = tangent_model(energy, x_loop)
        columns = model.basis @ model.eigen[1][:, :count]
    else:
        model = subspace_model(energy, x_loop)
        columns = lowest_on_large_loops(energy, model)[1][:, :count]
    modes = {}
    for number, column in enumerate(columns.T):
        moved = problem.condensed.extend((column / model.scale).reshape(-1, 3))
        largest = float(np.linalg.norm(moved, axis=1).max())
        modes[f"mode_{number}"] = moved / largest
    return modes
