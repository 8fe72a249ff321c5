"""The whole diagram of the elongated film: what hangs together, and what is stable."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.control import StepControl
from eulerplateau.branches.exploration import (
    DiagramPoint,
    Limits,
    explore_from,
    explore_on,
)
from eulerplateau.branches.point import BranchPoint
from eulerplateau.branches.progress import KeptPoint, Lead, Progress
from eulerplateau.branches.special import SpecialPoint
from eulerplateau.loop.motions import rigid_motions
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.shape import Shape
from eulerplateau.solvers import Problem
from tests.helpers import diagram, shapes
from tests.helpers.diagram import CONTROL, Diagram


@pytest.fixture(scope="module")
def found() -> Diagram:
    return diagram.elongated()


@pytest.fixture(scope="module")
def points(found: Diagram) -> tuple[SpecialPoint, ...]:
    """Twist, end of the twist, bending of the eight: where states replace each other."""
    twist = next(visit for visit in found.branch(0) if visit.special)
    untwist = found.from_special(twist.number)[0][-1]
    eights = found.from_special(untwist.number)
    bend = next(visit for branch in eights for visit in branch if visit.special)
    return tuple(visit.special for visit in (twist, untwist, bend) if visit.special)


def thickness(point: BranchPoint) -> float:
    centred = point.x - point.x.mean(axis=0)
    return float(np.linalg.svd(centred, compute_uv=False)[2])


def index(point: BranchPoint) -> int:
    return point.stability.n_unstable


def test_planar_branch_is_stable_up_to_the_twist(
    found: Diagram, points: tuple[SpecialPoint, ...]
) -> None:
    twist = points[0].point.value
    for point in diagram.regular(found.branch(0)):
        assert thickness(point) < 1e-9
        assert (index(point) == 0) == (point.value < twist)


def test_twisted_branch_runs_from_the_plane_to_the_eight_on_both_sides(
    found: Diagram, points: tuple[SpecialPoint, ...]
) -> None:
    twist, untwist, _ = points
    sides = found.from_special(0)
    assert len(sides) == 2
    ends = [side[-1] for side in sides]
    assert ends[0].number == ends[1].number
    assert [end.known for end in ends] == [False, True]
    for side, sign in zip(sides, (1, -1), strict=True):
        regular = diagram.regular(side)
        twists = [sign * found.twist(point) for point in regular]
        turned = np.sign(twists[0])
        assert all(0 < turned * angle < 180 for angle in twists)
        assert sorted(twists, key=abs) == twists
        assert all(index(point) == 0 for point in regular)
        loads = [point.value for point in regular]
        assert min(loads) > twist.point.value
        assert max(loads) < untwist.point.value


def test_eight_is_stable_between_the_twist_and_the_bend(
    found: Diagram, points: tuple[SpecialPoint, ...]
) -> None:
    """A planar film with half a turn, at all loads; its window is the paper's."""
    _, untwist, bend = points
    down, up = sorted(
        found.from_special(number_of(found, untwist)), key=lambda b: b[0].point.value
    )
    assert down[-1].point.value < 5.0
    assert up[-1].point.value > 3000.0
    for point in diagram.regular(down + up):
        assert thickness(point) < 1e-9
        assert abs(found.twist(point)) == pytest.approx(180.0, abs=1e-6)
        inside = untwist.point.value < point.value < bend.point.value
        assert index(point) == (0 if inside else 1)


def number_of(found: Diagram, special: SpecialPoint) -> int | None:
    return next(visit.number for visit in found.visits if visit.special is special)


def test_branch_that_leaves_the_eight_is_stable_and_bent(
    found: Diagram, points: tuple[SpecialPoint, ...]
) -> None:
    bend = points[2]
    sides = found.from_special(number_of(found, bend))
    assert len(sides) == 2
    for side in sides:
        regular = diagram.regular(side)
        assert all(index(point) == 0 for point in regular)
        assert all(point.value > bend.point.value for point in regular)
        assert all(thickness(point) > 0.01 for point in regular)


def test_index_changes_only_at_special_points(found: Diagram) -> None:
    for number in {visit.branch for visit in found.visits}:
        for before, after in pairwise(found.branch(number)):
            if before.special is None and after.special is None:
                assert index(before.point) == index(after.point)


def test_numbers_count_the_special_points(found: Diagram) -> None:
    """In the order in which they are found; each again by its own number."""
    new = [visit.number for visit in found.visits if visit.special and not visit.known]
    assert new == list(range(len(new)))
    for visit in found.visits:
        if visit.known:
            assert visit.number is not None
            first = found.specials[visit.number]
            assert visit.point.value == pytest.approx(first.point.value, rel=1e-8)


def test_branches_start_from_special_points_found_before(found: Diagram) -> None:
    seen: set[int] = set()
    for visit in found.visits:
        assert visit.origin is None or visit.origin in seen
        if visit.number is not None:
            seen.add(visit.number)


def test_arclength_rises_along_each_branch(found: Diagram) -> None:
    for number in {visit.branch for visit in found.visits}:
        lengths = [visit.point.arclength for visit in found.branch(number)]
        assert lengths == sorted(set(lengths))


def short(limits: Limits) -> Iterator[DiagramPoint]:
    """Explore an oval film about where it gives way in one way, and in another."""
    points, triangles = shapes.disk_points(4, jitter=0.2)
    problem = Problem(shapes.mesh_of(points * [1.5, 1.0], triangles))
    control = replace(CONTROL, window=(780.0, 920.0))
    start = diagram.stable_point(problem, 790.0, control)
    return explore_from(start, control, limits)


@pytest.mark.parametrize(("allowed", "branches"), [(0, 1), (1, 3), (2, 5)])
def test_limit_on_special_points_is_kept(allowed: int, branches: int) -> None:
    visits = list(short(Limits(special_points=allowed)))
    assert len({visit.branch for visit in visits}) == branches
    assert {visit.origin for visit in visits} <= {None, *range(allowed)}


def test_limit_on_unstable_modes_is_kept() -> None:
    """A branch is left at its first point beyond the limit."""
    visits = list(short(Limits(special_points=0, unstable_modes=0)))
    indices = [index(visit.point) for visit in visits if visit.special is None]
    assert indices == [0] * (len(indices) - 1) + [1]
    assert max(visit.point.value for visit in visits) < 920.0


def test_predicate_ends_each_branch() -> None:
    limits = Limits(special_points=1, stop=lambda point: point.value > 850.0)
    visits = list(short(limits))
    for number in {visit.branch for visit in visits}:
        loads = [v.point.value for v in visits if v.branch == number and v.special is None]
        assert [load > 850.0 for load in loads] == [False] * (len(loads) - 1) + [True]


def test_index_agrees_with_a_dense_count_on_the_whole_mesh(found: Diagram) -> None:
    """All 3 n_v coordinates, the kernels' Hessian, the constraint's own gradients.

    The film's interior adds positive curvature only, so that eliminating it keeps the
    number of negative directions.
    """
    checked = {}
    for visit in found.visits:
        if visit.special is None:
            checked[visit.branch // 2, index(visit.point)] = visit.point
    assert {n for _, n in checked} == {0, 1, 2}
    problem, mesh = found.problem, found.mesh
    film = columns_of(lambda shape: problem.film.energy_gradient(shape, 1.0)[1], mesh)
    rod = columns_of(lambda shape: problem.bending_energy(shape)[1], mesh)
    for (_, expected), point in checked.items():
        tension = columns_of(partial(tension_force, problem, point.model.tensions), mesh)
        hessian = point.value * film + rod + tension
        # The count is not decided by rounding.
        doubt = 1e-9 * float(np.linalg.norm(hessian, np.inf))
        counted = negative_directions(found, point, hessian, (-doubt, doubt))
        assert counted == [expected, expected]


def tension_force(problem: Problem, tensions: FloatArray, shape: Shape) -> FloatArray:
    return problem.tension_force(shape, tensions)


def negative_directions(
    found: Diagram, point: BranchPoint, hessian: FloatArray, shifts: tuple[float, ...]
) -> list[int]:
    """How many H (x) I_3 has, H (n_v, n_v) shifted, that keep lengths and are not rigid.

    With R the gradients of all these, [[H, R^T], [R, 0]] has one besides for each row of R
    by Sylvester's law of inertia; and it has as many as H and -R H^-1 R^T together.
    """
    x, n = found.shape(point).x, found.mesh.n_v
    rows = np.vstack([length_rows(found, x), rigid_motions(x).T])
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    assert np.linalg.matrix_rank(rows) == len(rows) == found.mesh.n_b + 6
    # Stiffer along translations, which are among the rows: else H would be singular.
    values, vectors = np.linalg.eigh(hessian + np.abs(hessian).max())
    along = rows.reshape(-1, n, 3).transpose(1, 0, 2).reshape(n, -1)
    parts = (vectors.T @ along).reshape(n, -1, 3).transpose(1, 0, 2).reshape(len(rows), -1)
    counted = []
    for shift in shifts:
        complement = (parts / np.repeat(values + shift, 3)) @ parts.T
        beside = np.linalg.eigvalsh(0.5 * (complement + complement.T))
        negative = 3 * (values + shift < 0).sum() + (beside > 0).sum() - len(rows)
        counted.append(int(negative))
    return counted


def columns_of(force: Callable[[Shape], FloatArray], mesh: Disk) -> FloatArray:
    """Hessian (n_v, n_v) of a quadratic energy, the same for all three coordinates.

    The gradient at a unit vector is a column of it.
    """
    hessian = np.empty((mesh.n_v, mesh.n_v))
    for v, row in enumerate(np.eye(mesh.n_v)):
        hessian[:, v] = force(mesh.shape.moved(np.outer(row, [0.0, 0.0, 1.0])))[:, 2]
    return hessian


def length_rows(found: Diagram, x: FloatArray) -> FloatArray:
    """Gradients (n_b, 3 n_v) of the squared lengths of the loop's edges."""
    loop = found.mesh.loop
    rows = np.zeros((len(loop), *x.shape))
    for row, (v, w) in zip(rows, zip(loop, np.roll(loop, -1), strict=True), strict=True):
        row[v], row[w] = x[v] - x[w], x[w] - x[v]
    return rows.reshape(len(loop), -1)


@pytest.mark.parametrize(("elsewhere", "known"), [(False, True), (True, False)])
def test_special_points_of_one_load_are_told_apart_by_their_loops(
    elsewhere: bool, known: bool
) -> None:
    """As on two branches that are mirror images of each other."""
    problem = Problem(shapes.mesh_of(*shapes.hexagon_points(4)))
    control = StepControl(window=(830.0, 845.0), unit=900.0)
    start = diagram.stable_point(problem, 830.0, control)
    lead = Lead(0, 0, KeptPoint.of(start), None)
    limits = Limits(special_points=0)
    onset = next(
        visit.special
        for visit in explore_on(Progress((lead,), order=1), control, limits)
        if visit.special is not None
    )
    x = onset.point.x + shapes.wave(len(onset.point.x), 0.01) * elsewhere
    progress = Progress((lead,), met=((x, onset.point.value),), order=1)
    again = next(
        visit
        for visit in explore_on(progress, control, limits)
        if visit.special is not None
    )
    assert again.known is known
    assert again.number == int(not known)
