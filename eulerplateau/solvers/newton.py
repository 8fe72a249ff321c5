"""Newton on the loop: the film's interior eliminated, an iterate is a loop.

With a film of fixed weights the interior is eliminated exactly and once (quadratic.py); a
soap film's at each step, near the last shape (soap.py); a film kept in its plane has no use
for one (in_plane/). Which is the case is asked here and nowhere else.

The iteration ends where rounding begins. That of the positions alone unbalances the forces
by about eps / h^3 for edges of length h, relative to the largest: a few 1e-7 at 1,700 loop
vertices, 1e-5 at 3,800.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film import AreaFilm, Film, PlaneFilm
from eulerplateau.mesh import Shape
from eulerplateau.solvers.equilibrium import Equilibrium, Status
from eulerplateau.solvers.problem import Problem


class Search(Protocol):
    """Looks for a minimum near a start."""

    def __call__(
        self,
        problem: Problem,
        start: Shape,
        tensions: FloatArray | None,
        load: float,
        max_iterations: int,
        observe: Callable[[FloatArray], None],
    ) -> Equilibrium | None:
        """Return what it comes to; None if no loop, or no film on it, is near."""


def minimise(
    problem: Problem,
    load: float,
    start: Shape,
    tensions: FloatArray | None,
    max_iterations: int | None,
    observe: Callable[[FloatArray], None],
) -> Equilibrium:
    """Return the minimum reached from a start: see solving.solve."""
    started = time.perf_counter()
    if (unusable := problem.unusable_start(start, load)) is not None:
        return unusable
    limit = 500 if max_iterations is None else max_iterations
    try:
        search = _search_for(problem.film)
        found = search(problem, start, tensions, load, limit, observe)
    except np.linalg.LinAlgError:
        found = None  # a loop that has fallen onto a line has no tensions
    if found is None:
        unknown = np.zeros(len(start.loop))
        found = problem.equilibrium(start, unknown, load, Status.STALLED)
    return problem.classified(replace(found, seconds=time.perf_counter() - started))


def _search_for(film: Film) -> Search:
    """Return the search that suits a film, its modules loaded now."""
    match film:
        case AreaFilm():
            from eulerplateau.solvers.soap import search
        case PlaneFilm():
            from eulerplateau.solvers.in_plane.search import search
        case _:
            from eulerplateau.solvers.quadratic import search
    return search
