"""What is recorded of branches in contact: nothing overlaps, at places or between them."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from eulerplateau.branches import (
    BranchPoint,
    StepControl,
    equilibrium,
    equilibrium_near,
    explore,
    film_point,
    point_near,
)
from eulerplateau.branches.conformal import splitting_load, thick_eight
from eulerplateau.branches.continuation import Place
from eulerplateau.branches.film_family import family_of, recorded
from eulerplateau.loop import strands_of
from eulerplateau.solvers import (
    RESIDUAL_TOLERANCE,
    Equilibrium,
    Problem,
    Status,
    solve,
)
from scripts.studies.contact_eight.on_meshes import eight_on, round_disk
from scripts.studies.contact_starts.brute_force import least_distance
from tests.branches.test_contact_branches import DIAMETER, loaded, lobes, places
from tests.helpers import shapes

# What may be left of an overlap, in diameters.
LEFT = 1e-5
# In line contact on all of these meshes.
LINE = 4300.0


def kept_apart(point: BranchPoint) -> BranchPoint:
    return recorded(point, point.direction)


def overlap(found: Equilibrium, problem: Problem) -> float:
    """By which part of the diameter strands overlap, by brute force over all places."""
    strands = strands_of(problem.loop)
    lengths = problem.loop.rest_lengths
    least = least_distance(found.shape.x_loop, lengths, strands.apart)
    return 1 - least / strands.diameter


def check_laws(point: BranchPoint) -> None:
    """Gaps and forces are not negative, and there is no force across a gap."""
    found, problem = equilibrium(point), family_of(point).at(point.value)[0]
    assert found.contacts is not None
    assert found.residual < RESIDUAL_TOLERANCE
    assert overlap(found, problem) < LEFT
    assert found.overlap < LEFT * DIAMETER
    assert (found.contacts.forces >= -found.contacts.uncertain).all()
    assert np.abs(found.contacts.gaps).max(initial=0.0) < 1e-11


def both_sides(found: list[Place]) -> list[BranchPoint]:
    """All points of a branch, with those on the other sides of its kinks."""
    points = [at.point for at in found]
    return points + [at.kink.before for at in found if at.kink is not None]


@pytest.mark.parametrize(
    ("edges", "shift", "until"),
    [
        (24, 0.3, 3600.0),
        pytest.param(24, 0.3, 3700.0, marks=pytest.mark.slow),
        pytest.param(24, 0.0, 5000.0, marks=pytest.mark.slow),
        pytest.param(48, 0.3, 5000.0, marks=pytest.mark.slow),
    ],
)
def test_no_gap_is_negative_anywhere(edges: int, shift: float, until: float) -> None:
    """Special points included."""
    for point in both_sides(loaded(edges, shift, until)):
        there = kept_apart(point)
        check_laws(there)
        assert equilibrium(there).residual < 1e-9
        assert there.stability.n_unstable == point.stability.n_unstable


def in_line(edges: int) -> BranchPoint:
    """The recorded point of a branch that is held along a line, a vertex at its middle."""
    point = next(at.point for at in loaded(edges, 0.0, LINE + 700) if at.point.value > LINE)
    return kept_apart(point)


@pytest.mark.slow
@pytest.mark.parametrize("edges", [24, 48])
def test_a_sweep_comes_to_the_film_that_is_recorded(edges: int) -> None:
    """Up to what a sweep may leave of overlaps, times the force: that is dE/dd."""
    there = in_line(edges)
    found, problem = equilibrium(there), family_of(there).problem
    assert found.contacts is not None
    swept = solve(problem, there.value, found)
    assert swept.contacts is not None
    left = LEFT * DIAMETER * found.contacts.force
    assert swept.energy == pytest.approx(found.energy, abs=left)
    assert swept.contacts.force == pytest.approx(found.contacts.force, rel=1e-3)
    again = equilibrium_near(problem, found.shape, there.value)
    assert again.energy == pytest.approx(found.energy, rel=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize("edges", [24, 48])
def test_energy_rises_with_the_load_by_the_area(edges: int) -> None:
    """By Simpson's rule between two recorded points near each other, along a line."""
    there = in_line(edges)
    ends = [at_value(there, there.value + step) for step in (-2.0, 0.0, 2.0)]
    areas = [end.film_energy / end.load for end in ends]
    work = float(np.dot([1, 4, 1], areas)) / 6 * 4.0
    assert ends[2].energy - ends[0].energy == pytest.approx(work, rel=1e-9)


def at_value(there: BranchPoint, value: float) -> Equilibrium:
    """The film at another value of the parameter, kept apart everywhere."""
    near = point_near(there.family, there.x, value)
    assert near is not None
    return equilibrium(recorded(near, replace(near.direction, displacement=0 * near.x)))


@pytest.mark.slow
@pytest.mark.parametrize("edges", [24, 48])
def test_energy_rises_with_the_diameter_by_the_force(edges: int) -> None:
    there = in_line(edges)
    found, problem = equilibrium(there), family_of(there).problem
    control = StepControl((0.04, 0.06), unit=0.06)
    start, step = film_point(found, problem, control, "diameter"), 1e-5
    lower, upper = (at_value(start, DIAMETER + off) for off in (-step, step))
    assert found.contacts is not None
    slope = (upper.energy - lower.energy) / (2 * step)
    assert found.contacts.force == pytest.approx(slope, rel=1e-5)


@pytest.mark.slow
def test_saddles_of_an_exploration_are_recorded_without_overlaps() -> None:
    """Planar lobes in space, which twist: what is converged keeps to the laws."""
    window, start = (3700.0, 4250.0), lobes(shapes.fan(60), 1850.0, 0.0, in_plane=False)
    up = (at.point for at in places(start, 30))
    first = next(point for point in up if point.value > window[0])
    problem = Problem(shapes.fan(60), "area", diameter=DIAMETER)
    found = list(explore(problem, window, equilibrium(kept_apart(first)), special_points=0))
    assert [point.special.contact for point in found if point.special] == ["splits"]
    for point in found:
        there = point.equilibrium
        assert problem.classified(there).status is Status.CONVERGED
        assert there.n_unstable == 1
        assert overlap(there, point.problem) < LEFT
        assert there.load == point.load


@pytest.mark.slow
def test_an_eight_that_touches_at_a_point_is_stable_until_that_splits() -> None:
    """Held where it was, a point of contact lets strands rock: a mode that is none."""
    film, exact = thick_eight(3800.0, DIAMETER), splitting_load(DIAMETER)
    assert exact is not None
    mesh = round_disk(60)
    control = StepControl((3000.0, 4800.0), unit=4800.0)
    problem = Problem(mesh, "area", diameter=DIAMETER)
    start = film_point(eight_on(mesh, film, 0.3), problem, control)
    for at in places(start, 12, replace(control, largest_step=0.04, first_step=0.02)):
        there = kept_apart(at.point)
        assert equilibrium(there).n_unstable == 0
        assert overlap(equilibrium(there), problem) < LEFT
        if at.kink is not None and at.kink.what == "splits":
            break
    else:
        raise AssertionError("its contact has not split")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("diameter", "start", "edges"),
    [(0.05, 3900.0, 60), (0.05, 4000.0, 120), (0.02, 4200.0, 60)],
)
def test_the_eight_goes_on_beyond_its_split_as_a_minimum(
    diameter: float, start: float, edges: int
) -> None:
    """As that without a mesh is one before; sweeps, which go downhill, come to it too."""
    mesh = round_disk(edges)
    exact = thick_eight(start, diameter)
    assert exact.n_unstable == 0
    problem = Problem(mesh, "area", diameter=diameter, refine=False)
    control = StepControl((3000.0, 6000.0), unit=6000.0, first_step=0.02, largest_step=0.04)
    first = film_point(eight_on(mesh, exact), problem, control)
    found = list(places(first, 16, control))
    happens = [at.kink.what for at in found if at.kink is not None]
    assert happens == ["splits"]
    beyond = found[next(k for k, at in enumerate(found) if at.kink is not None) :]
    points = [kept_apart(at.point) for at in beyond]
    loads = [point.value for point in points]
    assert len(points) > 10
    assert (np.diff(loads) > 0).all()
    assert loads[-1] > loads[0] + 300
    for point in points:
        check_laws(point)
        assert point.stability.n_unstable == 0
    # The area is dE/dload, and falls.
    films = [equilibrium(point) for point in points]
    for film, after in pairwise(films):
        most, least = (at.film_energy / at.load for at in (film, after))
        mean = (after.energy - film.energy) / (after.load - film.load)
        assert least < mean < most
    half = films[len(films) // 2]
    swept = solve(problem, half.load, half)
    assert half.contacts is not None
    left = LEFT * diameter * half.contacts.force
    assert swept.energy == pytest.approx(half.energy, abs=left)


@pytest.mark.slow
def test_beyond_its_split_the_eight_s_energy_is_of_second_order() -> None:
    """By meshes of which each has half of the edge length of that before it."""
    exact, load = thick_eight(3900.0, DIAMETER), 4600.0
    control = StepControl((3000.0, 7000.0), unit=7000.0, first_step=0.04, largest_step=0.04)
    found = []
    for edges in (30, 60, 120):
        mesh = round_disk(edges)
        problem = Problem(mesh, "area", diameter=DIAMETER, refine=False)
        start = film_point(eight_on(mesh, exact), problem, control)
        above = next(at.point for at in places(start, 8, control) if at.point.value > load)
        film = at_value(above, load)
        assert film.n_unstable == 0
        assert film.contacts is not None
        assert len(film.contacts) > 1
        found.append((film.energy, film.film_energy))
    coarse, fine = np.abs(np.diff(found, axis=0))
    np.testing.assert_allclose(np.log2(coarse / fine), 2.0, atol=0.15)
