"""Newton for true soap films: in space chart after chart, in their plane as a polygon."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.area_energy import AreaEnergy
from eulerplateau.area_film import AreaFilm
from eulerplateau.condensation import condense
from eulerplateau.condensed import loop_energy
from eulerplateau.descent import Descent, judged, record, stability_of
from eulerplateau.inextensible import close_with_lengths
from eulerplateau.mesh import FloatArray
from eulerplateau.plane_energy import PlaneEnergy
from eulerplateau.plane_film import PlaneFilm
from eulerplateau.plane_newton import COARSE, Flat, coarse_minimum, settle_in_plane
from eulerplateau.problem import Problem
from eulerplateau.repair import carried
from eulerplateau.solution import Equilibrium, Status
from eulerplateau.stability import Stability
from eulerplateau.tangent import LoopEnergy

# A soap film is sought near the last shape at most so many times in one solve.
_CHARTS = 60
# A fine polygon settles this close to the coarse one it was started from (in L).
_NEAR = 0.05


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
        lost = status is Status.STALLED or problem.loop.strands_meet(state.model.x)
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

    A fine loop is settled from the minimum of a coarse one, whose index is then its own.
    """
    film = problem.film
    assert isinstance(film, PlaneFilm)
    flat = close_with_lengths(problem.loop, x[problem.loop_vertices] @ film.axes.T)
    if flat is None:
        return None
    energy = PlaneEnergy(problem.loop, load)

    def shown(polygon: FloatArray) -> None:
        if len(polygon) == len(flat):
            observe(polygon @ film.axes)

    fine = _settled_from_coarse(energy, flat, max_iterations, shown)
    if fine is not None:
        polygon, spectrum = fine
        status = Status.CONVERGED
    else:
        state, status = Descent(energy, max_iterations, shown).run(flat)
        polygon = Flat(state.model.x, state.model.multipliers, state.iteration)
        spectrum = state.stability or stability_of(energy, state.model)
    return judged(_lifted(problem, x, polygon, load, status), spectrum)


def _settled_from_coarse(
    energy: PlaneEnergy,
    x: FloatArray,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> tuple[Flat, Stability | None] | None:
    """Return the equilibrium of a fine loop by way of a coarse one; None if that fails."""
    if len(x) <= 2 * COARSE:
        return None
    coarse = coarse_minimum(energy, x, max_iterations, observe)
    if coarse is None:
        return None
    state, smooth = coarse
    settled = settle_in_plane(energy, smooth, max_iterations - state.iteration)
    if settled is None or float(np.abs(settled.x - smooth).max()) > _NEAR:
        return None
    spent = state.iteration + settled.iterations
    return replace(settled, iterations=spent), state.stability


def _lifted(
    problem: Problem, x: FloatArray, polygon: Flat, load: float, status: Status
) -> Equilibrium:
    """Return the flat film (n_v, 3) on a polygon, its mesh moved along from x (n_v, 3)."""
    film = problem.film
    assert isinstance(film, PlaneFilm)
    soap, moved = carried(film.soap, film.flattened(x), polygon.x @ film.axes)
    found = problem.equilibrium(moved, polygon.multipliers, load, status)
    changed = None if soap is film.soap else soap.triangles
    return replace(found, iterations=polygon.iterations, triangles=changed)
