"""Newton for films kept in their plane: by the chain, or where it gets stuck in general."""

from __future__ import annotations

from collections.abc import Callable

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import close_with_lengths
from eulerplateau.mesh import Shape
from eulerplateau.solvers.descent import Descent
from eulerplateau.solvers.equilibrium import Equilibrium, Status
from eulerplateau.solvers.in_plane.newton import PlaneEquilibrium, minimum_in_plane
from eulerplateau.solvers.models import DenseModels
from eulerplateau.solvers.problem import Problem
from eulerplateau.threads import one_thread

# Loops with more vertices are left to the chain.
_LARGEST = 128


def search(
    problem: Problem,
    start: Shape,
    tensions: FloatArray | None,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a film kept in its plane comes to; None if no loop is near.

    Where the chain's own descent gets stuck the general one takes over, on small loops.
    Tensions are of no use: they follow from the loop.
    """
    shape = problem.film.prepared(start)
    film = problem.film.of_loop(shape)
    flat = close_with_lengths(problem.loop, film.project(shape.x_loop))
    if flat is None:
        return None

    def shown(polygon: FloatArray) -> None:
        observe(film.lift(polygon))

    minimum = minimum_in_plane(problem.loop, load, flat, max_iterations, shown)
    if minimum is not None:
        polygon, spectrum = minimum
        status = Status.CONVERGED
    elif len(flat) > _LARGEST:
        return None
    else:
        models = DenseModels(film.energy(problem.loop, load))
        with one_thread():
            state, status = Descent(models, max_iterations, shown).run(flat)
        polygon = PlaneEquilibrium(state.model.x, state.model.tensions, state.iteration)
        spectrum = state.stability or models.spectrum(state.model)
    shape = film.shape(polygon.x)
    return problem.record(
        shape, polygon.tensions, load, status, spectrum, polygon.iterations
    )
