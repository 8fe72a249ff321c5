"""Branches of soap films: the two-lobed film and its loss of stability to twist."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from eulerplateau.branches import FilmFamily, equilibrium, film_point
from eulerplateau.branches.continuation import follow
from eulerplateau.branches.exploration import DiagramPoint, Limits, explore_from
from eulerplateau.branches.point import BranchPoint, first_point
from eulerplateau.branches.special import BIFURCATION
from eulerplateau.branches.symmetry import loop_distance
from eulerplateau.exact.planar import planar_film
from eulerplateau.mesh import Measurer
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Problem, solve
from tests.helpers import shapes, soap_films
from tests.helpers.conformal_films import onset

LIMITS = Limits(special_points=1, unstable_modes=2, stop=lambda point: point.value > 2000)


def nearly_regular_disk() -> Disk:
    # On a regular one Delaunay's triangles tie, and rounding chooses.
    return soap_films.irregular_disk(6, 0.02)


@cache
def visits() -> tuple[DiagramPoint, ...]:
    planar = soap_films.two_lobed(nearly_regular_disk(), 1600.0)
    return tuple(explore_from(planar, soap_films.CONTROL, LIMITS))


def energy(point: BranchPoint) -> float:
    return equilibrium(point).energy


def on_branch(number: int) -> list[BranchPoint]:
    return [v.point for v in visits() if v.branch == number and v.special is None]


def test_two_lobed_film_twists_at_a_pitchfork() -> None:
    special = next(v.special for v in visits() if v.special is not None)
    assert special.kind == BIFURCATION
    assert special.multiplicity == 1
    assert special.n_unstable == 0
    assert special.symmetry.transverse == pytest.approx(1.0, abs=1e-9)
    # Twist keeps the half turns and breaks the mirrors.
    assert all(kept.startswith("half turn") for kept in special.symmetry.keeps)
    assert {"half turn about long axis"} <= set(special.symmetry.keeps)
    assert "mirror across short axis" in special.symmetry.breaks
    for point in on_branch(0):
        above = point.value > special.point.value
        assert point.stability.n_unstable == int(above)


def test_twisted_films_are_mirror_images_of_each_other() -> None:
    left, right = on_branch(1), on_branch(2)
    assert len(left) == len(right) > 5
    for one, other in zip(left, right, strict=True):
        assert one.value == pytest.approx(other.value, rel=1e-8)
        assert energy(one) == pytest.approx(energy(other), rel=1e-8)
        mirrored = one.x * [1.0, 1.0, -1.0]
        assert loop_distance(mirrored, other.x) < 1e-9
        assert loop_distance(one.x, other.x) > 1e-4


def test_pitchfork_is_subcritical() -> None:
    """The twisted branch runs down in the load, unstable, with the square of its twist.

    To an onset that is the planar film's but for another mesh inside: vertices that may lie
    anywhere on a flat film find their places on a curved one.
    """
    special = next(v.special for v in visits() if v.special is not None)
    onset = special.point.value
    loads, twists = [], []
    for point in on_branch(1):
        assert point.value < onset
        assert point.stability.n_unstable == 1
        if onset - point.value < 0.05 * onset:
            loads.append(point.value)
            twists.append(np.ptp(point.x[:, 2]))
    assert len(twists) >= 4
    curve = np.polynomial.Polynomial.fit(np.square(twists), loads, 2)
    assert curve.deriv()(0.0) < 0
    assert np.abs(curve(np.square(twists)) - loads).max() < 1e-3 * np.ptp(loads)
    # The film's own error is 3e-2 here.
    assert curve(0.0) == pytest.approx(onset, rel=1e-3)


def test_planar_branch_is_the_plane_film_whatever_becomes_of_the_mesh() -> None:
    """Triangles are replaced on the way; loop, energy and direction go on as before."""
    mesh = nearly_regular_disk()
    problem = Problem(mesh, "area", in_plane=True)
    start = soap_films.two_lobed(mesh, 1600.0)
    points = []
    for point in follow(start, soap_films.CONTROL):
        points.append(point)
        if point.value > 2200:
            break
    tilings = []
    for point in points:
        shape = soap_films.shape(point)
        tilings.append(shape.triangles)
        assert Measurer(mesh).measure(shape).min_angle > 5
        plane = solve(problem, point.value, shape.x)
        assert energy(point) == pytest.approx(plane.energy, rel=1e-9)
        # Below the exact film's, by an error of second order in the turn at a vertex.
        exact = planar_film(2, point.value)
        turn = exact.kappa_max / mesh.n_b
        assert 0 < 1 - energy(point) / exact.energy < turn**2
    assert any(not np.array_equal(a, b) for a, b in pairwise(tilings))


@pytest.mark.slow
def test_load_of_the_twist_converges_at_second_order_to_the_exact_films() -> None:
    exact, sizes, errors = onset()[0].load, [], []
    for rings in (6, 9, 13):
        planar = soap_films.two_lobed(soap_films.irregular_disk(rings, 0.0), 1750.0)
        sizes.append(1 / rings)
        errors.append(soap_films.twist_point(planar).point.value - exact)
    assert shapes.fitted_order(sizes, errors) == pytest.approx(2.0, abs=0.2)


def test_branch_from_the_disk_turns_into_the_two_lobed_film_on_an_uneven_mesh() -> None:
    """Where the disk is not quite round the pitchfork at 48 pi^3 is imperfect: its two
    branches miss each other narrowly, and a step must not leap from one to the other."""
    points, triangles = shapes.disk_points(6, 0.1)
    mesh = shapes.mesh_of(points * [1.0, 0.999], triangles)
    problem = Problem(mesh, "area")
    found = solve(problem, 1400.0, mesh.shape)
    start = film_point(found, problem, soap_films.CONTROL)
    limits = Limits(0, 2, stop=lambda point: point.value > 1700)
    branch = [visit.point for visit in explore_from(start, soap_films.CONTROL, limits)]
    assert branch[-1].value > 1700
    for point in branch:
        assert point.stability.n_unstable == 0
        # To the mesh's own error both limits of the imperfect pitchfork are exact films.
        exact = planar_film(2, point.value)
        assert energy(point) == pytest.approx(exact.energy, rel=0.01)
    along, across, _ = np.linalg.svd(branch[-1].x - branch[-1].x.mean(axis=0))[1]
    assert across < 0.6 * along


def test_round_disk_gives_way_to_two_lobes_any_way_they_lie() -> None:
    """At 48 pi^3 cos 2 phi and sin 2 phi go together; no load moves a round loop."""
    mesh = nearly_regular_disk()
    problem = Problem(mesh, "area")
    disk = FilmFamily(problem, problem.film.of_loop(mesh.shape))
    start = first_point(disk, mesh.x[mesh.loop], 1380.0, soap_films.CONTROL)
    limits = Limits(1, 2, stop=lambda point: point.value > 1600)
    found = list(explore_from(start, soap_films.CONTROL, limits))
    special = next(visit.special for visit in found if visit.special is not None)
    assert (special.kind, special.multiplicity, special.n_unstable) == (BIFURCATION, 2, 0)
    # 36 edges turn by 10 degrees each: an error of some (pi / 18)^2.
    assert special.point.value == pytest.approx(48 * np.pi**3, rel=(np.pi / 18) ** 2)
    lobed = [visit.point for visit in found if visit.branch > 0 and visit.special is None]
    assert len({visit.branch for visit in found}) == 3
    for point in lobed:
        assert point.value > special.point.value
        assert point.stability.n_unstable == 0
        exact = planar_film(2, point.value)
        assert energy(point) == pytest.approx(exact.energy, rel=0.01)
