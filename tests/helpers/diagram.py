"""The elongated film's diagram, explored once for all tests, and a branch that folds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from eulerplateau.solvers.condensed import loop_energy

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.exploration import Limits, Visit, explore
from eulerplateau.branches.point import BranchPoint, Settings, first_point
from eulerplateau.branches.special import SpecialPoint
from eulerplateau.loop.lengths import close_with_lengths
from eulerplateau.mesh import load_mesh
from eulerplateau.mesh.disk import DiskMesh
from eulerplateau.mesh.waist import (
    waist_path,
    waist_twist,
)
from eulerplateau.solvers import newton
from eulerplateau.solvers.problem import Problem
from tests.helpers import shapes
from tests.helpers.equilibria import critical_point

ROOT = Path(__file__).parents[2]
SETTINGS = Settings(load_range=(1.0, 3000.0), load_unit=3000.0)


@dataclass(frozen=True)
class Diagram:
    """What an exploration visited, with a few questions that tests ask of it."""

    mesh: DiskMesh
    problem: Problem
    visits: tuple[Visit, ...]

    @property
    def specials(self) -> list[SpecialPoint]:
        """The special points by number."""
        return [v.special for v in self.visits if v.special is not None and not v.known]

    def branch(self, number: int) -> list[Visit]:
        return [visit for visit in self.visits if visit.branch == number]

    def from_special(self, number: int | None) -> list[list[Visit]]:
        """The branches that start from a special point, or the first one."""
        numbers = {visit.branch for visit in self.visits if visit.origin == number}
        return [self.branch(branch) for branch in sorted(numbers)]

    def film(self, point: BranchPoint) -> FloatArray:
        """The whole film (n_v, 3)."""
        return self.problem.condensed.extend(point.x)

    def energy(self, point: BranchPoint) -> float:
        x = self.film(point)
        film = self.problem.film_energy(x, point.load)[0]
        return film + self.problem.bending_energy(x)[0]

    def twist(self, point: BranchPoint) -> float:
        return waist_twist(waist_path(self.mesh), self.film(point))


@cache
def elongated() -> Diagram:
    """The diagram of runs/elongated.toml, a few seconds' work."""
    mesh = load_mesh(ROOT / "meshes" / "elongated.vtp")
    problem = Problem(mesh)
    start = stable_point(problem, mesh, 1.0, SETTINGS)
    return Diagram(mesh, problem, tuple(explore(start, SETTINGS, Limits())))


def stable_point(
    problem: Problem, mesh: DiskMesh, load: float, settings: Settings
) -> BranchPoint:
    """The minimum a sweep would find, heading for higher loads."""
    x = mesh.x + np.outer(
        1e-3 * np.random.default_rng(1).standard_normal(mesh.n_v), [0, 0, 1]
    )
    found = newton.solve(problem, x, np.zeros(mesh.n_b), load)
    assert found.converged
    return first_point(problem, found.x[mesh.loop], load, settings)


def folding_branch() -> tuple[Problem, BranchPoint, Settings]:
    """A point of a branch that heads down to a fold: an oval across its own rest shape.

    Beyond a threshold a planar disk turns oval, one way as well as another; a rest shape
    2 % longer than wide makes that an imperfect pitchfork, whose other side ends in a fold.
    """
    points, triangles = shapes.disk_points(6)
    mesh = shapes.mesh_of(points * [1.02, 1.0], triangles)
    problem = Problem(mesh)
    settings = Settings(load_range=(1400.0, 2100.0), load_unit=2000.0)
    x = close_with_lengths(problem.loop, mesh.x[mesh.loop] * [0.6, 1.6, 1.0])
    assert x is not None
    for load in (1800.0, 1900.0, 2000.0):
        model = critical_point(loop_energy(problem, load), x)
    point = first_point(problem, model.x, load, settings)
    return problem, replace(point, direction=point.direction.reversed()), settings


def regular(visits: Sequence[Visit]) -> list[BranchPoint]:
    """The points that are not special ones."""
    return [visit.point for visit in visits if visit.special is None]
