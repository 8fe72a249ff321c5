"""Newton for true soap films in space: near one shape of the film after another."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import cast

from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.film import AreaOfLoop, FilmOfLoop
from eulerplateau.loop import close_with_lengths, largest_turning
from eulerplateau.mesh import Shape
from eulerplateau.solvers.descent import Descent, State
from eulerplateau.solvers.equilibrium import Equilibrium, Status
from eulerplateau.solvers.large_loops.coarse_start import smoothed
from eulerplateau.solvers.large_loops.film_models import FilmModels
from eulerplateau.solvers.models import DenseModels, Model, Models
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.quadratic_models import DENSE_LOOP, quadratic_models
from eulerplateau.threads import one_thread

# Loops of more vertices are not condensed: film and loop are looked at together.
_DENSE = 48
# A soap film is sought near the last shape at most so many times in one solve.
_SHAPES = 60
# A rough start of a large loop is smoothed to what a loop of so many vertices can show.
_SMOOTH = DENSE_LOOP // 2
# The residual at which a film that has tilted from where it was made is made anew: one
# more step brings it to rest.
_CLOSE = 1e-5
# Degrees by which a crumpled loop turns at some vertex: no soap film is sought across it.
_CRUMPLED = 90.0


def search(
    problem: Problem,
    start: Shape,
    tensions: FloatArray | None,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a soap film comes to; None if no loop, or no film on it, is near.

    Tensions are of no use: they follow from the loop.
    """
    large = len(start.loop) > DENSE_LOOP
    smooth = smoothed(problem.loop, start.x_loop, _SMOOTH) if large else None
    x_loop = close_with_lengths(problem.loop, start.x_loop) if smooth is None else smooth
    if x_loop is None:
        return None
    if smooth is not None and (tied := problem.tied_film()) is not None:
        start = tied.shape(x_loop)
    # Blocks of a hundred rows: two threads would mostly wait for each other.
    with one_thread():
        if largest_turning(x_loop) < _CRUMPLED:
            found = _near(problem, start, x_loop, load, max_iterations, observe)
            if found is not None:
                return found
        tied = problem.tied_film()
        if tied is None:
            return None
        models = quadratic_models(problem.loop, tied.energy(problem.loop, load))
        state, _ = Descent(models, max_iterations).run(x_loop)
        shape = tied.shape(state.model.x)
        return _near(problem, shape, shape.x_loop, load, max_iterations, observe)


def _models(problem: Problem, film: FilmOfLoop, load: float) -> Models:
    """Return how a film's energy is looked at, by the size of its loop.

    And by whether that resists more than bending, which is no chain of its vertices.
    """
    energy = film.energy(problem.loop, load)
    if len(problem.loop.rest_lengths) <= _DENSE or problem.loop.terms:
        return DenseModels(energy)
    return FilmModels(energy, cast(AreaOfLoop, film), problem.loop, load)


def _near(
    problem: Problem,
    shape: Shape,
    x_loop: FloatArray,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a soap film near a shape, on a loop, comes to; None if there is none.

    It is known near one shape at a time, so the descent begins again at each it comes to,
    until it is at rest near its own.
    """
    spent, found = 0, None
    for _ in range(_SHAPES):
        try:
            shape = problem.film.prepared(problem.film.carried(shape, x_loop))
            film = problem.film.of_loop(shape)
            models = _models(problem, film, load)
            left = max_iterations - spent
            descent = Descent(models, left, observe, partial(_elsewhere, film))
            state, status = descent.run(x_loop)
        except LinAlgError:
            return None if found is None else found(Status.STALLED)
        spent += state.iteration
        x_loop = state.model.x
        shape = film.shape(x_loop)
        found = partial(_record, problem, load, models, shape, state, spent)
        own = models.energy.holds(x_loop) and film.made_at(x_loop)
        lost = status is Status.STALLED or problem.pinched(shape)
        if own or lost or spent >= max_iterations:
            return found(status)
    return None if found is None else found(status)


def _elsewhere(film: FilmOfLoop, model: Model) -> bool:
    """Return whether a film nearly at rest is not where it was made: it is made anew."""
    return model.residual < _CLOSE and not film.made_at(model.x)


def _record(
    problem: Problem,
    load: float,
    models: Models,
    shape: Shape,
    state: State,
    spent: int,
    status: Status,
) -> Equilibrium:
    stability = state.stability or models.spectrum(state.model)
    return problem.record(shape, state.model.tensions, load, status, stability, spent)
