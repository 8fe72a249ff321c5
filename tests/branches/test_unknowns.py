"""What unknowns a loop has is the family's affair: others lead to the same diagram."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import (
    DiagramPoint,
    Family,
    FilmFamily,
    Limits,
    StepControl,
    UnboundedFamily,
    explore_from,
    first_point,
)
from eulerplateau.branches.film_family import family_near
from eulerplateau.loop import Constraint, LoopEnergy, Term
from eulerplateau.solvers import Problem, TangentModel, solve
from tests.helpers import shapes

WINDOW = 800.0, 950.0


def full(matrix: FloatArray, n: int) -> FloatArray:
    """Return the matrix of a term (n, n) or (3 n, 3 n) for all coordinates."""
    return np.kron(matrix, np.eye(3)) if len(matrix) == n else matrix


@dataclass(frozen=True)
class InColumn(Term):
    """A term of loops (n, 3) as one of their coordinates scaled, y = x / 2 (3 n, 1)."""

    term: Term

    @property
    def rounding(self) -> float:
        return self.term.rounding

    def force(self, y: FloatArray) -> FloatArray:
        return 2 * self.term.force(2 * y.reshape(-1, 3)).reshape(-1, 1)

    def hessian(self, y: FloatArray) -> FloatArray:
        x = 2 * y.reshape(-1, 3)
        return 4 * full(self.term.hessian(x), len(x))

    def rate(self, parameter: str, y: FloatArray) -> FloatArray | None:
        rate = self.term.rate(parameter, 2 * y.reshape(-1, 3))
        return None if rate is None else 2 * rate.reshape(-1, 1)


@dataclass(frozen=True)
class ConstraintInColumn:
    constraint: Constraint

    def jacobian(self, y: FloatArray) -> FloatArray:
        return 2 * self.constraint.jacobian(2 * y.reshape(-1, 3))

    def force(self, y: FloatArray, tensions: FloatArray) -> FloatArray:
        return 2 * self.constraint.force(2 * y.reshape(-1, 3), tensions).reshape(-1, 1)

    def stiffness(self, y: FloatArray, tensions: FloatArray) -> FloatArray:
        x = 2 * y.reshape(-1, 3)
        return 4 * full(self.constraint.stiffness(x, tensions), len(x))

    def project(self, y: FloatArray) -> FloatArray | None:
        x = self.constraint.project(2 * y.reshape(-1, 3))
        return None if x is None else x.reshape(-1, 1) / 2

    def turns(self, y: FloatArray) -> None:
        return None

    def split_stiffness(
        self, x: FloatArray, tensions: FloatArray
    ) -> tuple[FloatArray | None, FloatArray]:
        raise AssertionError("it has no turns")


@dataclass(frozen=True)
class FamilyInColumn(UnboundedFamily):
    family: FilmFamily

    @property
    def parameter(self) -> str:
        return self.family.parameter

    def energy(self, value: float) -> LoopEnergy:
        own = self.family.energy(value)
        return LoopEnergy(
            {name: InColumn(term) for name, term in own.terms.items()},
            ConstraintInColumn(own.constraint),
            4 * np.repeat(own.weights, 3),
            lambda y: own.free_motions(2 * y.reshape(-1, 3)) / 2,
        )

    def with_value(self, parameter: str, value: float) -> Family:
        return FamilyInColumn(self.family.with_value(parameter, value))

    def positions(self, y: FloatArray) -> FloatArray:
        return 2 * y.reshape(-1, 3)

    def near(self, y: FloatArray) -> Family:
        return self

    def rests(self, model: TangentModel, value: float) -> bool:
        return True

    def released(self, y: FloatArray) -> Family:
        return self

    def kept(self, y: FloatArray) -> Mapping[str, Any]:
        return {}

    def restored(self, kept: Mapping[str, Any]) -> Family:
        return self


def explored(family: Family, x: FloatArray) -> list[DiagramPoint]:
    control = StepControl(WINDOW, WINDOW[1])
    start = first_point(family, x, WINDOW[0], control)
    return list(explore_from(start, control, Limits(special_points=1)))


@pytest.mark.slow
def test_a_diagram_in_other_unknowns_is_the_same() -> None:
    points, triangles = shapes.disk_points(3)
    problem = Problem(shapes.mesh_of(points * [1.6, 1.0], triangles), "springs")
    found = solve(problem, WINDOW[0])
    family, x = family_near(problem, found.shape)
    plain = explored(family, x)
    other = explored(FamilyInColumn(family), x.reshape(-1, 1) / 2)
    specials = [[p for p in way if p.special is not None] for way in (plain, other)]
    assert len(specials[0]) > 0
    for one, two in zip(*specials, strict=True):
        assert one.special is not None
        assert two.special is not None
        assert two.special.kind == one.special.kind
        assert two.special.breaks == one.special.breaks
        assert two.special.symmetry.keeps == one.special.symmetry.keeps
        assert two.point.value == pytest.approx(one.point.value, rel=1e-8)
        assert (two.number, two.known) == (one.number, one.known)
    branches = [{p.branch: p.point.value for p in way} for way in (plain, other)]
    assert branches[1] == pytest.approx(branches[0], rel=1e-6)
