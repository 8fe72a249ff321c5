"""Catalogues of loops whose strands touch: what is known of them, and what bounds them."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import Plan, catalogue_at, equilibrium_near
from eulerplateau.branches.conformal import thick_eight
from eulerplateau.branches.contact_search import apart, search
from eulerplateau.branches.deflation import newton, towards_index
from eulerplateau.branches.film_family import FilmFamily, equilibrium, family_on
from eulerplateau.branches.loop_starts import circle
from eulerplateau.exact import planar_film
from eulerplateau.loop import Contacts, close_with_lengths, strands_of
from eulerplateau.mesh import Shape
from eulerplateau.solvers import Equilibrium, Problem, TangentModel, solve
from scripts.studies.contact_starts.brute_force import least_distance
from tests.helpers.shapes import disk_points, mesh_of

THICK = 0.05
# Between the loads at which planar films with two lobes touch at a point and along a line.
POINT = 2800.0


def thick(
    rings: int, film: str = "area", diameter: float = THICK, *, in_plane: bool = False
) -> Problem:
    """A film tied to its mesh on an oval one, for a round one has no lobes."""
    points, triangles = disk_points(rings)
    length = 1.6 if film == "dirichlet" else 1.0
    disk = mesh_of(points * [length, 1.0], triangles)
    return Problem(disk, film, in_plane=in_plane, diameter=diameter)


def family_at(problem: Problem, shape: Shape) -> FilmFamily:
    film = problem.film.of_loop(problem.film.prepared(shape))
    return family_on(problem, film, "load", 0.0)


def contacts_of(found: Equilibrium) -> Contacts:
    assert found.contacts is not None
    return found.contacts


def check_laws(problem: Problem, found: Equilibrium) -> None:
    """Gaps and forces are not negative, and there is no force across a gap."""
    contacts, apart = contacts_of(found), strands_of(problem.loop).apart
    assert found.converged
    least = least_distance(found.shape.x_loop, problem.loop.rest_lengths, apart)
    assert least > strands_of(problem.loop).diameter - 1e-9
    assert (contacts.forces > 0.0).all()
    assert np.abs(contacts.gaps).max(initial=0.0) < 1e-10


@pytest.mark.slow
def test_planar_films_in_contact_are_found_and_converge_to_the_exact_ones() -> None:
    """From a random loop, to second order: elliptic functions know energy and force."""
    exact, off = planar_film(2, POINT, THICK), []
    for rings in (8, 12):
        problem = thick(rings, in_plane=True)
        (entry,) = catalogue_at(problem, POINT, Plan(starts=1, index=0))
        assert entry.starts
        assert entry.symmetry == "2-fold; box"
        check_laws(problem, entry.equilibrium)
        energy, force = entry.equilibrium.energy, contacts_of(entry.equilibrium).force
        off.append([energy / exact.energy - 1, force / exact.contact_force - 1])
    coarse, fine = np.abs(off)
    orders = np.log(coarse / fine) / np.log(12 / 8)
    np.testing.assert_allclose(orders, 2.0, atol=0.2)


@pytest.mark.slow
def test_all_that_is_found_keeps_to_the_laws_and_is_what_solvers_find_from_there() -> None:
    problem = thick(6, "dirichlet", 0.06)
    load = 3600.0
    found = catalogue_at(problem, load, Plan(starts=5, index=3))
    some = [entry.equilibrium for entry in found]
    for one in some:
        check_laws(problem, one)
        again = equilibrium_near(problem, one.shape, load)
        if one.n_unstable == 0:
            again = solve(problem, load, one.shape)
        assert again.energy == pytest.approx(one.energy, rel=1e-11)
        assert contacts_of(again).force == pytest.approx(contacts_of(one).force, rel=1e-8)
        assert again.n_unstable == one.n_unstable
    assert [len(contacts_of(one)) for one in some if one.n_unstable == 0] == [1]
    assert max(one.n_unstable or 0 for one in some) > 0


@pytest.mark.slow
def test_planar_films_in_contact_are_saddles_whose_force_is_their_energys_rise() -> None:
    flat = thick(8, in_plane=True)
    (entry,) = catalogue_at(flat, POINT, Plan(starts=1, index=0))
    planar, space = entry.equilibrium, thick(8)
    family = family_at(space, planar.shape)
    point = search(family, planar.shape.x_loop, POINT, newton)
    assert point is not None
    saddle = equilibrium(point)
    check_laws(space, saddle)
    assert saddle.energy == pytest.approx(planar.energy, rel=1e-9)
    assert contacts_of(saddle).force == pytest.approx(contacts_of(planar).force, rel=1e-6)
    assert saddle.n_unstable
    step, energies = 1e-4, []
    for diameter in (THICK - step, THICK + step):
        other = thick(8, diameter=diameter)
        start = apart(family_at(other, saddle.shape), saddle.shape.x_loop)
        assert start is not None
        shape = other.film.carried(saddle.shape, start)
        near = search(family_at(other, shape), start, POINT, newton)
        assert near is not None
        energies.append(equilibrium(near).energy)
    slope = (energies[1] - energies[0]) / (2 * step)
    assert contacts_of(saddle).force == pytest.approx(slope, rel=1e-3)


def determinant(x: FloatArray) -> float:
    """The determinant of the knot that a polygon (n, 3) is: 1 of none, 3 of a trefoil.

    Alexander's polynomial at -1, from the crossings seen from above: 2 over - in - out.
    """
    e, n = np.roll(x, -1, axis=0) - x, len(x)
    overs, unders = [], []
    for i, j in zip(*np.triu_indices(n, 2), strict=True):
        places = np.stack([e[i, :2], -e[j, :2]], axis=1)
        if (i, j) == (0, n - 1) or np.linalg.det(places) == 0.0:
            continue
        a, b = np.linalg.solve(places, (x[j] - x[i])[:2])
        if 0 <= a < 1 and 0 <= b < 1:
            ends = [(x[i, 2] + a * e[i, 2], i + a), (x[j, 2] + b * e[j, 2], j + b)]
            unders.append(min(ends)[1])
            overs.append(max(ends)[1])
    if len(unders) < 2:
        return 1.0
    count, ordered = len(unders), np.sort(unders)
    rows = np.zeros((count, count))
    for row, under, over in zip(rows, unders, overs, strict=True):
        place = int(np.searchsorted(ordered, under))
        row[place] -= 1
        row[(place + 1) % count] -= 1
        row[int(np.searchsorted(ordered, over)) % count] += 2
    return float(abs(np.linalg.det(rows[1:, 1:])))


@pytest.mark.parametrize("index", [0, pytest.param(2, marks=pytest.mark.slow)])
def test_a_knot_stays_one_all_along_a_search(index: int) -> None:
    """No strand passes through another: the trefoil's determinant is 3, a circle's 1."""
    problem = thick(6, "dirichlet", 0.03)
    s = 2 * np.pi * np.arange(36) / 36
    x = np.stack([np.sin(s) + 2 * np.sin(2 * s), np.cos(s) - 2 * np.cos(2 * s)], axis=1)
    start = close_with_lengths(problem.loop, 0.05 * np.column_stack([x, -np.sin(3 * s)]))
    assert start is not None
    family, way, passed = family_at(problem, problem.disk.shape), towards_index(index), []
    start = apart(family, start)
    assert start is not None

    def step(model: TangentModel) -> FloatArray:
        passed.append(model.x)
        return way(model)

    search(family, start, 500.0, step)
    assert len(passed) > 10
    assert np.abs(passed[-1] - passed[0]).max() > 0.03
    aslant = np.linalg.qr(np.random.default_rng(0).standard_normal((3, 3)))[0]
    for x in passed[::4]:
        assert determinant(x @ aslant) == pytest.approx(3.0)
    assert determinant(circle(problem.loop) @ aslant) == 1.0


@pytest.mark.slow
def test_in_space_the_disk_lobes_and_the_twisted_eight_are_all_found() -> None:
    """Below the load at which lobes touch; each near what is known of it without a mesh."""
    load, problem = 2000.0, thick(8)
    found = catalogue_at(problem, load, Plan(starts=24, index=2))
    eight, lobes, disk = (entry.equilibrium for entry in found)
    for one in (eight, lobes, disk):
        check_laws(problem, one)
    assert [one.n_unstable for one in (eight, lobes, disk)] == [0, 1, 2]
    assert [len(contacts_of(one)) for one in (eight, lobes, disk)] == [1, 0, 0]
    assert eight.energy == pytest.approx(
        thick_eight(load, THICK, 0.0, 0.0).energy, rel=0.01
    )
    assert lobes.energy == pytest.approx(planar_film(2, load).energy, rel=0.01)
    assert disk.energy == pytest.approx(load / (4 * np.pi) + 4 * np.pi**2, rel=0.01)
