"""Films as families of energies: one load, or link, after another, near one shape."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.likeness import Likeness, likeness
from eulerplateau.branches.point import BranchPoint
from eulerplateau.film import FilmOfLoop
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers import Equilibrium, Problem, Status


@dataclass(frozen=True)
class FilmFamily:
    """A film on its loop at one value of a parameter after another, good near one shape.

    Attributes
    ----------
    parameter : "load", or one of the loop's own, as "link"
    load : float, at which that is varied; of no account where it is the load
    """

    problem: Problem
    film: FilmOfLoop
    parameter: str = "load"
    load: float = 0.0

    def at(self, value: float) -> tuple[Problem, float]:
        """Return the problem and its load at a value of the parameter."""
        return self.problem.at(self.parameter, value, self.load)

    def energy(self, value: float) -> LoopEnergy:
        """Return the energy at a value of the parameter."""
        problem, load = self.at(value)
        return self.film.energy(problem.loop, load)

    def with_value(self, parameter: str, value: float) -> FilmFamily:
        """Return the family at another value of a parameter that it does not vary."""
        problem, load = self.problem.at(parameter, value, self.load)
        return replace(self, problem=problem, load=load)

    def positions(self, x: FloatArray) -> FloatArray:
        """Return the loop (n_b, 3) as it is."""
        return x

    def near(self, x: FloatArray) -> FilmFamily:
        """Return the film made anew at a loop (n_b, 3)."""
        return self._with(self.film.renewed(x))

    def released(self, x: FloatArray) -> FilmFamily:
        """Return the film as a minimal surface, where it is curved."""
        return self._with(self.film.released(x))

    def kept(self, x: FloatArray) -> Mapping[str, NDArray[Any]]:
        """Return what makes the film again, good near a loop (n_b, 3)."""
        return self.film.kept(x)

    def restored(self, kept: Mapping[str, NDArray[Any]]) -> FilmFamily:
        """Return the film that this was kept of."""
        return self._with(self.film.restored(kept))

    def equilibrium(self, point: BranchPoint) -> Equilibrium:
        """Return the equilibrium at a point of a branch of it."""
        (problem, load), shape = self.at(point.value), self.film.shape(point.x)
        found = problem.equilibrium(shape, point.model.tensions, load, Status.CONVERGED)
        classified = replace(problem.classified(found), iterations=point.corrections)
        return replace(classified, stability=point.stability)

    def _with(self, film: FilmOfLoop) -> FilmFamily:
        return self if film is self.film else replace(self, film=film)


def family_of(point: BranchPoint) -> FilmFamily:
    """Return the family of a point of a film's branch: all of them have such a one."""
    return cast(FilmFamily, point.family)


def equilibrium(point: BranchPoint) -> Equilibrium:
    """Return the equilibrium of a film at a point of one of its branches."""
    return family_of(point).equilibrium(point)


def likeness_of(problem: Problem, within: float) -> Likeness:
    """Return which loops of a film are the same, up to a distance at rest: see likeness."""
    rest = problem.disk.x[problem.disk.loop]
    # Of a round loop sliding is a rotation: a long one is asked whether it costs nothing.
    centred = rest - rest.mean(axis=0)
    axis = np.linalg.svd(centred, full_matrices=False)[2][0]
    long = rest + np.outer(centred @ axis, axis)
    slides = problem.film.slide(problem.loop, long) is not None
    return likeness(problem.loop, rest, slides, within)
