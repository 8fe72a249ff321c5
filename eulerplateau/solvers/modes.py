"""The softest modes of an equilibrium, as displacements of the whole film."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film import Film, QuadraticFilm
from eulerplateau.loop import Loop, LoopEnergy
from eulerplateau.solvers.equilibrium import Equilibrium
from eulerplateau.solvers.models import DenseModels, Models
from eulerplateau.solvers.problem import Problem


def lowest_modes(problem: Problem, found: Equilibrium, count: int) -> dict[str, FloatArray]:
    """Return up to `count` modes {"mode_0": (n_v, 3), ...}, the lowest eigenvalue first.

    The film follows the loop; the largest displacement is 1. On large loops as many modes
    are known as are unstable or neutral, and one more.
    """
    film = problem.film.of_loop(found.shape)
    energy = film.energy(problem.loop, found.load)
    models = _models_for(problem.film, problem.loop, energy)
    x_loop = film.project(found.shape.x_loop)
    model = models.at(x_loop)
    modes = {}
    for number, column in enumerate(models.modes(model, count).T):
        moved = film.displacement(x_loop, (column / model.scale).reshape(x_loop.shape))
        largest = float(np.linalg.norm(moved, axis=1).max())
        modes[f"mode_{number}"] = moved / largest
    return modes


def _models_for(film: Film, loop: Loop, energy: LoopEnergy) -> Models:
    """Return how the second variation of a film's energy is looked at."""
    match film:
        case QuadraticFilm():
            from eulerplateau.solvers.quadratic_models import quadratic_models

            return quadratic_models(loop, energy)
        case _:
            return DenseModels(energy)
