"""Newton for true soap films: in space chart after chart, in their plane as a polygon."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from scipy.linalg import LinAlgError
from threadpoolctl import threadpool_limits

from eulerplateau.arrays import FloatArray
from eulerplateau.film import (
    AreaEnergy,
    AreaFilm,
    PlaneEnergy,
    PlaneFilm,
    carried,
    carried_in_plane,
    condense,
)
from eulerplateau.loop import DENSE_LOOP, close_with_lengths
from eulerplateau.solvers.condensed import loop_energy
from eulerplateau.solvers.descent import Descent, judged, record, stability_of
from eulerplateau.solvers.equilibrium import Equilibrium, Status
from eulerplateau.solvers.in_plane.newton import Flat, minimum_in_plane
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.second_variation import (
    LoopEnergy,
)

# A soap film is sought near the last shape at most so many times in one solve.
_CHARTS = 60


def search_soap(
    problem: Problem,
    x: FloatArray,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a soap film comes to; None if no loop, or no film on it, is near x."""
    x_loop = close_with_lengths(problem.loop, x[problem.loop_vertices])
    if x_loop is None:
        return None
    found = _charted(problem, x, x_loop, load, max_iterations, observe)
    if found is not None:
        return found
    smooth = _unfolded(problem, x_loop, load, max_iterations)
    if smooth is None:
        return None
    smooth_loop = smooth[problem.loop_vertices]
    return _charted(problem, smooth, smooth_loop, load, max_iterations, observe)


def _unfolded(
    problem: Problem, x_loop: FloatArray, load: float, max_iterations: int
) -> FloatArray | None:
    """Return the shape (n_v, 3) of least Dirichlet energy that a crumpled loop leads to.

    That film, tied to the mesh as it was given, can be spanned across any loop.
    """
    film = problem.film
    assert isinstance(film, AreaFilm)
    laplacian = film.cotangent_laplacian(film.sides(film.rest))
    try:
        condensed = condense(laplacian, film.loop, film.interior)
    except LinAlgError:
        return None
    loop = problem.loop
    energy = LoopEnergy(loop, 2 * loop.bending_matrix, load * condensed.stiffness)
    state, _ = Descent(energy, max_iterations).run(x_loop)
    return condensed.extend(state.model.x)


def _charted(
    problem: Problem,
    x: FloatArray,
    x_loop: FloatArray,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a soap film near x (n_v, 3) on a loop comes to; None if there is none.

    Chart after chart, until the film is at rest in the one that is made at its own shape.
    """
    first = film = problem.film
    assert isinstance(film, AreaFilm)
    spent, found = 0, None
    for _ in range(_CHARTS):
        try:
            film, x = carried(film, x, x_loop)
            here = replace(problem, film=film).near(x)
            energy = loop_energy(here, load)
            assert isinstance(energy, AreaEnergy)
            state, status = Descent(energy, max_iterations - spent, observe).run(x_loop)
        except LinAlgError:
            return None if found is None else replace(found, status=Status.STALLED)
        spent += state.iteration
        if state.stability is None:
            state = replace(state, stability=stability_of(energy, state.model))
        found = replace(record(here, state, load, status), iterations=spent)
        film = here.film
        assert isinstance(film, AreaFilm)
        if film is not first:
            found = replace(found, triangles=film.triangles)
        own = energy.holds(state.model.x) and energy.at_centre(state.model.x)
        lost = status is Status.STALLED or problem.pinched(found.x)
        if own or lost or spent >= max_iterations:
            return found
        x, x_loop = found.x, state.model.x
    return found


def search_in_plane(
    problem: Problem,
    x: FloatArray,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a film kept in its plane comes to; None if no loop is near x.

    Where the chain's own descent gets stuck the general one takes over, on small loops.
    """
    film = problem.film
    assert isinstance(film, PlaneFilm)
    x = film.laid(x)
    flat = close_with_lengths(problem.loop, x[problem.loop_vertices] @ film.axes.T)
    if flat is None:
        return None
    energy = PlaneEnergy(problem.loop, load)

    def shown(polygon: FloatArray) -> None:
        observe(polygon @ film.axes)

    minimum = minimum_in_plane(energy, flat, max_iterations, shown)
    if minimum is not None:
        polygon, spectrum = minimum
        status = Status.CONVERGED
    elif len(flat) > DENSE_LOOP:
        return None
    else:
        with threadpool_limits(1, user_api="blas"):
            state, status = Descent(energy, max_iterations, shown).run(flat)
        polygon = Flat(state.model.x, state.model.multipliers, state.iteration)
        spectrum = state.stability or stability_of(energy, state.model)
    return judged(_lifted(problem, x, polygon, load, status), spectrum)


def _lifted(
    problem: Problem, x: FloatArray, polygon: Flat, load: float, status: Status
) -> Equilibrium:
    """Return the flat film (n_v, 3) on a polygon, its mesh moved along from x (n_v, 3)."""
    film = problem.film
    assert isinstance(film, PlaneFilm)
    spanned = not problem.loop.strands_meet(polygon.x)
    soap, moved = carried_in_plane(film, x, polygon.x, spanned)
    found = problem.equilibrium(moved, polygon.multipliers, load, status)
    changed = None if soap is film.soap else soap.triangles
    return replace(found, iterations=polygon.iterations, triangles=changed)
