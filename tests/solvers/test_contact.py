"""A loop with a diameter: forces as slopes of the energy, line contact, what is refused."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.planar import planar_film
from eulerplateau.loop import strands_of
from eulerplateau.mesh import Disk
from eulerplateau.solvers import Equilibrium, Problem, Status, lowest_modes, solve
from eulerplateau.solvers.contact.separation import separated, thinnest
from tests.helpers import shapes

# Loads at which two strands of an elongated film have crossed, and touch at one point.
LOADS = {"springs": 800.0, "dirichlet": 4000.0, "area": 2000.0}


@cache
def disk(rings: int = 8, jitter: float = 0.0) -> Disk:
    points, triangles = shapes.disk_points(rings, jitter)
    return shapes.mesh_of(points * [1.6, 1.0], triangles)


def crossed(mesh: Disk, turns: float = 0.6) -> FloatArray:
    """The mesh with one half turned against the other: strands cross in its middle."""
    x = mesh.x - mesh.x.mean(axis=0)
    angle = np.pi * turns * np.tanh(x[:, 0] / (0.35 * np.abs(x[:, 0]).max()))
    return np.stack([x[:, 0], x[:, 1] * np.cos(angle), x[:, 1] * np.sin(angle)], axis=1)


@cache
def eight(film: str, diameter: float, rings: int = 8) -> Equilibrium:
    mesh = disk(rings)
    return solve(Problem(mesh, film, diameter=diameter), LOADS[film], crossed(mesh))


@pytest.mark.parametrize(
    ("film", "d"),
    [
        ("springs", 0.02),
        pytest.param("dirichlet", 0.02, marks=pytest.mark.slow),
        pytest.param("area", 0.02, marks=pytest.mark.slow),
        ("area", 0.03),
    ],
)
def test_strands_that_touch_push_with_the_energy_s_slope_in_the_diameter(
    film: str, d: float
) -> None:
    found = eight(film, d)
    assert found.is_minimum
    assert found.residual < 1e-7
    assert found.contacts is not None
    assert len(found.contacts) == 1
    assert found.contacts.at_a_point.all()
    assert found.contacts.force > 1.0
    assert abs(found.contacts.smallest_gap) < 1e-10

    def energy(diameter: float) -> float:
        problem = Problem(disk(), film, diameter=diameter)
        near = solve(problem, LOADS[film], found)
        assert near.is_minimum
        # Others would be another film.
        assert np.array_equal(near.shape.triangles, found.shape.triangles)
        return near.energy

    step = 1e-4
    wide = (energy(d + step) - energy(d - step)) / (2 * step)
    near = (energy(d + step / 2) - energy(d - step / 2)) / step
    # A curved film is no minimum along itself: vertices that move there do some work.
    refined = len(found.shape.x) > disk().n_v
    within = found.film_residual if refined else 1e-5
    assert found.contacts.force == pytest.approx((4 * near - wide) / 3, rel=within)


@pytest.mark.parametrize("film", LOADS)
def test_a_film_in_contact_is_not_pinched_and_balances(film: str) -> None:
    found = eight(film, 0.02)
    assert found.status is Status.CONVERGED
    assert found.contacts is not None
    assert found.contacts.force > 0
    assert found.contacts.forces.min() > 0
    assert found.contacts.smallest_gap > -1e-10
    # The pushes on the two strands cancel.
    np.testing.assert_allclose(found.contacts.pushes.sum(axis=0), 0.0, atol=1e-9)


def test_strands_that_overlap_are_parted_first_and_the_energy_falls_from_there() -> None:
    mesh, diameter = disk(), 0.05
    thin = eight("dirichlet", 0.01)
    problem = Problem(mesh, "dirichlet", diameter=diameter)
    strands = strands_of(problem.loop)
    assert thinnest(strands, thin.shape.x_loop) < 0.5 * diameter
    parted = separated(strands, thin.shape.x_loop)
    assert parted is not None
    assert thinnest(strands, parted) > diameter - 1e-10
    energy = problem.film.of_loop(mesh.shape).energy(problem.loop, LOADS["dirichlet"])
    found = solve(problem, LOADS["dirichlet"], thin)
    assert energy.change(parted, found.shape.x_loop - parted) < 0


@pytest.fixture(scope="module")
def flat() -> tuple[Problem, Equilibrium]:
    """A film in its plane whose strands lie along each other at the waist."""
    problem = Problem(disk(20), "area", in_plane=True, diameter=0.05)
    return problem, solve(problem, 6000.0, solve(problem, 3000.0))


def test_along_a_line_of_contact_strands_push_as_hard_as_the_film_pulls(
    flat: tuple[Problem, Equilibrium],
) -> None:
    """On a straight strand sigma per length; the ends carry the rod's shear force as well.

    So far from the middle forces sum up to sigma s, to what the film pulls between places
    next to each other; and all of them to the exact film's.
    """
    _, found = flat
    assert found.is_minimum
    contacts = found.contacts
    assert contacts is not None
    assert not contacts.at_a_point.any()
    order = np.argsort(contacts.s)
    forces, places = contacts.forces[order], contacts.s[order]
    middle = forces @ places / forces.sum()
    above = forces.cumsum() - forces.sum() / 2
    inside = slice(1, -1)
    spacing = np.diff(places).max()
    assert np.ptp(places[inside]) > 1.5 * spacing
    for sums in (above, above - forces):
        off = sums - 6000.0 * (places - middle)
        assert np.abs(off[inside]).max() < 6000.0 * spacing
    exact = planar_film(2, 6000.0, 0.05)
    assert contacts.force == pytest.approx(exact.contact_force, rel=0.01)


@pytest.mark.slow
def test_a_line_of_contact_is_the_same_whatever_the_way_there(
    flat: tuple[Problem, Equilibrium],
) -> None:
    problem, found = flat
    other = solve(problem, 6000.0)
    assert other.energy == pytest.approx(found.energy, rel=1e-7)
    assert found.contacts is not None
    assert other.contacts is not None
    assert other.contacts.force == pytest.approx(found.contacts.force, rel=1e-6)


def test_the_force_on_a_line_of_contact_is_the_energy_s_slope_too(
    flat: tuple[Problem, Equilibrium],
) -> None:
    problem, found = flat
    assert found.contacts is not None

    def energy(diameter: float) -> float:
        other = Problem(problem.disk, "area", in_plane=True, diameter=diameter)
        return solve(other, 6000.0, found).energy

    slope = (energy(0.0501) - energy(0.0499)) / 2e-4
    assert found.contacts.force == pytest.approx(slope, rel=1e-3)


@pytest.mark.slow
def test_a_loop_that_bends_more_than_its_rod_can_is_too_thick() -> None:
    problem = Problem(disk(14), "area", in_plane=True, diameter=0.1)
    found = solve(problem, 2000.0)
    assert found.status is Status.CONVERGED
    # A racket's head bends as (sigma / 2)^(1/3), and a rod by 2 / d at most.
    assert solve(problem, 6000.0, found).status is Status.TOO_THICK


@pytest.mark.parametrize("diameter", [0.0, -0.01, 0.11, float("nan")])
def test_a_diameter_out_of_range_is_refused(diameter: float) -> None:
    with pytest.raises(SpecError, match="diameter"):
        Problem(disk(), "springs", diameter=diameter)


@pytest.mark.parametrize("name", ["diameter", "twist_ratio", "link", "rest_curvature"])
def test_text_in_place_of_a_number_of_the_rod_is_refused(name: str) -> None:
    rod: dict[str, Any] = {"diameter": 0.01, "twist_ratio": 0.7} | {name: "0.3 mm"}
    with pytest.raises(SpecError, match=f"^{name}: found '0.3 mm'; should be a number"):
        Problem(disk(), "springs", **rod)


@pytest.mark.parametrize("solver", ["cg", "cg-plain"])
def test_solvers_that_know_no_contact_are_refused(solver: str) -> None:
    with pytest.raises(SpecError, match="newton"):
        solve(Problem(disk(), "springs", diameter=0.02), 10.0, solver=solver)


def test_modes_of_a_film_in_contact_keep_its_gap() -> None:
    found = eight("dirichlet", 0.02)
    problem = Problem(disk(), "dirichlet", diameter=0.02)
    contacts = found.contacts
    assert contacts is not None
    assert contacts.unstable_let_go is None
    modes = lowest_modes(problem, found, 3)
    strands, x = strands_of(problem.loop), found.shape.x_loop
    slope = strands.between(x, contacts.places).jacobian()
    for mode in modes.values():
        assert np.abs(slope @ mode[disk().loop].ravel()).max() < 1e-9


def test_a_contact_that_hardly_pushes_is_doubtful_and_counted_both_ways() -> None:
    """The eight as wide as its waist is when nothing touches: then the force vanishes."""
    problem = Problem(disk(), "dirichlet")
    free = solve(problem, 3000.0, eight("dirichlet", 0.05).shape)
    assert free.is_minimum
    x, thin = free.shape.x_loop, Problem(disk(), "dirichlet", diameter=1e-3)
    _, widths = strands_of(thin.loop).near(x, 0.1)
    waist = float(widths.min()) + 1e-3
    found = solve(Problem(disk(), "dirichlet", diameter=waist), 3000.0, free)
    contacts = found.contacts
    assert contacts is not None
    assert len(contacts) == 1
    assert contacts.doubtful.all()
    assert contacts.unstable_let_go == found.n_unstable == 0
    assert found.energy == pytest.approx(free.energy, rel=1e-12)


def turned(mesh: Disk, part: float) -> FloatArray:
    """An oval start in the plane whose long axis is turned on the mesh by parts of an edge.

    The mesh is round, of even edges: what differs is how its vertices lie on the oval.
    """
    angle = 2 * np.pi * part / mesh.n_b
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return mesh.x @ turn.T @ np.diag([1.4, 0.7, 1.0]) @ turn


@pytest.mark.slow
def test_force_and_index_stay_when_the_mesh_is_shifted_along_the_loop() -> None:
    def spread(rings: int) -> float:
        mesh = shapes.mesh_of(*shapes.disk_points(rings))
        problem = Problem(mesh, "area", in_plane=True, diameter=0.05)
        forces = []
        for part in (0.0, 0.2, 0.5):
            found = solve(problem, 3000.0, turned(mesh, part))
            assert found.n_unstable == 0
            assert found.contacts is not None
            forces.append(found.contacts.force)
        return float(np.ptp(forces) / forces[0])

    coarse, fine = spread(8), spread(12)
    assert coarse < 1e-3
    assert np.log(coarse / fine) / np.log(12 / 8) > 2.5


def test_a_soap_film_that_passes_through_itself_is_no_equilibrium() -> None:
    mesh = disk()
    problem = Problem(mesh, "area", diameter=0.02)
    flat = solve(problem, 500.0)
    assert flat.status is Status.CONVERGED
    # Two bumps of the film that lean across each other.
    rest, place = flat.shape.x, np.array([0.07, 0.0, 0.0])
    bumps = np.zeros_like(rest)
    for side in (place, -place):
        height = np.exp(-((rest - side) ** 2).sum(axis=1) / 0.03**2)
        bumps += np.outer(height, [-2 * side[0], 0.0, 0.1])
    crossed_film = replace(flat, shape=flat.shape.moved(rest + bumps))
    assert problem.classified(crossed_film).status is Status.FILM_TOUCHED
    # Springs pass through each other, and without a diameter it is not looked at.
    for other in (Problem(mesh, diameter=0.02), Problem(mesh, "area")):
        assert other.classified(crossed_film).status is Status.CONVERGED


@pytest.mark.slow
def test_a_loop_without_a_diameter_loads_nothing_of_contact() -> None:
    code = """
import sys
from eulerplateau.solvers import Problem, solve
from tests.helpers import shapes
mesh = shapes.mesh_of(*shapes.disk_points(3))
for film in ("springs", "area"):
    found = solve(Problem(mesh, film), 100.0)
assert found.contacts is None
print(*sys.modules)
"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    parts = ("contact", "strand", "gaps")
    ours = [name for name in done.stdout.split() if name.startswith("eulerplateau")]
    assert "eulerplateau.solvers.newton" in ours
    assert [name for name in ours if any(part in name for part in parts)] == []


def welded(link: float, diameter: float, start: Equilibrium | None = None) -> Equilibrium:
    problem = Problem(disk(), "area", twist_ratio=2 / 3, link=link, diameter=diameter)
    return solve(problem, 2000.0, crossed(disk()) if start is None else start)


@pytest.mark.slow
def test_a_rod_that_resists_twist_touches_itself_and_does_the_work_it_should() -> None:
    found = welded(0.7, 0.03)
    assert found.is_minimum
    assert found.contacts is not None
    assert found.contacts.force > 1.0
    problem = Problem(disk(), "area", twist_ratio=2 / 3, link=0.7)
    moment = problem.loop.terms["twist"].columns(found.shape.x_loop)["twist_moment"]
    wide, narrow = (welded(0.7, 0.03 + h, found).energy for h in (2e-4, -2e-4))
    assert (wide - narrow) / 4e-4 == pytest.approx(found.contacts.force, rel=1e-4)
    more, less = (welded(0.7 + h, 0.03, found).energy for h in (5e-3, -5e-3))
    assert (more - less) / 1e-2 == pytest.approx(2 * np.pi * moment, rel=1e-3)
