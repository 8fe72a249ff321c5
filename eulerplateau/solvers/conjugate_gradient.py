"""The paper's method: scipy's conjugate gradients over loop and film together.

The edge lengths are kept by an augmented Lagrangian (augmented_lagrangian.py). At every
base point variables are chosen anew, in which the problem is well conditioned
(variables.py); plain_gradient.py does without. What the unknowns are depends on the film
(trial_space.py).

A saddle balances its forces too: a result is accepted only if a small kick and a second
solve come back to the same energy. A film that turns against its mesh leaves a saddle
slowly, and the second solve has to look closer. Where turning costs nothing that could be
measured it would walk on for ever: what it has not gained in a few hundred iterations is
not there to be gained. Of a kick there is left what comes back most slowly: along that the
energy may still fall, too slowly to be noticed. There the next kick goes.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape
from eulerplateau.solvers.augmented_lagrangian import Method, descend
from eulerplateau.solvers.equilibrium import RESIDUAL_TOLERANCE, Equilibrium, Status
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.saddles import way_down
from eulerplateau.solvers.start import smooth_kick
from eulerplateau.solvers.trial_space import kick_axis
from eulerplateau.solvers.variables import conditioned

# Kicks before the load is given up as lying at a transition.
_KICKS = 5
_SAME_ENERGY = 1e-8

# Where a stiff edge costs no iterations the penalty is as large as rounding lets it be, and
# a film that turns takes its tensions along. Tensions that stay behind draw it to and fro.
CONDITIONED = Method(
    variables=conditioned,
    iterations=50,
    stiffer=1e3,
    tensions_follow=True,
    residual=0.1 * RESIDUAL_TOLERANCE,
    kicked_residual=1e-4 * RESIDUAL_TOLERANCE,
    kicked_limit=300,
    limit=20_000,
)


def minimise(
    problem: Problem,
    load: float,
    start: Shape,
    tensions: FloatArray | None,
    max_iterations: int | None,
    observe: Callable[[FloatArray], None],
) -> Equilibrium:
    """Return the minimum reached from a start, in well conditioned variables.

    `observe` is shown the loop (n_b, 3) each time the base point moves. See solving.solve.
    """
    return search(problem, load, start, tensions, max_iterations, observe, CONDITIONED)


def search(
    problem: Problem,
    load: float,
    start: Shape,
    tensions: FloatArray | None,
    max_iterations: int | None,
    observe: Callable[[FloatArray], None],
    method: Method,
) -> Equilibrium:
    """Return the minimum reached from a start, confirmed by a kick and a new solve."""
    started = time.perf_counter()
    if (unusable := problem.unusable_start(start, load)) is not None:
        return unusable
    limit = method.limit if max_iterations is None else max_iterations
    if tensions is None:
        tensions = np.zeros(len(start.loop))
    aim = method.residual
    best = descend(problem, start, tensions, load, limit, observe, method, aim)
    spent = best.iterations
    confirmed = False
    rng = np.random.default_rng(0)
    axis = kick_axis(problem.film)
    down: Shape | None = None
    for _ in range(_KICKS):
        if not best.converged:
            break
        shape, known = best.shape, down is not None
        kick = smooth_kick(shape.x_loop, shape.x, rng, axis)
        kicked = shape.moved(shape.x + kick) if down is None else down
        left, aim = min(limit - spent, method.kicked_limit), method.kicked_residual
        again = descend(problem, kicked, best.tensions, load, left, observe, method, aim)
        spent += again.iterations
        gained = _without_excess(problem, best) - _without_excess(problem, again)
        confirmed = abs(gained) <= _SAME_ENERGY * abs(best.energy)
        # Once: where nothing is gained down there either it is the same state.
        ask = confirmed and not known
        down = way_down(problem, best, again, load) if ask else None
        if down is not None:
            confirmed = False
            continue
        if confirmed and not again.converged:
            break
        if not again.converged:
            left, aim = limit - spent, method.residual
            again = descend(
                problem, again.shape, again.tensions, load, left, observe, method, aim
            )
            spent += again.iterations
        if confirmed:
            best = min(best, again, key=lambda found: found.length_error)
            break
        gained = _without_excess(problem, best) - _without_excess(problem, again)
        best = again if gained > 0 or not again.converged else best
    if best.converged and not confirmed:
        best = replace(best, status=Status.SADDLE)
    seconds = time.perf_counter() - started
    return problem.classified(replace(best, iterations=spent, seconds=seconds))


def _without_excess(problem: Problem, found: Equilibrium) -> float:
    """Return the energy, alpha / L, that it would have if its edges kept their lengths.

    To the first order: an excess that is tolerated may show more than energies may differ.
    """
    excess = problem.loop.constraint(found.shape.x_loop)
    return found.energy + float(found.tensions @ excess)
