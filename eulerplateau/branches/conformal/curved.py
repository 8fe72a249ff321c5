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
from eulerplateau.errors import NOT_CONVERGED_EXIT_CODE, EulerPlateauError


class NoFilmError(EulerPlateauError):
    """There is no film of a branch where it is asked for, or none that is resolved."""

    exit_code = NOT_CONVERGED_EXIT_CODE


def curved(
    point: BranchPoint,
    rest_curvature: float,
    tell: Callable[[str], None] = lambda where: None,
) -> BranchPoint:
    """Return the film that a film of no link leads to as its rod's natural curvature rises.

    rest_curvature : float, q = k0 L / 2 pi, positive
    tell : is told how far it has come, film by film

    Raises NoFilmError where the branch folds on the way.
    """
    straight = smooth_family(point)
    values = {**straight.values, "rest_curvature": 0.0}
    family = CurvedFamily(straight.basis, values, "rest_curvature")
    control = StepControl(
        window=(-1.0, rest_curvature),
        unit=1.0,
        first_step=0.1,
        largest_step=0.2,
        smallest_step=1e-4,
        least=-math.inf,
    )
    start = point_near(family, family.framed(point.x), 0.0, control.least)
    if start is None:
        raise NoFilmError("Newton's method finds no frame on the film of the straight rod")
    place = Place(first_point(family, start.x, 0.0, control), 0.1, control.max_points)
    while True:
        before = place.point
        tell(f"rest curvature {before.value:.3f}")
        after = next_place(place, control)
        if after is None or after.point.value < before.value:
            problem = f"the branch folds near the rest curvature {before.value:.4g}"
            raise NoFilmError(problem)
        if after.point.value >= rest_curvature:
            found = ahead(before, rest_curvature, control.least)
            if found is None:
                problem = f"Newton's method fails at the rest curvature {rest_curvature:g}"
                raise NoFilmError(problem)
            return resolved(found, control)
        place = replace(after, point=resolved(after.point, control))
