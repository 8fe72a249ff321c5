"""Newton for true soap films in space: near one shape of the film after another."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import partial
from typing import cast

from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import MeshError
from eulerplateau.film import AreaOfLoop, FilmOfLoop
from eulerplateau.loop import close_with_lengths, largest_turning, quickly_projected
from eulerplateau.mesh import Shape
from eulerplateau.solvers.descent import Descent, State
from eulerplateau.solvers.equilibrium import Equilibrium, Status
from eulerplateau.solvers.large_loops.coarse_film import coarse_disk
from eulerplateau.solvers.large_loops.coarse_start import coarsen
from eulerplateau.solvers.large_loops.film_models import FilmModels
from eulerplateau.solvers.models import DenseModels, Model, Models
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.quadratic_models import DENSE_LOOP, quadratic_models
from eulerplateau.solvers.renewal import Reached, elsewhere, near_shapes

# Loops of more vertices are not condensed: film and loop are looked at together.
_DENSE = 16
# A rough start of a large loop is smoothed to what a loop of so many vertices can show.
_SMOOTH = DENSE_LOOP // 2
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
    smooth = _smooth_start(problem, start, load, max_iterations, observe)
    x_loop = smooth
    if x_loop is None:
        x_loop = close_with_lengths(problem.loop, start.x_loop, quickly_projected)
    if x_loop is None:
        return None
    if smooth is not None and (tied := problem.tied_film()) is not None:
        start = tied.shape(x_loop)
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


def _smooth_start(
    problem: Problem,
    start: Shape,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> FloatArray | None:
    """Return the loop to begin with in place of a large one that is rough; else None.

    That of a coarse film's minimum, which few steps on the mesh bring to its own.
    """
    if len(start.loop) <= DENSE_LOOP:
        return None
    coarse = coarsen(problem.loop, _SMOOTH)
    smooth = coarse.smoothed(start.x_loop)
    if smooth is None:
        return None

    def shown(x_loop: FloatArray) -> None:
        observe(coarse.prolong(x_loop))

    with suppress(MeshError, LinAlgError):
        disk = coarse_disk(problem.disk, coarse)
        loop = problem.loop.on_edges(disk.rest_lengths)
        other = Problem(disk, "area").with_loop(loop)
        tied, x_loop = other.tied_film(), coarse.start(smooth)
        if tied is not None and x_loop is not None:
            found = search(other, tied.shape(x_loop), None, load, max_iterations, shown)
            if found is not None and other.classified(found).converged:
                minimum = coarse.smooth(found.shape.x_loop)
                return smooth if minimum is None else minimum
    return smooth


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
    """Return what a soap film near a shape, on a loop, comes to; None if there is none."""
    model: Model | None = None

    def descend(film: FilmOfLoop, left: int) -> Reached:
        nonlocal x_loop, model
        models = _models(problem, film, load)
        descent = Descent(models, left, observe, partial(elsewhere, film))
        state, status = descent.run(x_loop, model)
        x_loop, model = state.model.x, state.model
        return Reached(
            x=x_loop,
            iterations=state.iteration,
            status=status,
            holds=models.energy.holds(x_loop),
            lost=lambda shape: status is Status.STALLED or problem.pinched(shape),
            record=partial(_record, problem, load, models, state),
        )

    return near_shapes(problem.film, shape, x_loop, max_iterations, descend)


def _record(
    problem: Problem,
    load: float,
    models: Models,
    state: State,
    shape: Shape,
    spent: int,
    status: Status,
) -> Equilibrium:
    stability = state.stability or models.spectrum(state.model)
    return problem.record(shape, state.model.tensions, load, status, stability, spent)
