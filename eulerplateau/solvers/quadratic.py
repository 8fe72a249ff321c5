"""Newton for films of fixed weights: a rough start of a large loop is smoothed first."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Loop, close_with_lengths
from eulerplateau.mesh import Shape
from eulerplateau.solvers.descent import Descent
from eulerplateau.solvers.equilibrium import RESIDUAL_TOLERANCE, Equilibrium, Status
from eulerplateau.solvers.models import Models
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.quadratic_models import DENSE_LOOP, quadratic_models


def search(
    problem: Problem,
    start: Shape,
    tensions: FloatArray | None,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a film with fixed weights comes to; None if no loop is near the start."""
    film = problem.film.of_loop(start)
    models = quadratic_models(problem.loop, film.energy(problem.loop, load))
    x = _start(problem.loop, models, start.x_loop, max_iterations)
    if x is None:
        return None
    descent = Descent(models, max_iterations, observe)
    state = None if tensions is None else descent.settled(x, tensions, 0)
    status = Status.CONVERGED
    if state is None:
        state, status = descent.run(x)
    balanced = state.model.residual <= RESIDUAL_TOLERANCE
    if state.stability is None and (balanced or models.always_classified):
        state = replace(state, stability=models.spectrum(state.model))
    model, shape = state.model, film.shape(state.model.x)
    return problem.record(
        shape, model.tensions, load, status, state.stability, state.iteration
    )


def _start(
    loop: Loop, models: Models, x: FloatArray, max_iterations: int
) -> FloatArray | None:
    """Return a loop that keeps its lengths, near x (n_b, 3); None if there is none.

    A large loop with more energy in its roughness than in its shape is smoothed first, by
    minimising on a coarse one.
    """
    given = close_with_lengths(loop, x)
    if len(x) <= DENSE_LOOP:
        return given
    from eulerplateau.solvers.large_loops.coarse_start import coarsen, is_rough

    coarse = coarsen(loop, DENSE_LOOP)
    shape = coarse.start(x)
    if shape is None:
        return given
    smooth = coarse.smooth(shape)
    if given is not None and (smooth is None or not is_rough(models.energy, given, smooth)):
        return given
    energy = coarse.energy(models.energy)
    descent = Descent(quadratic_models(coarse.loop, energy), max_iterations)
    smooth = coarse.smooth(descent.run(shape)[0].model.x)
    return given if smooth is None else smooth
