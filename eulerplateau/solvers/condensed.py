"""Which energy of loops a problem comes to, its interior eliminated."""

from __future__ import annotations

from eulerplateau.film import AreaEnergy, Chart
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.second_variation import LoopEnergy


def loop_energy(problem: Problem, load: float) -> LoopEnergy | AreaEnergy:
    """Return the condensed energy of a problem at a load."""
    condensed = problem.condensed
    if isinstance(condensed, Chart):
        return AreaEnergy(problem.loop, condensed, load)
    return LoopEnergy(
        problem.loop, 2 * problem.loop.bending_matrix, 2 * load * condensed.stiffness
    )
