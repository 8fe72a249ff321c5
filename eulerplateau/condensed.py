"""Which energy of loops a problem comes to, its interior eliminated."""

from __future__ import annotations

from eulerplateau.area_energy import AreaEnergy
from eulerplateau.chart import Chart
from eulerplateau.problem import Problem
from eulerplateau.tangent import LoopEnergy


def loop_energy(problem: Problem, load: float) -> LoopEnergy | AreaEnergy:
    """Return the condensed energy of a problem at a load."""
    condensed = problem.condensed
    if isinstance(condensed, Chart):
        return AreaEnergy(problem.loop, condensed, load)
    return LoopEnergy(
        problem.loop, 2 * problem.loop.bending_matrix, 2 * load * condensed.stiffness
    )
