"""The paper's method as it is: conjugate gradients on the positions themselves."""

from __future__ import annotations

from collections.abc import Callable

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape
from eulerplateau.solvers.augmented_lagrangian import Method
from eulerplateau.solvers.conjugate_gradient import search
from eulerplateau.solvers.equilibrium import RESIDUAL_TOLERANCE, Equilibrium
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.variables import plain

# The base point moves along every few thousand iterations.
PLAIN = Method(
    variables=plain,
    iterations=2000,
    stiffer=1.0,
    tensions_follow=False,
    residual=RESIDUAL_TOLERANCE,
    kicked_residual=RESIDUAL_TOLERANCE,
    kicked_limit=1_000_000,
    limit=1_000_000,
)


def minimise(
    problem: Problem,
    load: float,
    start: Shape,
    tensions: FloatArray | None,
    max_iterations: int | None,
    observe: Callable[[FloatArray], None],
) -> Equilibrium:
    """Return the minimum reached from a start. See conjugate_gradient.search."""
    return search(problem, load, start, tensions, max_iterations, observe, PLAIN)
