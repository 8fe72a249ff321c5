"""Branches of loops with a diameter: strands touch, part, and lie along each other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache, partial

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import (
    BranchPoint,
    StepControl,
    equilibrium,
    explore,
    film_point,
    point_near,
)
from eulerplateau.branches.conformal import opening_load, splitting_load, thick_eight
from eulerplateau.branches.continuation import Kink, Place, advance, next_place
from eulerplateau.branches.film_family import recorded
from eulerplateau.branches.kinks import kink_between, margins
from eulerplateau.branches.point import across_values
from eulerplateau.exact.planar import planar_film, thresholds
from eulerplateau.mesh import Disk
from eulerplateau.solvers import Equilibrium, Problem, solve
from scripts.studies.contact_eight.on_meshes import eight_on, round_disk
from tests.helpers import shapes

DIAMETER = 0.05
CONTROL = StepControl((1500.0, 7000.0), unit=7000.0, first_step=0.02, largest_step=0.04)


def lobes(mesh: Disk, load: float, shift: float, in_plane: bool = True) -> BranchPoint:
    """Two lobes that do not touch, the mesh shifted along them by parts of an edge."""
    tied = Problem(mesh).tied_film()
    assert tied is not None
    flat = planar_film(2, load).positions((np.arange(mesh.n_b) + shift) / mesh.n_b)
    problem = Problem(mesh, "area", in_plane=in_plane, diameter=DIAMETER)
    found = solve(problem, load, tied.shape(np.pad(flat, ((0, 0), (0, 1)))))
    assert found.n_unstable == 0
    return film_point(found, problem, CONTROL)


def places(
    start: BranchPoint, most: int, control: StepControl = CONTROL
) -> Iterator[Place]:
    """The places after a point, up to so many."""
    place: Place | None = Place(start, control.first_step, most)
    while (
        place is not None
        and (place := next_place(place, control, kinks=kink_between)) is not None
    ):
        yield place


@cache
def loaded(edges: int, shift: float, until: float) -> list[Place]:
    """The branch of two lobes, from free ones to those along a line."""
    found = []
    for place in places(lobes(shapes.fan(edges), 1850.0, shift), 200):
        found.append(place)
        if place.point.value > until:
            return found
    raise AssertionError("the branch has ended")


def kinks(found: list[Place], what: str) -> list[Kink]:
    return [at.kink for at in found if at.kink is not None and at.kink.what == what]


def load_of(found: list[Place], what: str) -> float:
    (kink,) = kinks(found, what)
    return kink.before.value


def forces(point: BranchPoint) -> FloatArray:
    return -point.model.tensions[len(point.x) :]


# A vertex lies at the contact, so that nothing depends on how it came to be.
QUICK = partial(loaded, 24, 0.0, 3600.0)


def test_strands_touch_then_lie_along_each_other() -> None:
    happens = [at.kink.what for at in QUICK() if at.kink is not None and at.kink.what]
    assert happens == ["touches", "splits"]
    touch = kinks(QUICK(), "touches")[0]
    assert len(forces(touch.before)) == 0
    assert abs(forces(touch.after)).max() < 1e-8
    assert equilibrium(touch.before).energy == pytest.approx(
        equilibrium(touch.after).energy, rel=1e-12
    )


def test_nothing_pulls_or_overlaps_and_forces_balance() -> None:
    for place in QUICK():
        found = equilibrium(place.point)
        assert found.residual < 1e-9
        assert found.contacts is not None
        assert (found.contacts.forces > -1e-6).all()
        assert (margins(place.point) > -1e-9).all()


def test_a_descent_comes_to_the_same_film() -> None:
    """In one point of contact, from the point before it."""
    points = [place.point for place in QUICK() if len(forces(place.point)) == 1]
    problem = Problem(shapes.fan(24), "area", in_plane=True, diameter=DIAMETER)
    found = solve(problem, points[2].value, equilibrium(points[1]))
    assert found.residual < 1e-9
    assert found.n_unstable == 0
    assert found.energy == pytest.approx(energy(points[2]), rel=1e-9)


@pytest.mark.slow
def test_energy_rises_with_the_load_by_the_area_across_kinks() -> None:
    """By Simpson's rule from point to point: a smooth piece, then the next.

    Two points of contact grow out of one, and the area's slope jumps: a piece that is not.
    """
    start, pieces = recorded_at(QUICK()[0].point), 0
    for place in QUICK()[1:]:
        end = recorded_at(place.point if place.kink is None else place.kink.before)
        if len(forces(start)) == len(forces(end)):
            rise = energy(end) - energy(start)
            assert work(start, end) == pytest.approx(rise, rel=1e-6)
            pieces += 1
        start = recorded_at(place.point)
    assert pieces > 3


def energy(point: BranchPoint) -> float:
    return equilibrium(point).energy


def work(before: BranchPoint, after: BranchPoint) -> float:
    middle = point_near(
        before.family, 0.5 * (before.x + after.x), 0.5 * (before.value + after.value)
    )
    assert middle is not None
    middle = recorded_at(middle)
    areas = [equilibrium(at).film_energy / at.value for at in (before, middle, after)]
    return float(np.dot([1, 4, 1], areas)) / 6 * (after.value - before.value)


def recorded_at(point: BranchPoint) -> BranchPoint:
    return recorded(point, across_values(point.x, 1.0))


@pytest.mark.slow
def test_unloading_is_the_same_branch() -> None:
    """The line joins to a point, and the point parts, where they came to be."""
    there = loaded(24, 0.0, 3600.0)
    last = there[-1].point
    back = replace(last, direction=last.direction.reversed())
    found = []
    for place in places(back, 60):
        found.append(place)
        if place.point.value < 1900.0:
            break
    happens = [at.kink.what for at in found if at.kink is not None and at.kink.what]
    assert happens == ["joins", "parts"]
    for here, other in ("parts", "touches"), ("joins", "splits"):
        assert load_of(found, here) == pytest.approx(load_of(there, other), rel=1e-6)


@pytest.mark.slow
def test_the_flat_film_touches_where_the_polygon_does() -> None:
    """In space it is a saddle by then: stable or not makes no difference."""
    mesh = shapes.mesh_of(*shapes.disk_points(4))
    flat, free = (
        touching_from(lobes(mesh, 1600.0, 0.0, in_plane)) for in_plane in (True, False)
    )
    assert free.before.value == pytest.approx(flat.before.value, rel=1e-8)
    assert flat.before.stability.n_unstable == 0
    assert free.before.stability.n_unstable == 1
    assert np.ptp(free.before.x[:, 2]) < 1e-8


def touching_from(start: BranchPoint) -> Kink:
    return next(at.kink for at in places(start, 30) if at.kink is not None)


def thick_film(parameter: str, load: float) -> tuple[BranchPoint, StepControl]:
    """A twisted film in contact, on a small mesh."""
    points, triangles = shapes.disk_points(5)
    mesh = shapes.mesh_of(points * [1.6, 1.0], triangles)
    problem = Problem(mesh, "dirichlet", diameter=0.06)
    noise = 1e-3 * np.random.default_rng(1).standard_normal(mesh.x.shape)
    found: Equilibrium | None = None
    for step in (2700.0, load):
        found = solve(problem, step, mesh.x + noise if found is None else found)
    assert found is not None
    assert found.is_minimum
    assert found.contacts is not None
    assert len(found.contacts) == 1
    window = {"load": (2700.0, 4000.0), "diameter": (0.02, 0.1)}[parameter]
    control = StepControl(window, unit=window[1], first_step=2e-3, largest_step=4e-3)
    return film_point(found, problem, control, parameter), control


@pytest.mark.slow
def test_along_the_diameter_energy_rises_by_the_force() -> None:
    start, control = thick_film("diameter", 3600.0)
    points = [start, *(at.point for at in places(start, 4, control))]
    assert points[-1].value > points[0].value + 5e-4
    found = [equilibrium(point) for point in points]
    off = np.array([point.value for point in points]) - points[2].value
    slope = np.polyfit(off, [at.energy for at in found], 4)[-2]
    assert forces(points[2]).sum() == pytest.approx(slope, rel=1e-6)
    for point, film in zip(points, found, strict=True):
        assert film.contacts is not None
        assert np.abs(film.contacts.gaps).max() < 1e-11
        apart = np.linalg.norm(film.contacts.points[0] - film.contacts.points[1], axis=1)
        np.testing.assert_allclose(apart, point.value, rtol=1e-10)


def test_directions_in_the_diameter_are_tangents() -> None:
    start, control = thick_film("diameter", 3600.0)
    steps, gaps = [1e-3, 2e-3, 4e-3], []
    for step in steps:
        after = advance(start, step, control)
        assert after is not None
        gap = after.x - start.x - step * start.direction.displacement
        gaps.append(float(np.linalg.norm(gap)))
    assert shapes.fitted_order(steps, gaps) == pytest.approx(2.0, abs=0.1)


@pytest.mark.slow
def test_an_exploration_goes_on_after_a_kink_to_the_bit() -> None:
    start, _ = thick_film("load", 3100.0)
    problem, found = start.family.problem, equilibrium(start)  # type: ignore[attr-defined]
    how = {"special_points": 0, "unstable_modes": 1}
    points = list(explore(problem, (2850.0, 3200.0), found, **how))  # type: ignore[arg-type]
    at = next(k for k, point in enumerate(points) if point.special is not None)
    special = points[at].special
    assert special is not None
    assert (special.kind, special.contact) == ("contact", "parts")
    kept = points[at + 1].then
    assert kept is not None
    on = list(explore(problem, (2850.0, 3200.0), progress=kept.arrays(), **how))  # type: ignore[arg-type]
    assert len(on) == len(points) - at - 2 > 0
    for point, other in zip(on, points[at + 2 :], strict=True):
        assert np.array_equal(point.point.x, other.point.x)


EDGES = (40, 80, 160)


@pytest.mark.slow
def test_where_contact_begins_and_becomes_a_line_is_of_second_order() -> None:
    exact = thresholds(2, DIAMETER)
    for what, load in (
        ("touches", exact.sigma_contact),
        ("splits", exact.sigma_line_contact),
    ):
        assert load is not None
        found = [load_of(loaded(edges, 0.0, 4300.0), what) for edges in EDGES]
        errors = np.abs(np.array(found) / load - 1)
        order = shapes.fitted_order([1 / edges for edges in EDGES], list(errors))
        assert order == pytest.approx(2.0, abs=0.1)
        assert errors[-1] < 5e-3
        # A shifted mesh meets both with the same error, but for what its edges cut off.
        for shift in (0.3, 0.5):
            shifted = load_of(loaded(80, shift, 4300.0), what)
            assert abs(shifted - found[1]) < 0.35 * abs(found[1] - load)


@pytest.mark.slow
@pytest.mark.parametrize(("diameter", "load"), [(0.05, 1450.0), (0.02, 1050.0)])
def test_the_eight_opens_where_the_one_without_a_mesh_does(
    diameter: float, load: float
) -> None:
    """Its strands part, and the film goes on, unstable, as the load rises again."""
    film, exact = thick_eight(load, diameter), opening_load(diameter)
    errors = []
    for edges, shift in (60, 0.0), (120, 0.0), (60, 0.3):
        mesh = round_disk(edges)
        control = StepControl((500.0, 2000.0), unit=2000.0)
        problem = Problem(mesh, "area", diameter=diameter)
        start = film_point(eight_on(mesh, film, shift), problem, control)
        down = replace(start, direction=start.direction.reversed())
        found = [at for at, _ in zip(places(down, 20, control), range(20), strict=False)]
        (kink,) = kinks(found, "parts")
        errors.append(kink.before.value - exact)
        assert kink.before.stability.n_unstable == 0
        assert kink.after.stability.n_unstable == 1
        assert kink.before.direction.rate < 0 < kink.after.direction.rate
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
    assert errors[2] == pytest.approx(errors[0], rel=0.05)


@pytest.mark.slow
def test_the_eight_s_contact_splits_where_the_one_without_a_mesh_does() -> None:
    diameter = 0.05
    film, exact = thick_eight(3800.0, diameter), splitting_load(diameter)
    assert exact is not None
    errors = []
    for edges, shift in (60, 0.0), (120, 0.0), (120, 0.3):
        mesh = round_disk(edges)
        control = replace(CONTROL, window=(3000.0, 4800.0), unit=4800.0)
        problem = Problem(mesh, "area", diameter=diameter)
        start = film_point(eight_on(mesh, film, shift), problem, control)
        found = next(
            at.kink.before.value
            for at in places(start, 20, control)
            if at.kink is not None and at.kink.what == "splits"
        )
        errors.append(found - exact)
    # The load without a mesh is good to about 1.
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.2)
    assert abs(errors[2] - errors[1]) < 0.35 * abs(errors[1])
