"""The paper's method: scipy's conjugate gradients over all mesh vertices.

The edge lengths are kept by an augmented Lagrangian,

    A(x) = E(x) + sum_v [lambda_v c_v + mu c_v^2 / (2 s_v)],   lambda_v += mu c_v / s_v.

Conjugate gradients stall when the line search compares energies that differ by rounding
only. So the unknown is the displacement u from a base point, A is evaluated as the
difference A(x0 + u) - A(x0), and the base moves along every few thousand iterations.
A saddle balances its forces too: a result is accepted only if a small transverse kick and
a second solve come back to the same energy.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize

from eulerplateau import kernels
from eulerplateau.mesh import FloatArray
from eulerplateau.problem import Problem
from eulerplateau.solution import LENGTH_TOLERANCE, RESIDUAL_TOLERANCE, Equilibrium, Status

# A tenfold tighter residual for every update of the multipliers; the floor leaves the
# multipliers' last update room below the accepted tolerance.
_FIRST_TOLERANCE = 1e-2
_TIGHTENING = 0.1
_FINAL_TOLERANCE = 0.3 * RESIDUAL_TOLERANCE
_ITERATIONS_PER_BASE = 2000
# Kicks before the load is given up as lying at a transition.
_KICKS = 5
_KICK_SIZE = 1e-3
_SAME_ENERGY = 1e-8


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
    best = _descend(problem, x, multipliers, load, max_iterations, observe)
    spent = best.iterations
    confirmed = False
    rng = np.random.default_rng(0)
    for _ in range(_KICKS):
        if not best.converged:
            break
        kicked = best.x + transverse_kick(best.x[problem.loop_vertices], best.x, rng)
        left = max_iterations - spent
        again = _descend(problem, kicked, best.multipliers, load, left, observe)
        spent += again.iterations
        confirmed = again.converged and (
            abs(again.energy - best.energy) <= _SAME_ENERGY * abs(best.energy)
        )
        if confirmed:
            break
        best = again if again.energy < best.energy or not again.converged else best
    if best.converged and not confirmed:
        best = replace(best, status=Status.SADDLE)
    return replace(best, iterations=spent, seconds=time.perf_counter() - started)


def transverse_kick(
    x_loop: FloatArray, x: FloatArray, rng: np.random.Generator
) -> FloatArray:
    """Return a smooth random displacement (n_v, 3) of 1e-3 L across the loop's mean plane.

    A random polynomial of degree 2 to 4 in the in-plane coordinates (lower degrees are
    rigid motions): noise from vertex to vertex would be smoothed away by the bending
    stiffness before it reached the modes that become unstable.
    """
    centre = x_loop.mean(axis=0)
    axes = np.linalg.svd(x_loop - centre)[2]
    a, b = ((x - centre) @ axes[:2].T / np.abs(x_loop - centre).max()).T
    powers = [(i, d - i) for d in (2, 3, 4) for i in range(d + 1)]
    height = sum(rng.standard_normal() * a**i * b**j for i, j in powers)
    return np.outer(height * (_KICK_SIZE / np.abs(height).max()), axes[2])


def _descend(
    problem: Problem,
    x: FloatArray,
    multipliers: FloatArray,
    load: float,
    budget: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium:
    """Run the augmented Lagrangian to the tolerances, or until it stalls or runs out."""
    # The stretching stiffness whose stiffest mode is as stiff as the loop's in bending:
    # 4 mu / s = 16 / s^3. Softer lets lengths drift, stiffer slows the iteration down.
    penalty = 4.0 / float(np.mean(problem.loop.rest_lengths)) ** 2
    iterate = _Iterate(x, multipliers, _FIRST_TOLERANCE, 0)
    while True:
        forces, tension, scale = _forces(problem, iterate, load, penalty)
        residual = float(np.abs(forces).max()) / scale
        if not np.isfinite(residual):
            return _record(problem, iterate, load, Status.NOT_FINITE)
        if residual <= iterate.tolerance:
            iterate = replace(
                iterate,
                multipliers=tension,
                tolerance=max(_TIGHTENING * iterate.tolerance, _FINAL_TOLERANCE),
            )
            if residual <= RESIDUAL_TOLERANCE and (
                problem.length_error(iterate.x) <= LENGTH_TOLERANCE
            ):
                return _record(problem, iterate, load, Status.CONVERGED)
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


def _forces(
    problem: Problem, iterate: _Iterate, load: float, penalty: float
) -> tuple[FloatArray, FloatArray, float]:
    """Return grad A (n_v, 3), the tensions lambda + mu c / s (n_b,), the largest force."""
    x = iterate.x
    excess = problem.loop.constraint(x[problem.loop_vertices])
    tension = iterate.multipliers + penalty * excess / problem.loop.rest_lengths
    parts = (
        problem.bending_energy(x)[1],
        problem.film_energy(x, load)[1],
        problem.tension_force(x, tension),
    )
    scale = max(float(np.abs(part).max()) for part in parts)
    return parts[0] + parts[1] + parts[2], tension, scale


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
    weights = load * problem.film.weights
    shape = iterate.x.shape
    unit = float(np.sqrt(problem.loop.rest_lengths.min() ** 3 / 32))

    def difference(scaled: FloatArray) -> tuple[float, FloatArray]:
        gradient = np.empty(shape)
        value = kernels.augmented_difference(
            unit * scaled.reshape(shape),
            iterate.x,
            forces,
            problem.film.edges,
            weights,
            problem.loop_vertices,
            problem.loop.rest_lengths,
            tension,
            penalty,
            gradient,
        )
        return value, unit * gradient.ravel()

    found = minimize(
        difference,
        np.zeros(iterate.x.size),
        jac=True,
        method="CG",
        options={
            "gtol": unit * iterate.tolerance * scale,
            "maxiter": _ITERATIONS_PER_BASE,
        },
    )
    if found.nit == 0 and not found.success:
        return None
    return replace(
        iterate,
        x=iterate.x + unit * found.x.reshape(shape),
        iterations=iterate.iterations + int(found.nit),
    )


def _record(
    problem: Problem, iterate: _Iterate, load: float, status: Status
) -> Equilibrium:
    return replace(
        problem.equilibrium(iterate.x, iterate.multipliers, load, status),
        iterations=iterate.iterations,
    )
