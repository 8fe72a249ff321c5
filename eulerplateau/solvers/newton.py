"""Newton on the loop, and the softest modes of what it comes to.

The film's interior is eliminated, so that an iterate is a loop: of a film of fixed weights
exactly and once (quadratic.py); of a soap film at each step, near the last shape (soap.py);
a film kept in its plane has no use for one (in_plane/). Which is the case is asked here and
nowhere else.

The iteration ends where rounding begins. That of the positions alone unbalances the forces
by about eps / h^3 for edges of length h, relative to the largest: a few 1e-7 at 1,700 loop
vertices, 1e-5 at 3,800.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

import numpy as np

from eulerplateau import film as films
from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Loop, LoopEnergy
from eulerplateau.mesh import Shape
from eulerplateau.solvers.equilibrium import Equilibrium, Status
from eulerplateau.solvers.models import DenseModels, Models
from eulerplateau.solvers.problem import Problem


class Search(Protocol):
    """Looks for a minimum near a start."""

    def __call__(
        self,
        problem: Problem,
        start: Shape,
        tensions: FloatArray | None,
        load: float,
        max_iterations: int,
        observe: Callable[[FloatArray], None],
    ) -> Equilibrium | None:
        """Return what it comes to; None if no loop, or no film on it, is near."""


def minimise(
    problem: Problem,
    load: float,
    start: Shape,
    tensions: FloatArray | None,
    max_iterations: int | None,
    observe: Callable[[FloatArray], None],
) -> Equilibrium:
    """Return the minimum reached from a start: see solving.solve."""
    started = time.perf_counter()
    if (unusable := problem.unusable_start(start, load)) is not None:
        return unusable
    limit = 500 if max_iterations is None else max_iterations
    try:
        search = _search_for(problem)
        found = search(problem, start, tensions, load, limit, observe)
    except np.linalg.LinAlgError:
        found = None  # a loop that has fallen onto a line has no tensions
    if found is None:
        unknown = np.zeros(len(start.loop))
        found = problem.equilibrium(start, unknown, load, Status.STALLED)
    return problem.classified(replace(found, seconds=time.perf_counter() - started))


def _search_for(problem: Problem) -> Search:
    """Return the search that suits a loop and its film, its modules loaded now."""
    if problem.loop.diameter is not None:
        from eulerplateau.solvers.contact.search import search

        return search
    match problem.film:
        # First, so that who has springs loads no other film.
        case films.QuadraticFilm():
            from eulerplateau.solvers.quadratic import search
        case films.AreaFilm():
            from eulerplateau.solvers.soap import search
        case films.PlaneFilm():
            from eulerplateau.solvers.in_plane.search import search
        case _:
            from eulerplateau.solvers.quadratic import search
    return search


def lowest_modes(problem: Problem, found: Equilibrium, count: int) -> dict[str, FloatArray]:
    """Return up to `count` modes {"mode_0": (n_v, 3), ...}, the lowest eigenvalue first.

    The film follows the loop; the largest displacement is 1. On large loops as many modes
    are known as are unstable or neutral, and one more.
    """
    film, loop = problem.film.of_loop(found.shape), problem.loop_of(found.shape)
    energy = film.energy(loop, found.load)
    if found.contacts is None:
        models = models_for(problem.film, loop, energy)
    else:
        from eulerplateau.loop import strands_of, with_gaps_held

        strands, places = strands_of(loop), found.contacts.places
        models = DenseModels(with_gaps_held(energy, strands, places))
    x_loop = film.project(found.shape.x_loop)
    model = models.at(x_loop).dense
    modes = {}
    for number, column in enumerate(models.modes(model, count).T):
        moved = film.displacement(x_loop, (column / model.scale).reshape(x_loop.shape))
        largest = float(np.linalg.norm(moved, axis=1).max())
        modes[f"mode_{number}"] = moved / largest
    return modes


def models_for(film: films.Film, loop: Loop, energy: LoopEnergy) -> Models:
    """Return how the second variation of a film's energy is looked at."""
    match film:
        case films.QuadraticFilm():
            from eulerplateau.solvers.quadratic_models import quadratic_models

            return quadratic_models(loop, energy)
        case _:
            return DenseModels(energy)
