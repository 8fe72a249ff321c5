"""A film as fine as the strands of its loop are apart where these cross."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import isinf

from eulerplateau.mesh import Shape
from eulerplateau.solvers.equilibrium import Equilibrium
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.start import coarse

# How long edges of the film may be where strands cross: in diameters; or in edges of the
# loop if that is more, since triangles that join these are thin if they are finer.
_OF_DIAMETER = 1 / 2
_OF_LOOP = 1 / 3
# A film is refined once in one solve, and laid on its mesh again where its strands part.
_TIMES = 2


def resolved(
    problem: Problem,
    found: Equilibrium | None,
    again: Callable[[Shape, int], Equilibrium | None],
) -> Equilibrium | None:
    """Return what a film comes to where it is as fine as its contacts need it.

    Where strands have parted it is that of the mesh again. What has not converged is
    returned as it is; and what has, if the film with other triangles does not.

    again : of a shape and the iterations spent, what the film comes to from there
    """
    for _ in range(_TIMES if problem.refines else 0):
        if found is None or not found.converged:
            break
        shape = _fit(problem, found)
        if shape is found.shape:
            break
        other = again(shape, found.iterations)
        if other is None or not other.converged:
            break
        found = replace(other, iterations=found.iterations + other.iterations)
    return found


def _fit(problem: Problem, found: Equilibrium) -> Shape:
    """Return the shape of an equilibrium with triangles as its contacts need them."""
    shape, contacts, diameter = found.shape, found.contacts, problem.loop.diameter
    assert contacts is not None
    assert diameter is not None
    crossings = contacts.points.mean(axis=0)[contacts.at_a_point]
    if len(crossings):
        edges = float(problem.loop.rest_lengths.mean())
        finest = max(_OF_DIAMETER * diameter, _OF_LOOP * edges)
        return problem.film.refined(shape, crossings, finest)
    parted = len(contacts) == 0 and isinf(contacts.smallest_gap)
    return coarse(problem, shape) if parted and len(shape.x) > problem.disk.n_v else shape
