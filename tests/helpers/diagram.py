"""The elongated film's diagram, explored once for all tests, and a branch that folds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from eulerplateau.branches import FilmFamily, film_point
from eulerplateau.branches.control import StepControl
from eulerplateau.branches.exploration import DiagramPoint, Limits, explore_from
from eulerplateau.branches.point import BranchPoint, first_point
from eulerplateau.branches.special import SpecialPoint
from eulerplateau.loop.lengths import close_with_lengths
from eulerplateau.mesh import read_disk
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.shape import Shape
from eulerplateau.mesh.waist import waist_path, waist_twist
from eulerplateau.solvers import Problem, solve
from tests.helpers import shapes
from tests.helpers.equilibria import critical_point, loop_energy, spanned

ROOT = Path(__file__).parents[2]
CONTROL = StepControl(window=(1.0, 3000.0), unit=3000.0)


@dataclass(frozen=True)
class Diagram:
    """What an exploration visited, with a few questions that tests ask of it."""

    mesh: Disk
    problem: Problem
    visits: tuple[DiagramPoint, ...]

    @property
    def specials(self) -> list[SpecialPoint]:
        """The special points by number."""
        return [v.special for v in self.visits if v.special is not None and not v.known]

    def branch(self, number: int) -> list[DiagramPoint]:
        return [visit for visit in self.visits if visit.branch == number]

    def from_special(self, number: int | None) -> list[list[DiagramPoint]]:
        """The branches that start from a special point, or the first one."""
        numbers = {visit.branch for visit in self.visits if visit.origin == number}
        return [self.branch(branch) for branch in sorted(numbers)]

    def shape(self, point: BranchPoint) -> Shape:
        """The whole film."""
        return spanned(self.problem, point.x)

    def energy(self, point: BranchPoint) -> float:
        shape = self.shape(point)
        film = self.problem.film.energy_gradient(shape, point.value)[0]
        return film + self.problem.bending_energy(shape)[0]

    def twist(self, point: BranchPoint) -> float:
        return waist_twist(waist_path(self.mesh), self.shape(point).x)


@cache
def elongated() -> Diagram:
    """The diagram of runs/elongated.toml, a few seconds' work."""
    mesh = read_disk(ROOT / "meshes" / "elongated.vtp")
    problem = Problem(mesh)
    start = stable_point(problem, 1.0, CONTROL)
    return Diagram(mesh, problem, tuple(explore_from(start, CONTROL, Limits())))


def stable_point(problem: Problem, load: float, control: StepControl) -> BranchPoint:
    """The minimum a sweep would find, heading for higher loads."""
    mesh = problem.disk
    x = mesh.x + np.outer(
        1e-3 * np.random.default_rng(1).standard_normal(mesh.n_v), [0, 0, 1]
    )
    found = solve(problem, load, x)
    assert found.converged
    return film_point(found, problem, control)


def folding_branch() -> tuple[Problem, BranchPoint, StepControl]:
    """A point of a branch that heads down to a fold: an oval across its own rest shape.

    Beyond a threshold a planar disk turns oval, one way as well as another; a rest shape
    2 % longer than wide makes that an imperfect pitchfork, whose other side ends in a fold.
    """
    points, triangles = shapes.disk_points(6)
    mesh = shapes.mesh_of(points * [1.02, 1.0], triangles)
    problem = Problem(mesh)
    control = StepControl(window=(1400.0, 2100.0), unit=2000.0)
    x = close_with_lengths(problem.loop, mesh.x[mesh.loop] * [0.6, 1.6, 1.0])
    assert x is not None
    for load in (1800.0, 1900.0, 2000.0):
        model = critical_point(loop_energy(problem, load), x)
    family = FilmFamily(problem, problem.film.of_loop(mesh.shape))
    point = first_point(family, model.x, load, control)
    return problem, replace(point, direction=point.direction.reversed()), control


def regular(visits: Sequence[DiagramPoint]) -> list[BranchPoint]:
    """The points that are not special ones."""
    return [visit.point for visit in visits if visit.special is None]
