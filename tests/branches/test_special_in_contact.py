"""Folds and bifurcations of films whose strands lie along each other.

Two flat lobes in line contact are a saddle in space: they twist. What holds them flat is
the rod's resistance to twist, C/B. Below a critical one their branch in the link is an S.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache, partial
from math import pi
from typing import NamedTuple

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import (
    BranchPoint,
    SpecialPoint,
    StepControl,
    equilibrium,
    film_point,
    point_near,
)
from eulerplateau.branches.continuation import Place, next_place
from eulerplateau.branches.control import Hyperplane
from eulerplateau.branches.film_family import FilmFamily, family_of, recorded
from eulerplateau.branches.kinks import kink_between
from eulerplateau.branches.point import across_values, first_point
from eulerplateau.branches.special import BIFURCATION, FOLD, leaps, special_points
from eulerplateau.loop import Twist
from eulerplateau.mesh import Disk
from eulerplateau.solvers import Equilibrium, Problem, Status, solve
from tests.branches.test_contact_branches import CONTROL, lobes, places
from tests.branches.test_recorded_contact import LEFT, check_laws
from tests.helpers import shapes

RATIO = StepControl((0.0, 1.0), unit=1.0, first_step=0.01, largest_step=0.04)
LINK = StepControl((-1.0, 1.0), unit=1.0, first_step=5e-3, largest_step=0.02, least=-np.inf)
# C/B to begin with, and that of a rod that is turned, in parts of the critical one.
FIRST, SOFT = 0.02, 0.8
Found = tuple[SpecialPoint, BranchPoint, BranchPoint]


class Lobes(NamedTuple):
    """Flat lobes that do not touch yet, and a load at which they lie along each other."""

    film: str
    diameter: float
    load: float
    disk: Disk
    start: BranchPoint


@cache
def made(film: str) -> Lobes:
    points, triangles = shapes.disk_points(5)
    if film == "area":
        disk = shapes.mesh_of(points, triangles)
        start = lobes(disk, 1500.0, 0.0, in_plane=False)
        return Lobes(film, 0.05, 4300.0, disk, start)
    disk = shapes.mesh_of(points * [4.0, 1.0], triangles)
    problem = Problem(disk, film, diameter=0.08)
    start = film_point(solve(problem, 800.0, disk.x), problem, CONTROL)
    return Lobes(film, 0.08, 4300.0, disk, start)


def problem_of(film: str, twist_ratio: float) -> Problem:
    lobes = made(film)
    return Problem(lobes.disk, film, twist_ratio=twist_ratio, diameter=lobes.diameter)


@cache
def flat(film: str) -> Equilibrium:
    """The lobes in space, along each other."""
    happened = set()
    for at in places(made(film).start, 30):
        happened.add(None if at.kink is None else at.kink.what)
        if at.point.value > made(film).load:
            assert happened >= {"touches", "splits"}
            found = equilibrium(recorded(at.point, across_values(at.point.x, 1.0)))
            # Its edges turn by more than is fine.
            assert found.status in (Status.CONVERGED, Status.UNRESOLVED)
            return found
    raise AssertionError("the branch has ended")


def first_special(start: BranchPoint, control: StepControl) -> Found:
    """The first special point on the way from a point, that before it, and that after."""
    place: Place | None = Place(start, control.first_step, 40)
    while place is not None:
        before, leaping = place.point, partial(leaps, control=control)
        place = next_place(place, control, leaping, kink_between)
        for special in () if place is None else special_points(before, place.end, control):
            assert place is not None
            return special, before, place.point
    raise AssertionError("nothing is special")


def next_to(family: FilmFamily, x: FloatArray, value: float) -> BranchPoint:
    """The film of a family, made near one shape, at a value, without overlaps."""
    near = point_near(family, x, value, -np.inf)
    assert near is not None
    plane = Hyperplane(near.x, value, across_values(near.x, 1.0), LINK)
    there = family.settled(near, plane)
    assert there is not None
    return there


def back(point: BranchPoint) -> BranchPoint:
    return replace(point, direction=point.direction.reversed())


def twist_of(point: BranchPoint) -> Twist:
    twist = family_of(point).at(point.value)[0].loop.terms["twist"]
    assert isinstance(twist, Twist)
    return twist


def unstable(found: Found) -> tuple[int, int]:
    return found[1].stability.n_unstable, found[2].stability.n_unstable


@cache
def critical(film: str) -> Found:
    """The C/B below which they twist."""
    return first_special(
        film_point(flat(film), problem_of(film, FIRST), RATIO, "twist_ratio"), RATIO
    )


FILMS = pytest.mark.parametrize(
    "film", ["dirichlet", pytest.param("area", marks=pytest.mark.slow)]
)


@FILMS
def test_lobes_are_held_flat_by_as_much_twist_as_the_rest_bears_out(film: str) -> None:
    """Not turned, they have the curvature H + 8 pi^2 C/B w w^T, w the writhe's slope."""
    start = film_point(flat(film), problem_of(film, FIRST), RATIO, "twist_ratio")
    model = start.model
    slope = model.slope(twist_of(start).slope(start.x))
    held = FIRST - 1 / (8 * pi**2 * (slope @ np.linalg.solve(model.hessian, slope)))
    special, _, after = found = critical(film)
    assert special.kind == BIFURCATION
    assert unstable(found) == (1, 0)
    assert special.point.value == pytest.approx(held, rel=1e-9)
    assert len(special.point.model.tensions) > len(start.x) + 1
    check_laws(special.point)
    other, _, _ = first_special(back(after), RATIO)
    assert other.point.value == pytest.approx(held, rel=1e-9)


@FILMS
@pytest.mark.parametrize("step", [-20.0, 20.0])
def test_the_same_bifurcation_is_met_along_the_load(film: str, step: float) -> None:
    """By the film that it was met in, from below and from above."""
    special = critical(film)[0].point
    family = family_of(special)
    rod, load = family.at(special.value)
    loaded = replace(family, problem=rod, parameter="load", load=0.0)
    near = next_to(loaded, special.x, load + step)
    start = first_point(near.family, near.x, near.value, CONTROL)
    start = start if step < 0 else back(start)
    found = first_special(start, replace(CONTROL, first_step=4e-3))
    assert found[0].kind == BIFURCATION
    assert sorted(unstable(found)) == [0, 1]
    assert found[0].point.value == pytest.approx(load, rel=1e-9)


@FILMS
@pytest.mark.parametrize("part", [0.9, 1.1])
def test_a_descent_leaves_the_flat_film_below_and_comes_back_above(
    film: str, part: float
) -> None:
    special, start = critical(film)[0], flat(film)
    moved = family_of(special.point).film.displacement(special.point.x, special.mode)
    off = start.shape.moved(start.shape.x + 1e-3 * moved / np.abs(moved).max())
    found = solve(problem_of(film, part * special.point.value), start.load, off)
    assert found.n_unstable == 0
    tall = np.ptp(found.shape.x_loop[:, 2])
    assert start.contacts is not None
    # By so much a sweep's film may be lower than it is without overlaps.
    left = LEFT * made(film).diameter * start.contacts.force
    if part > 1:
        assert tall < 1e-6
        assert found.energy == pytest.approx(start.energy, abs=left)
    else:
        assert tall > 1e-3
        assert found.energy < start.energy - left


@cache
def turned(film: str) -> Found:
    """The fold on the way of a softer rod that is turned."""
    rod = problem_of(film, SOFT * critical(film)[0].point.value)
    return first_special(film_point(flat(film), rod, LINK, "link"), LINK)


@pytest.mark.slow
@pytest.mark.parametrize("film", ["dirichlet", "area"])
def test_a_fold_is_met_from_both_sides(film: str) -> None:
    special, before, after = found = turned(film)
    assert special.kind == FOLD
    assert unstable(found) == (1, 0)
    assert abs(special.eigenvalue) < 1e-10 * before.stability.eigenvalues[1]
    assert abs(special.point.direction.rate) < 1e-9
    assert len(special.point.model.tensions) > len(before.x) + 1
    check_laws(special.point)
    other, _, _ = first_special(back(after), LINK)
    assert other.kind == FOLD
    assert other.point.value == pytest.approx(special.point.value, rel=1e-8)


@pytest.mark.parametrize(
    ("film", "precise"),
    [("dirichlet", 1e-9), pytest.param("area", 2e-6, marks=pytest.mark.slow)],
)
def test_the_fold_is_where_a_stiffer_rod_s_film_is_turned_most(
    film: str, precise: float
) -> None:
    """Its films are minima, of the softer one turned by Lk = Wr + M / (2 pi C/B) too.

    Of a curved film of true area the second variation has an error of the mesh.
    """
    fold = turned(film)[0].point
    soft, stiff = twist_of(fold), family_of(fold).with_value("twist_ratio", 1.0)

    def turn(link: float) -> float:
        """By which the softer rod is turned to be the film of the other."""
        there = next_to(stiff, fold.x, link)
        assert there.stability.n_unstable == 0
        writhe = twist_of(there).writhe(there.x)
        return writhe + (link - writhe) / soft.ratio

    writhe = soft.writhe(fold.x)
    there = writhe + (fold.value - writhe) * soft.ratio
    bracket = (there - 5e-3, there + 1e-3, there + 5e-3)
    most = minimize_scalar(lambda link: -turn(link), bracket=bracket)
    assert -most.fun == pytest.approx(fold.value, rel=precise)


def beside_fold(film: str, by: float) -> list[BranchPoint]:
    """The saddle and the minimum at a link so much below the fold.

    The link falls with the square of the arclength from there.
    """
    special, _, after = turned(film)
    fold = special.point
    curved = (fold.value - after.value) / (after.arclength - fold.arclength) ** 2
    move = np.sqrt(by / curved) * fold.direction.displacement
    family, value = family_of(fold), fold.value - by
    return [next_to(family, fold.x + way * move, value) for way in (-1, 1)]


def test_both_films_meet_in_a_cusp_at_the_fold() -> None:
    """Eigenvalues go with the root of the distance, the energies' difference with its cube.

    And both have the slope 2 pi M there.
    """
    film = "dirichlet"
    fold = turned(film)[0].point
    sizes = np.array([1e-5, 2e-5, 4e-5, 8e-5])
    pairs = [beside_fold(film, size) for size in sizes]
    energies = np.array([[equilibrium(at).energy for at in pair] for pair in pairs])
    modes = np.array([[at.stability.lowest for at in pair] for pair in pairs])
    assert (modes[:, 0] < 0).all()
    assert (modes[:, 1] > 0).all()
    more = energies[:, 0] - energies[:, 1]
    assert shapes.fitted_order(list(sizes), list(more)) == pytest.approx(1.5, abs=0.02)
    for sign, values in zip((-1, 1), modes.T, strict=True):
        order = shapes.fitted_order(list(sizes), list(sign * values))
        assert order == pytest.approx(0.5, abs=0.05)
    # The mean has no cusp: what its slope is off by goes with the distance.
    slopes = (equilibrium(fold).energy - energies.mean(axis=1)) / sizes
    off = np.abs(slopes - 2 * pi * twist_of(fold).moment(fold.x))
    assert shapes.fitted_order(list(sizes), list(off)) == pytest.approx(1.0, abs=0.1)
