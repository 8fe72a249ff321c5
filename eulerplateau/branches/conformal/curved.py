"""The film of a rod that is straight by nature, followed to one that is curved."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from eulerplateau.branches.conformal.curved_family import CurvedFamily
from eulerplateau.branches.conformal.family import smooth_family
from eulerplateau.branches.conformal.resolution import resolved
from eulerplateau.branches.continuation import Place, next_place
from eulerplateau.branches.control import StepControl
from eulerplateau.branches.point import BranchPoint, ahead, first_point, point_near
from eulerplateau.errors import NotConvergedError
from eulerplateau.exact.conformal import LOBED, Basis, make_basis, welded_basis

# The tail of films on the way to the one asked for.
_ON_THE_WAY = 1e-6
# Harmonics of a loop whose curvature jumps at its weld.
_FEWEST = 32


class NoFilmError(NotConvergedError):
    """There is no film of a branch where it is asked for, or none that is resolved."""


def curved(
    point: BranchPoint,
    rest_curvature: float,
    tell: Callable[[str], None] = lambda where: None,
) -> BranchPoint:
    """Return the film that one of a straight rod leads to as its natural curvature rises.

    rest_curvature : float, q = k0 L / 2 pi, positive
    tell : is told how far it has come, film by film

    Raises NoFilmError where the branch folds on the way.
    """
    straight = smooth_family(point)
    values = {**straight.values, "rest_curvature": 0.0}
    basis = _welded(straight.basis, values["link"])
    family = CurvedFamily(basis, values, "rest_curvature")
    control = StepControl(
        window=(-1.0, rest_curvature),
        unit=1.0,
        first_step=0.1,
        largest_step=0.2,
        smallest_step=1e-4,
        least=-math.inf,
    )
    start = point_near(family, family.framed(straight, point.x), 0.0, control.least)
    if start is None:
        raise NoFilmError("Newton's method finds no frame on the film of the straight rod")
    place = Place(first_point(family, start.x, 0.0, control), 0.1, control.max_points)
    while True:
        before = place.point
        tell(f"rest curvature {before.value:.3f}")
        after = next_place(place, control)
        if after is None or after.point.value < before.value:
            problem = f"the branch folds near the rest curvature {before.value:.4g}"
            raise NoFilmError(problem, "folds")
        if after.point.value < rest_curvature:
            place = replace(after, point=resolved(after.point, control, _ON_THE_WAY))
            continue
        nearest = min(before, after.point, key=lambda p: abs(p.value - rest_curvature))
        found = ahead(nearest, rest_curvature, control.least)
        if found is not None:
            return resolved(found, control)
        place = replace(place, step=0.5 * place.step)
        if place.step < control.smallest_step:
            problem = f"Newton's method fails at the rest curvature {rest_curvature:g}"
            raise NoFilmError(problem)


def _welded(basis: Basis, link: float) -> Basis:
    """Return a basis of the loops of a rod that was turned, and is curved by nature.

    A whole number of turns leaves no weld, others a jump of the loop's curvature there; of
    the half-turns both leave one.
    """
    if link == 0:
        return basis
    if link == round(link):
        return make_basis(basis.harmonics, LOBED, basis.crowding)
    return welded_basis(max(basis.harmonics, _FEWEST), LOBED, basis.crowding)
