"""Films as families of energies: one load after another, near one shape after another."""

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
from eulerplateau.mesh import Shape
from eulerplateau.solvers import Equilibrium, Problem, Status


@dataclass(frozen=True)
class FilmFamily:
    """A film on its loop under one load after another, good near one shape."""

    problem: Problem
    film: FilmOfLoop
    parameter: str = "load"

    def energy(self, value: float) -> LoopEnergy:
        """Return the energy at a load."""
        return self.film.energy(self.problem.loop, value)

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

    def _with(self, film: FilmOfLoop) -> FilmFamily:
        return self if film is self.film else replace(self, film=film)


def family_of(point: BranchPoint) -> FilmFamily:
    """Return the family of a point of a film's branch: all of them have such a one."""
    return cast(FilmFamily, point.family)


def equilibrium(point: BranchPoint) -> Equilibrium:
    """Return the equilibrium of a film at a point of one of its branches."""
    family = family_of(point)
    problem, shape = family.problem, family.film.shape(point.x)
    found = problem.equilibrium(shape, point.model.tensions, point.value, Status.CONVERGED)
    classified = problem.classified(found)
    return replace(classified, iterations=point.corrections, stability=point.stability)


def family_near(problem: Problem, shape: Shape) -> tuple[FilmFamily, FloatArray]:
    """Return the family good near a shape, and the shape's loop in its coordinates."""
    film = problem.film.of_loop(problem.film.prepared(shape))
    return FilmFamily(problem, film), film.project(shape.x_loop)


def likeness_of(problem: Problem, within: float) -> Likeness:
    """Return which loops of a film are the same, up to a distance at rest: see likeness."""
    rest = problem.disk.x[problem.disk.loop]
    # Of a round loop sliding is a rotation: a long one is asked whether it costs nothing.
    centred = rest - rest.mean(axis=0)
    axis = np.linalg.svd(centred, full_matrices=False)[2][0]
    long = rest + np.outer(centred @ axis, axis)
    slides = problem.film.slide(problem.loop, long) is not None
    return likeness(problem.loop, rest, slides, within)
