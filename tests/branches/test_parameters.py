"""Branches in the link and in the rigidity to twist: thresholds, zero, families, slips."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq

from eulerplateau.branches import BIFURCATION, FOLD, FilmFamily, FilmPoint, explore
from eulerplateau.branches.film_family import family_near
from eulerplateau.errors import SpecError
from eulerplateau.solvers import RESIDUAL_TOLERANCE, Problem, solve, sweep
from tests.helpers import shapes
from tests.solvers.test_twist import ROUND, critical_link, disk

NU = 1.0
LOAD = 16 * np.pi**3 * NU


def oval(**loop: float) -> Problem:
    """Springs on an elongated disk whose planar film is stable at 300 without link."""
    points, triangles = shapes.disk_points(4)
    return Problem(shapes.mesh_of(points * [1.6, 1.0], triangles), "springs", **loop)


def first_lost(problem: Problem, parameter: str, near: float) -> FilmPoint:
    """The first special point of the flat disk's branch in a parameter."""
    window = 0.93 * near, 1.03 * near
    points = explore(problem, window, parameter=parameter, load=LOAD, special_points=0)
    return next(point for point in points if point.special is not None)


def by_link(n_b: int) -> FilmPoint:
    problem = Problem(disk(n_b), "area", twist_ratio=ROUND)
    return first_lost(problem, "link", critical_link("area", NU, ROUND, 2))


def by_ratio(n_b: int) -> FilmPoint:
    """At a link of 1.5 turns: the law is the same, solved for C / B."""
    ratio = critical_link("area", NU, 1.5, 2)
    problem = Problem(disk(n_b), "area", twist_ratio=0.5, link=1.5)
    return first_lost(problem, "twist_ratio", ratio)


def critical_curvature() -> float:
    """q at which the disk is lost across its plane: sigma_2(q) = 96 pi^3 [1 - ...]."""
    g = ROUND

    def left(q: float) -> float:
        return 1 - q * (q + g) / (q + 4 * g) - NU / 6

    return float(brentq(left, 0.1, 3.0, xtol=1e-14))


def by_curvature(n_b: int) -> FilmPoint:
    """Of a rod without link; the threshold is met from the stable side."""
    near = critical_curvature()
    problem = Problem(disk(n_b), "area", twist_ratio=ROUND, rest_curvature=0.93 * near)
    return first_lost(problem, "rest_curvature", near)


@pytest.mark.parametrize(
    ("located", "exact"),
    [
        pytest.param(by_curvature, critical_curvature(), marks=pytest.mark.slow),
        (by_link, critical_link("area", NU, ROUND, 2)),
        pytest.param(by_ratio, critical_link("area", NU, 1.5, 2), marks=pytest.mark.slow),
    ],
)
def test_the_disk_is_lost_at_its_threshold_in_any_parameter_with_order_2(
    located: Callable[[int], FilmPoint], exact: float
) -> None:
    points = [located(n_b) for n_b in (24, 48)]
    for point in points:
        assert point.special is not None
        assert point.special.kind == BIFURCATION
        assert point.special.multiplicity == 2  # of a round loop, turned by 45 degrees
        assert point.special.n_unstable == 0
        assert point.special.error < 1e-8
        assert point.load == LOAD
    errors = [point.value / exact - 1 for point in points]
    assert abs(errors[1]) < 0.04
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)


@pytest.mark.slow
def test_what_leaves_the_disk_ends_where_strands_meet() -> None:
    exact = critical_link("dirichlet", NU, ROUND, 2)
    problem = Problem(disk(24), "dirichlet", twist_ratio=ROUND)
    window = 0.55 * exact, 1.01 * exact
    limits = {"special_points": 1, "unstable_modes": 2}
    found = list(explore(problem, window, parameter="link", load=LOAD, **limits))  # type: ignore[arg-type]
    side = [point for point in found if point.branch == 1]
    writhes = [p.problem.said_of_loop(p.shape)[0]["writhe"] for p in side]
    assert min(writhes) > 0  # the weld's turns are right-handed, and so is the way out
    met = [point.problem.pinched(point.shape) for point in side]
    assert sum(met) == met[-1]
    # A strand that had passed through another would have taken two turns along.
    assert max(writhes) < 1.2


@pytest.mark.slow
def test_a_branch_in_link_goes_through_zero_and_is_even() -> None:
    problem = oval(twist_ratio=ROUND, link=-0.1)
    window = -0.1, 0.3
    points = list(explore(problem, window, parameter="link", load=650.0, special_points=0))
    assert {point.branch for point in points} == {0}
    links = np.array([point.value for point in points])
    assert links[0] == -0.1
    assert links[-1] > 0.3
    assert (np.diff(links) > 0).all()
    energies = np.array([point.equilibrium.energy for point in points])
    columns = [point.problem.said_of_loop(point.shape)[0] for point in points]
    assert [said["link"] for said in columns] == links.tolist()
    moments = np.array([said["twist_moment"] for said in columns])
    writhes = np.array([said["writhe"] for said in columns])
    # By the work of the weld, dE / dLk = 2 pi M.
    energy = CubicHermiteSpline(links, energies, 2 * np.pi * moments)
    inside = links < 0
    np.testing.assert_allclose(energy(-links[inside]), energies[inside], rtol=1e-7)
    assert abs(writhes[0]) > 0.005
    assert np.interp(0.1, links, writhes) == pytest.approx(-writhes[0], rel=0.02)


@pytest.mark.slow
def test_forces_balance_at_every_point_though_its_film_leaves_the_plane_by_and_by() -> None:
    """No branch point is where a turned loop's flat film begins to curve."""
    points, triangles = shapes.disk_points(4)
    mesh = shapes.mesh_of(points * [2.0, 1.0], triangles)
    problem = Problem(mesh, "area", twist_ratio=0.7)
    found = explore(problem, (0.0, 0.3), parameter="link", load=1700.0, special_points=0)
    films = [point.equilibrium for point in found]
    assert np.ptp(films[-1].shape.x[:, 2]) > 0.01
    assert max(film.residual for film in films) <= RESIDUAL_TOLERANCE


@pytest.mark.slow
def test_forces_balance_at_folds_too() -> None:
    """Twisted films of a turned disk are turned most and least at folds: off any point."""
    mesh = shapes.mesh_of(*shapes.disk_points(5))
    problem = Problem(mesh, "area", twist_ratio=0.5)
    how = {"parameter": "link", "load": 1200.0, "special_points": 1, "unstable_modes": 1}
    found = explore(problem, (0.0, 1.2), **how)  # type: ignore[arg-type]
    films = [
        point.equilibrium
        for point in found
        if point.special is not None and point.special.kind == FOLD
    ]
    assert len(films) == 4
    assert max(film.residual for film in films) <= RESIDUAL_TOLERANCE


def test_a_start_inside_is_left_both_ways_at_the_loops_own_link() -> None:
    problem = oval(twist_ratio=ROUND, link=0.1)
    found = list(
        explore(problem, (0.08, 0.12), parameter="link", load=300.0, special_points=0)
    )
    firsts = [next(p for p in found if p.branch == number) for number in (0, 1)]
    assert [point.value for point in firsts] == [0.1, 0.1]
    ways = [[p.value for p in found if p.branch == number] for number in (0, 1)]
    assert max(ways[0]) > 0.12
    assert min(ways[1]) < 0.08
    assert "link" in repr(found[0])
    # A start that is given counts with its own load.
    start = solve(problem, 250.0)
    again = next(explore(problem, (0.08, 0.12), start, parameter="link"))
    assert (again.value, again.load) == (0.1, 250.0)


@pytest.mark.slow
def test_an_exploration_in_link_goes_on_to_the_bit() -> None:
    problem = oval(twist_ratio=ROUND, link=-0.02)
    how = {"parameter": "link", "load": 300.0, "special_points": 0}
    whole = list(explore(problem, (-0.02, 0.1), **how))  # type: ignore[arg-type]
    kept = whole[len(whole) // 2]
    assert kept.then is not None
    rest = list(
        explore(problem, (-0.02, 0.1), progress=kept.then.arrays(), **how)  # type: ignore[arg-type]
    )
    left = whole[len(whole) // 2 + 1 :]
    assert [point.value for point in rest] == [point.value for point in left]
    for one, other in zip(rest, left, strict=True):
        np.testing.assert_array_equal(one.shape.x, other.shape.x)


def test_families_in_load_and_in_link_are_of_one_energy() -> None:
    problem = oval(twist_ratio=ROUND)
    family, x = family_near(problem, problem.disk.shape)
    x = x + 0.01 * np.random.default_rng(1).standard_normal(x.shape)
    turned = family.with_value("link", 0.4)
    loaded = replace(family, parameter="link").with_value("load", 300.0)
    assert isinstance(loaded, FilmFamily)
    for one, other in zip(
        turned.energy(300.0).forces(x), loaded.energy(0.4).forces(x), strict=True
    ):
        np.testing.assert_array_equal(one, other)
    assert loaded.with_value("twist_ratio", 0.5).energy(0.4).terms["twist"].ratio == 0.5  # type: ignore[attr-defined]
    np.testing.assert_array_equal(family.positions(x), x)
    # What a branch is told of the force's rate is its derivative.
    for varied, at, h in ("link", 0.4, 1e-5), ("twist_ratio", 0.75, 1e-5):
        own = replace(loaded, parameter=varied)
        forces = [own.energy(at + s).terms["twist"].force(x) for s in (-h, h)]
        rate = (forces[1] - forces[0]) / (2 * h)
        scale = np.abs(rate).max()
        np.testing.assert_allclose(own.energy(at).rate(varied, x), rate, atol=1e-8 * scale)


def test_a_sweep_in_link_is_what_solving_each_would_be() -> None:
    problem, links = oval(twist_ratio=ROUND), [-0.1, 0.0, 0.2]
    found = list(sweep(problem, parameter="link", values=links, load=300.0))
    start = None
    for link, one in zip(links, found, strict=True):
        made = Problem(problem.disk, "springs", twist_ratio=ROUND, link=link)
        alone = solve(made, 300.0, start)
        assert one.energy == alone.energy
        np.testing.assert_array_equal(one.shape.x, alone.shape.x)
        start = alone
    assert [one.load for one in found] == [300.0] * 3
    assert all(a.energy != b.energy for a, b in pairwise(found))


@pytest.mark.parametrize(
    ("given", "culprit"),
    [
        ({"parameter": "link", "values": [0.1]}, "values"),
        ({"parameter": "link", "values": [np.nan], "load": 1.0}, "link"),
        ({"parameter": "twist_ratio", "values": [0.0], "load": 1.0}, "twist_ratio"),
        ({"parameter": "girth", "values": [0.1], "load": 1.0}, "parameter"),
        ({"parameter": "link", "loads": [1.0], "load": 1.0, "values": [0.1]}, "values"),
        ({"loads": [1.0], "values": [0.1]}, "loads"),
        ({}, "loads"),
    ],
)
def test_sweeps_in_what_is_not_there_are_refused(
    given: dict[str, object], culprit: str
) -> None:
    with pytest.raises(SpecError, match=f"^{culprit}"):
        list(sweep(oval(twist_ratio=ROUND), **given))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("window", "given", "culprit"),
    [
        ((0.0, 1.0), {"parameter": "twist_ratio", "load": 1.0}, "window.*0 < low"),
        ((1.0, 0.0), {"parameter": "link", "load": 1.0}, "window.*low < high"),
        ((0.0, 1.0), {"parameter": "link"}, "load"),
        ((1.0, 2.0), {"load": 1.0}, "load"),
        ((0.0, 1.0), {"parameter": "girth", "load": 1.0}, "parameter"),
    ],
)
def test_branches_in_what_is_not_there_are_refused(
    window: tuple[float, float], given: dict[str, object], culprit: str
) -> None:
    with pytest.raises(SpecError, match=f"^{culprit}"):
        next(explore(oval(twist_ratio=ROUND), window, **given))  # type: ignore[arg-type]


def test_a_loop_without_twist_has_no_link_to_be_varied() -> None:
    with pytest.raises(SpecError, match=r"^parameter.*'load' of this loop"):
        next(explore(oval(), (0.0, 1.0), parameter="link", load=1.0))
    with pytest.raises(SpecError, match=r"^parameter"):
        list(sweep(oval(), parameter="link", values=[0.1], load=1.0))


def test_no_step_of_a_branch_takes_a_strand_through_another() -> None:
    """A figure of eight whose strands cross over, and the same crossing under."""
    t = 2 * np.pi * np.arange(48) / 48
    over = np.stack([0.2 * np.sin(t), 0.05 * np.sin(2 * t), 0.01 * np.cos(t)], axis=1)
    under = over * [1.0, 1.0, -1.0]
    mesh = disk(48)
    turned, bare = (
        family_near(Problem(mesh, "springs", **loop), mesh.shape)[0].energy(300.0)
        for loop in ({"twist_ratio": ROUND}, {})
    )
    assert turned.reaches(over, over + np.array([0.0, 0.0, 0.001]))
    assert turned.reaches(over, over * [1.0, 1.0, 0.5])
    assert not turned.reaches(over, under)
    assert bare.reaches(over, under)  # without twist nobody notices
