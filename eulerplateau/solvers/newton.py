"""Newton on the loop: the film's interior eliminated, an iterate is a loop.

With a film of fixed weights the interior is eliminated exactly and once
(condensation.py); a soap film's at each step, near the last shape (chart.py). descent.py
does the rest. A rough start of a large loop is smoothed on a coarse loop first.

The iteration ends where rounding begins. That of the positions alone unbalances the forces
by about eps / h^3 for edges of length h, relative to the largest: a few 1e-7 at 1,700 loop
vertices, 1e-5 at 3,800.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from eulerplateau.arrays import FloatArray
from eulerplateau.film import AreaFilm, Film
from eulerplateau.loop import DENSE_LOOP, close_with_lengths
from eulerplateau.solvers.condensed import loop_energy
from eulerplateau.solvers.descent import Descent, record, stability_of
from eulerplateau.solvers.equilibrium import RESIDUAL_TOLERANCE, Equilibrium, Status
from eulerplateau.solvers.large_loops.coarse_start import coarsen
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.second_variation import (
    LoopEnergy,
)


def solve(
    problem: Problem,
    x: FloatArray,
    multipliers: FloatArray,
    load: float,
    *,
    max_iterations: int = 500,
    observe: Callable[[FloatArray], None] = lambda x_loop: None,
) -> Equilibrium:
    """Return the minimum reached from x (n_v, 3).

    Of films with fixed weights only the loop matters; a soap film's interior is where its
    mesh lies. Multipliers (n_b,) that belong to x save time; zeros are no harm. `observe`
    is shown the loop (n_b, 3) after every step.
    """
    started = time.perf_counter()
    if (refused := problem.refused(x, load)) is not None:
        return refused
    try:
        found = _found(problem, x, multipliers, load, max_iterations, observe)
    except np.linalg.LinAlgError:
        found = None  # a loop that has fallen onto a line has no tensions
    if found is None:
        unknown = np.zeros(len(problem.loop_vertices))
        found = problem.equilibrium(x, unknown, load, Status.STALLED)
    return problem.judged(replace(found, seconds=time.perf_counter() - started))


def _found(
    problem: Problem,
    x: FloatArray,
    multipliers: FloatArray,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what the film's own search comes to; None if no loop is near x."""
    if isinstance(problem.film, Film):
        return _search(problem, x, multipliers, load, max_iterations, observe)
    # Loaded only where a film asks for it.
    from eulerplateau.solvers.soap import search_in_plane, search_soap

    if not isinstance(problem.film, AreaFilm):
        return search_in_plane(problem, x, load, max_iterations, observe)
    # Blocks of a hundred rows: two threads would mostly wait for each other.
    with threadpool_limits(1, user_api="blas"):
        return search_soap(problem, x, load, max_iterations, observe)


def _search(
    problem: Problem,
    x: FloatArray,
    multipliers: FloatArray,
    load: float,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> Equilibrium | None:
    """Return what a film with fixed weights comes to; None if no loop is near x."""
    energy = loop_energy(problem, load)
    assert isinstance(energy, LoopEnergy)
    x_loop = _start(energy, x[problem.loop_vertices], max_iterations)
    if x_loop is None:
        return None
    descent = Descent(energy, max_iterations, observe)
    state = descent.settled(x_loop, multipliers, 0) if multipliers.any() else None
    status = Status.CONVERGED
    if state is None:
        state, status = descent.run(x_loop)
    balanced = state.model.residual <= RESIDUAL_TOLERANCE
    if state.stability is None and (balanced or energy.dense):
        state = replace(state, stability=stability_of(energy, state.model))
    return record(problem, state, load, status)


def _start(energy: LoopEnergy, x: FloatArray, max_iterations: int) -> FloatArray | None:
    """Return a loop that keeps its lengths, near x (n_b, 3); None if there is none.

    A large loop with more energy in its roughness than in its shape is smoothed first, by
    minimising on a coarse one.
    """
    given = close_with_lengths(energy.loop, x)
    if energy.dense:
        return given
    coarse = coarsen(energy, DENSE_LOOP)
    nowhere = np.zeros_like(x)
    shape = close_with_lengths(coarse.energy.loop, coarse.restrict(x))
    if shape is None:
        return given
    smooth = close_with_lengths(energy.loop, coarse.prolong(shape))
    if given is not None and (
        smooth is None or energy.change(nowhere, given) < 2 * energy.change(nowhere, smooth)
    ):
        return given
    minimum = Descent(coarse.energy, max_iterations).run(shape)[0].model.x
    smooth = close_with_lengths(energy.loop, coarse.prolong(minimum))
    return given if smooth is None else smooth
