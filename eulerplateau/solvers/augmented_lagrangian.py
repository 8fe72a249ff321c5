"""Conjugate gradients with the loop's lengths kept by an augmented Lagrangian.

    A(x) = E(x) + sum_v [lambda_v c_v + mu c_v^2 / (2 s_v)],   lambda_v += mu c_v / s_v.

Conjugate gradients stall when the line search compares energies that differ by rounding
only. So the unknown is the displacement u from a base point, A is evaluated as the
difference A(x0 + u) - A(x0), and the base moves along.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError
from scipy.optimize import minimize

from eulerplateau.arrays import FloatArray
from eulerplateau.interruption import heed
from eulerplateau.loop import Loop, kernels, largest_turning
from eulerplateau.mesh import Shape
from eulerplateau.solvers.equilibrium import (
    LENGTH_TOLERANCE,
    RESIDUAL_TOLERANCE,
    RESOLVED_TURNING,
    Equilibrium,
    Status,
)
from eulerplateau.solvers.loop_terms import beyond_linear
from eulerplateau.solvers.penalty import bearable_penalty, first_penalty, rounded
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.trial_space import TrialSpace, trial_space
from eulerplateau.solvers.variables import Variables

# A tenfold tighter residual for every update of the tensions, down to a part of the one
# asked for: that leaves the tensions' last update room.
_FIRST_TOLERANCE = 1e-2
_TIGHTENING = 0.1
_ROOM = 0.3
# Energy, alpha / L, that is nothing to gain between base points: a circle has 4 pi^2. What
# tensions do where edges are rounded is nothing, either.
_NOTHING = 1e-11
# Base points in a row at their tolerance with nothing gained, after which it is over; more
# where forces are larger than they should be, which is rounding's doing if it stays so.
_IDLE, _IDLE_AT_ROUNDING = 10, 40
# Forces inside a film at rest over the largest of its forces on the loop.
_FILM_BALANCE = 1e-3
# Relative length error up to which a loop is near enough to be held as it moves.
_NEAR = 1.0
# Relative length error above which the penalty may have to grow.
_STRETCHED = 1e-2
# Iterations, in those from one base point, on loops that turn farther than their mesh can
# carry, before such a loop is taken for where the way leads.
_PATIENCE = 20


@dataclass(frozen=True)
class Method:
    """How conjugate gradients are used.

    Attributes
    ----------
    variables : what they search in
    iterations : from one base point
    stiffer : the penalty of the lengths, of what the paper's variables bear
    tensions_follow : whether tensions are updated at every base point, or at balance only
    residual : what they aim at
    kicked_residual, kicked_limit : what they aim at after a kick, in how many iterations
    limit : iterations after which a load is given up
    """

    variables: Callable[[TrialSpace, Loop, FloatArray, float], Variables]
    iterations: int
    stiffer: float
    tensions_follow: bool
    residual: float
    kicked_residual: float
    kicked_limit: int
    limit: int


@dataclass(frozen=True)
class _Iterate:
    """A shape, its tensions (n_b,), the tolerance in force, iterations so far.

    `idle` is _IDLE or more where the last base points have gained nothing: one that was
    left for another reason than being at the tolerance counts for all.
    """

    shape: Shape
    tensions: FloatArray
    tolerance: float
    iterations: int
    idle: int = 0


def descend(
    problem: Problem,
    shape: Shape,
    tensions: FloatArray,
    load: float,
    budget: int,
    observe: Callable[[FloatArray], None],
    method: Method,
    aim: float,
) -> Equilibrium:
    """Run the augmented Lagrangian to the tolerances, or until it stalls or runs out."""
    first, stretched, firmer = first_penalty(problem.loop, load), np.inf, 1.0
    iterate, at_rest, carried = _Iterate(shape, tensions, _FIRST_TOLERANCE, 0), True, 0
    while True:
        heed()
        try:
            shape = iterate.shape
            if not at_rest:
                film = problem.film.of_loop(shape)
                shape = film.shape(film.project(shape.x_loop))
            shape = problem.film.prepared(shape)
            iterate, at_rest = replace(iterate, shape=shape), True
            near = problem.length_error(shape) <= _NEAR
            own = _own_forces(problem, shape, load)
            penalty = firmer * first
            if near:
                bearable = bearable_penalty(problem.loop, shape, own, method.residual)
                penalty = max(penalty, min(penalty * method.stiffer, bearable))
            forces, tension, scale = _forces(problem, iterate, own, penalty)
        except LinAlgError:  # no film, or no loop
            return _record(problem, iterate, load, Status.STALLED)
        if scale == 0.0 or problem.pinched(shape):  # a point; a soap film without width
            return _record(problem, iterate, load, Status.STALLED)
        residual = float(np.abs(forces).max()) / scale
        if not np.isfinite(residual):
            return _record(problem, iterate, load, Status.NOT_FINITE)
        if iterate.idle >= _IDLE:
            found = _given_up(problem, iterate, load, Status.STALLED)
            balanced = found.converged and residual <= method.residual
            if balanced or iterate.idle >= _IDLE_AT_ROUNDING:
                return found
        if residual <= iterate.tolerance:
            iterate = replace(
                iterate,
                tensions=tension,
                tolerance=max(_TIGHTENING * iterate.tolerance, _ROOM * aim),
            )
            before, stretched = stretched, problem.length_error(shape)
            if residual <= aim and stretched <= LENGTH_TOLERANCE:
                at_rest = _film_at_rest(problem, shape)
                if at_rest:
                    return _record(problem, iterate, load, Status.CONVERGED)
                continue
            # Tensions that chase a loop to and fro get nowhere: hold it faster.
            if stretched > max(_STRETCHED, 0.5 * before):
                penalty, firmer = 4 * penalty, 4 * firmer
            forces, tension, scale = _forces(problem, iterate, own, penalty)
        if iterate.iterations >= budget:
            return _given_up(problem, iterate, load, Status.ITERATION_LIMIT)
        after = _minimise(problem, method, iterate, load, penalty, forces, tension, scale)
        if after is None:
            return _given_up(problem, iterate, load, Status.STALLED)
        if not np.isfinite(after.shape.x).all():
            return _record(problem, iterate, load, Status.NOT_FINITE)
        iterate = after
        if method.tensions_follow and near:
            iterate = replace(iterate, tensions=_tension(problem, iterate, penalty))
        observe(iterate.shape.x_loop)
        if largest_turning(iterate.shape.x_loop) <= RESOLVED_TURNING:
            carried = iterate.iterations
        elif iterate.iterations - carried >= _PATIENCE * method.iterations:
            return _given_up(problem, iterate, load, Status.UNRESOLVED)


def _film_at_rest(problem: Problem, shape: Shape) -> bool:
    """Whether the film balances by its own measure, however little it pulls.

    The residual does not feel a film a million times softer than the loop.
    """
    film = np.abs(problem.film.forces(shape))
    inside = film[problem.disk.interior].max(initial=0.0)
    return bool(inside <= _FILM_BALANCE * film.max())


def _own_forces(problem: Problem, shape: Shape, load: float) -> list[FloatArray]:
    """Return grad E (n_v, 3) by parts: bending, film, what else the loop feels."""
    film = load * problem.film.forces(shape)
    return [problem.bending_energy(shape)[1], film, *problem.loop_forces(shape)]


def _forces(
    problem: Problem, iterate: _Iterate, own: list[FloatArray], penalty: float
) -> tuple[FloatArray, FloatArray, float]:
    """Return grad A (n_v, 3), the tensions lambda + mu c / s (n_b,), the largest force."""
    shape = iterate.shape
    tension = _tension(problem, iterate, penalty)
    parts = [*own, problem.tension_force(shape, tension)]
    scale = max(float(np.abs(part).max()) for part in parts)
    total = problem.without_sliding(shape, sum(parts[1:], start=parts[0]))
    return total, tension, scale


def _tension(problem: Problem, iterate: _Iterate, penalty: float) -> FloatArray:
    """Return the tensions lambda + mu c / s (n_b,)."""
    excess = problem.loop.constraint(iterate.shape.x_loop)
    return iterate.tensions + penalty * excess / problem.loop.rest_lengths


def _minimise(
    problem: Problem,
    method: Method,
    iterate: _Iterate,
    load: float,
    penalty: float,
    forces: FloatArray,
    tension: FloatArray,
    scale: float,
) -> _Iterate | None:
    """Run scipy's conjugate gradients from the iterate as base point; None if stuck."""
    shape = iterate.shape
    space = trial_space(problem, shape, load)
    variables = method.variables(space, problem.loop, shape.x_loop, penalty)
    rod = beyond_linear(problem.loop, shape)
    springs, weights = space.springs
    base = space.lift(forces)
    gradient = np.empty_like(base)
    goal = iterate.tolerance * scale
    nothing = max(_NOTHING, float(np.linalg.norm(tension)) * rounded(shape))
    last = reached = np.zeros(variables.size)
    moved, value, change = np.zeros_like(base), 0.0, 0.0
    idle = _IDLE

    def difference(y: FloatArray) -> tuple[float, FloatArray]:
        nonlocal last, moved, value
        last = y.copy()
        moved = variables.displacement(y)
        value = kernels.augmented_difference(
            moved,
            shape.x,
            base,
            springs,
            weights,
            shape.loop,
            problem.loop.rest_lengths,
            tension,
            penalty,
            gradient,
        )
        value += space.beyond_linear(moved, gradient) + rod(moved, gradient)
        return value, variables.derivative(y, gradient)

    def keep(y: FloatArray) -> None:
        nonlocal reached, change, idle
        if not np.array_equal(last, y):
            difference(y)
        if not space.holds(moved):
            raise StopIteration
        reached, change = last, value
        # A little less: else rounding might find nothing to do here, and no end there.
        if float(np.abs(space.collect(gradient)).max()) <= 0.99 * goal:
            idle = 1
            raise StopIteration

    found = minimize(
        difference,
        reached,
        jac=True,
        method="CG",
        callback=keep,
        options={"gtol": 0.0, "maxiter": method.iterations},
    )
    # At rest already: the next tolerance will tell. Else in other unknowns than forces are.
    if not reached.any() and not float(np.abs(forces).max()) <= goal:
        return None
    return replace(
        iterate,
        shape=space.reached(variables.displacement(reached)),
        iterations=iterate.iterations + max(int(found.nit), 1),
        idle=iterate.idle + idle if change > -nothing else 0,
    )


def _given_up(
    problem: Problem, iterate: _Iterate, load: float, status: Status
) -> Equilibrium:
    """Record where a search ended that found no more to gain, or no time left for it."""
    found = _record(problem, iterate, load, status)
    accepted = (
        found.residual <= RESIDUAL_TOLERANCE
        and found.length_error <= LENGTH_TOLERANCE
        and _film_at_rest(problem, iterate.shape)
    )
    return replace(found, status=Status.CONVERGED) if accepted else found


def _record(
    problem: Problem, iterate: _Iterate, load: float, status: Status
) -> Equilibrium:
    found = problem.equilibrium(iterate.shape, iterate.tensions, load, status)
    return replace(found, iterations=iterate.iterations)
