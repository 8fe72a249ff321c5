"""Curves of special points of a film, from the shape of one of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from eulerplateau.branches.control import Direction, StepControl
from eulerplateau.branches.film_family import family_near, family_of
from eulerplateau.branches.locus import follow_locus, locus_start, special_at
from eulerplateau.branches.locus_point import LocusPoint
from eulerplateau.branches.point import BranchPoint
from eulerplateau.errors import SpecError
from eulerplateau.loop import LEAST
from eulerplateau.mesh import Shape
from eulerplateau.solvers import Problem, check_values
from eulerplateau.threads import one_thread, stepwise

Window = tuple[float, float]


@dataclass(frozen=True)
class Known:
    """What a special point of a film is known by: its kind, its shape, how many modes."""

    kind: str
    shape: Shape
    multiplicity: int = 1


def locus_of_film(
    problem: Problem,
    known: Known,
    load: float,
    parameters: tuple[str, str],
    windows: tuple[Window, Window],
) -> Iterator[LocusPoint]:
    """Yield the curve of special points of a film that one of them is on: see follow_locus.

    Parameters
    ----------
    problem, load : of which the known point is an equilibrium
    parameters : names of two, as `explore` knows them
    windows : (low, high) of both

    Raises
    ------
    SpecError : for parameters or windows that do not exist, or where nothing persists
    """
    first, second = parameters
    if first == second:
        raise SpecError("locus.with", f"{first} is what the branches vary already")
    controls = _control(problem, first, windows[0]), _control(problem, second, windows[1])
    value = problem.value(second, load)
    with one_thread():
        family, x = family_near(problem, known.shape, first, load)
        place = special_at(family, x, problem.value(first, load), known.kind)
        special = replace(place, multiplicity=known.multiplicity)
        start = locus_start(special, second, value, controls)
    return stepwise(lambda: follow_locus(start, _pinched))


def energy_at(point: LocusPoint) -> float:
    """Return the energy of the film at a point of a curve."""
    on_branch = _on_branch(point)
    family = family_of(on_branch)
    problem, load = family.at(on_branch.value)
    return problem.energy(family.film.shape(on_branch.x), load)


def _on_branch(point: LocusPoint) -> BranchPoint:
    """Return the point as one of a branch in the first parameter."""
    value = float(point.values[0])
    heading = Direction(point.direction.displacement, float(point.direction.rates[0]))
    corrections = point.corrections
    return BranchPoint(point.family, point.model, value, heading, 0.0, corrections)


def _control(problem: Problem, parameter: str, window: Window) -> StepControl:
    """Return how a parameter is followed in its window; raises SpecError."""
    if parameter != "load":
        check_values(problem, parameter, ())
    low, high = (float(end) for end in window)
    least = LEAST[parameter]
    if not least <= low < high < np.inf:
        raise SpecError("locus.window", f"found {low:g} to {high:g} for {parameter}")
    return StepControl(window, unit=max(abs(low), abs(high)), least=least)


def _pinched(point: LocusPoint) -> bool:
    """Return whether strands meet, which would pass through each other beyond."""
    return family_of(_on_branch(point)).problem.loop.pinched(point.model.x)
