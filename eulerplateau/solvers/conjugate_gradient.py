"""The paper's method: scipy's conjugate gradients over loop and film together.

The edge lengths are kept by an augmented Lagrangian,

    A(x) = E(x) + sum_v [lambda_v c_v + mu c_v^2 / (2 s_v)],   lambda_v += mu c_v / s_v.

Conjugate gradients stall when the line search compares energies that differ by rounding
only. So the unknown is the displacement u from a base point, A is evaluated as the
difference A(x0 + u) - A(x0), and the base moves along every few thousand iterations.
A saddle balances its forces too: a result is accepted only if a small kick and a second
solve come back to the same energy. What the unknowns are depends on the film
(trial_space.py); a soap film's are chosen anew at every base point.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError
from scipy.optimize import minimize

from eulerplateau.arrays import FloatArray
from eulerplateau.film import AreaFilm, PlaneFilm, carried
from eulerplateau.loop import kernels
from eulerplateau.solvers.equilibrium import (
    LENGTH_TOLERANCE,
    RESIDUAL_TOLERANCE,
    Equilibrium,
    Status,
)
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.start import smooth_kick
from eulerplateau.solvers.trial_space import centred, trial_space

# A tenfold tighter residual for every update of the multipliers; the floor leaves the
# multipliers' last update room below the accepted tolerance.
_FIRST_TOLERANCE = 1e-2
_TIGHTENING = 0.1
_FINAL_TOLERANCE = 0.3 * RESIDUAL_TOLERANCE
_ITERATIONS_PER_BASE = 2000
# Kicks before the load is given up as lying at a transition.
_KICKS = 5
_SAME_ENERGY = 1e-8
# Forces inside a film at rest over the largest of its forces on the loop.
_FILM_BALANCE = 1e-3
# Relative length error above which the penalty may have to grow, and the least penalty.
_STRETCHED = 1e-2
_STIFFER_THAN_BENDING = 1000.0


@dataclass(frozen=True)
class _Iterate:
    """Positions (n_v, 3), multipliers (n_b,), the tolerance in force, iterations so far."""

    x: FloatArray
    multipliers: FloatArray
    tolerance: float
    iterations: int


def solve(
    problem: Problem,
    x: FloatArray,
    multipliers: FloatArray,
    load: float,
    *,
    max_iterations: int = 1_000_000,
    observe: Callable[[FloatArray], None] = lambda x_loop: None,
) -> Equilibrium:
    """Return the minimum reached from x (n_v, 3), confirmed by a kick and a new solve.

    `observe` is shown the loop (n_b, 3) each time the base point moves.
    """
    started = time.perf_counter()
    if (refused := problem.refused(x, load)) is not None:
        return refused
    film = problem.film
    # Across the loop's plane, or along it where there is nothing else.
    axis = 0 if isinstance(film, PlaneFilm) else 2
    start = film.laid(x) if isinstance(film, PlaneFilm) else x
    best = _descend(problem, start, multipliers, load, max_iterations, observe)
    spent = best.iterations
    confirmed = False
    rng = np.random.default_rng(0)
    for _ in range(_KICKS):
        if not best.converged:
            break
        kick = smooth_kick(best.x[problem.loop_vertices], best.x, rng, axis)
        left = max_iterations - spent
        here = problem
        if best.triangles is not None:
            here = problem.with_triangles(best.triangles)
        again = _descend(here, best.x + kick, best.multipliers, load, left, observe)
        spent += again.iterations
        confirmed = again.converged and (
            abs(again.energy - best.energy) <= _SAME_ENERGY * abs(best.energy)
        )
        if confirmed:
            break
        best = again if again.energy < best.energy or not again.converged else best
    if best.converged and not confirmed:
        best = replace(best, status=Status.SADDLE)
    best = _with_mesh(problem, start, best)
    seconds = time.perf_counter() - started
    return problem.judged(replace(best, iterations=spent, seconds=seconds))


def _with_mesh(problem: Problem, start: FloatArray, found: Equilibrium) -> Equilibrium:
    """Return a result with what became of a soap film's mesh; `start` is (n_v, 3)."""
    film = problem.film
    if isinstance(film, PlaneFilm) and np.isfinite(found.x).all():
        soap, x = carried(film.soap, start, found.x[problem.loop_vertices])
        changed = None if soap is film.soap else soap.triangles
        return replace(found, x=x, triangles=changed)
    if isinstance(film, AreaFilm) and found.triangles is film.triangles:
        return replace(found, triangles=None)
    return found


def _descend(
    problem: Problem,
    x: FloatArray,
    multipliers: FloatArray,
    load: float,
    budget: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium:
    """Run the augmented Lagrangian to the tolerances, or until it stalls or runs out."""
    penalty, stretched = _first_penalty(problem, load), np.inf
    iterate, at_rest = _Iterate(x, multipliers, _FIRST_TOLERANCE, 0), True
    while True:
        try:
            x = (
                iterate.x
                if at_rest
                else problem.condensed.extend(iterate.x[problem.loop_vertices])
            )
            problem, x = centred(problem, x)
            iterate, at_rest = replace(iterate, x=x), True
            forces, tension, scale = _forces(problem, iterate, load, penalty)
        except LinAlgError:  # no film, or no loop
            return _record(problem, iterate, load, Status.STALLED)
        if scale == 0.0 or problem.pinched(x):  # a point; a soap film without width
            return _record(problem, iterate, load, Status.STALLED)
        residual = float(np.abs(forces).max()) / scale
        if not np.isfinite(residual):
            return _record(problem, iterate, load, Status.NOT_FINITE)
        if residual <= iterate.tolerance:
            iterate = replace(
                iterate,
                multipliers=tension,
                tolerance=max(_TIGHTENING * iterate.tolerance, _FINAL_TOLERANCE),
            )
            before, stretched = stretched, problem.length_error(iterate.x)
            if residual <= RESIDUAL_TOLERANCE and stretched <= LENGTH_TOLERANCE:
                at_rest = _film_at_rest(problem, iterate.x)
                if at_rest:
                    return _record(problem, iterate, load, Status.CONVERGED)
                continue
            # Multipliers that chase a loop to and fro get nowhere: hold it faster.
            if stretched > max(_STRETCHED, 0.5 * before):
                penalty *= 4
            forces, tension, scale = _forces(problem, iterate, load, penalty)
        if iterate.iterations >= budget:
            return _record(problem, iterate, load, Status.ITERATION_LIMIT)
        after = _minimise(problem, iterate, load, penalty, forces, tension, scale)
        if after is None:
            return _record(problem, iterate, load, Status.STALLED)
        if not np.isfinite(after.x).all():
            return _record(problem, iterate, load, Status.NOT_FINITE)
        iterate = after
        observe(iterate.x[problem.loop_vertices])


def _first_penalty(problem: Problem, load: float) -> float:
    """Return the stretching stiffness mu, alpha / L^2.

    Its stiffest mode is as stiff as the loop's in bending, 4 mu / s = 16 / s^3: softer lets
    lengths drift, stiffer slows the iteration down. But film and bending are to be weak
    against it, load and 4 pi^2 against mu / 8: else they would draw the loop to a point.
    """
    even = 4.0 / float(np.mean(problem.loop.rest_lengths)) ** 2
    return max(even, 10.0 * load, _STIFFER_THAN_BENDING)


def _film_at_rest(problem: Problem, x: FloatArray) -> bool:
    """Whether the film balances by its own measure, however little it pulls.

    The residual does not feel a film a million times softer than the loop.
    """
    film = np.abs(problem.film_forces(x, 1.0))
    inside = film[problem.interior].max(initial=0.0)
    return bool(inside <= _FILM_BALANCE * film.max())


def _forces(
    problem: Problem, iterate: _Iterate, load: float, penalty: float
) -> tuple[FloatArray, FloatArray, float]:
    """Return grad A (n_v, 3), the tensions lambda + mu c / s (n_b,), the largest force."""
    x = iterate.x
    excess = problem.loop.constraint(x[problem.loop_vertices])
    tension = iterate.multipliers + penalty * excess / problem.loop.rest_lengths
    parts = (
        problem.bending_energy(x)[1],
        problem.film_forces(x, load),
        problem.tension_force(x, tension),
    )
    scale = max(float(np.abs(part).max()) for part in parts)
    return problem.unslid(x, parts[0] + parts[1] + parts[2]), tension, scale


def _minimise(
    problem: Problem,
    iterate: _Iterate,
    load: float,
    penalty: float,
    forces: FloatArray,
    tension: FloatArray,
    scale: float,
) -> _Iterate | None:
    """Run scipy's conjugate gradients from the iterate as base point; None if stuck.

    The first step tried is as long as the gradient. In the unit of displacement in which
    the loop's stiffest bending mode, 32 / s^3, has stiffness 1 that step is a good one; in
    units of L it overshoots so far that the line search gives up.
    """
    space = trial_space(problem, iterate.x, load)
    springs, weights = space.springs
    base = space.lift(forces)
    unit = float(np.sqrt(problem.loop.rest_lengths.min() ** 3 / 32))

    def difference(scaled: FloatArray) -> tuple[float, FloatArray]:
        moved = space.displacement(unit * scaled)
        gradient = np.empty_like(base)
        value = kernels.augmented_difference(
            moved,
            iterate.x,
            base,
            springs,
            weights,
            problem.loop_vertices,
            problem.loop.rest_lengths,
            tension,
            penalty,
            gradient,
        )
        value += space.beyond_linear(moved, gradient)
        return value, unit * space.collect(gradient)

    reached = np.zeros(space.size)

    def keep(scaled: FloatArray) -> None:
        if not space.holds(space.displacement(unit * scaled)):
            raise StopIteration
        reached[:] = scaled

    found = minimize(
        difference,
        np.zeros(space.size),
        jac=True,
        method="CG",
        callback=keep,
        options={
            # A little less: else rounding might find nothing to do here, and no end there.
            "gtol": 0.99 * unit * iterate.tolerance * scale,
            "maxiter": _ITERATIONS_PER_BASE,
        },
    )
    balanced = float(np.abs(forces).max()) <= iterate.tolerance * scale
    # At rest already: the next tolerance will tell. Else in other unknowns than forces are.
    if not reached.any() and not (found.success and balanced):
        return None
    return replace(
        iterate,
        x=iterate.x + space.displacement(unit * reached),
        iterations=iterate.iterations + int(found.nit),
    )


def _record(
    problem: Problem, iterate: _Iterate, load: float, status: Status
) -> Equilibrium:
    film = problem.film
    return replace(
        problem.equilibrium(iterate.x, iterate.multipliers, load, status),
        iterations=iterate.iterations,
        triangles=film.triangles if isinstance(film, AreaFilm) else None,
    )
