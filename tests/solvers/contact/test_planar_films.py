"""Planar contact on meshes: polygons converge to the exact films of a thick loop."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.planar import PlanarFilm, planar_film, thresholds
from eulerplateau.loop import Contacts, Gaps, strands_of, with_gaps_held
from eulerplateau.mesh import Disk
from eulerplateau.solvers import (
    Equilibrium,
    Problem,
    Status,
    TangentModel,
    solve,
    sweep,
)
from tests.helpers import shapes
from tests.helpers.equilibria import critical_point, loop_energy

film_at = cache(planar_film)
# Lobes, load, diameter: each diameter twice in point contact, then along a line.
POINT = [
    (2, 2400.0, 0.05),
    (2, 3500.0, 0.05),
    (2, 2600.0, 0.02),
    (2, 4000.0, 0.02),
    (2, 2700.0, 0.005),
    (2, 4000.0, 0.005),
    (3, 12000.0, 0.02),
]
LINES_OF_THREE = (3, 60000.0, 0.02)
LINE = [(2, 6000.0, 0.05), (2, 7000.0, 0.02), (2, 8000.0, 0.005)]


def placed(film: PlanarFilm, mesh: Disk, shift: float = 0.0) -> FloatArray:
    """The fan with its loop on an exact film, off its tip by so many edges."""
    x = np.zeros_like(mesh.x)
    x[mesh.loop, :2] = film.positions((np.arange(mesh.n_b) + shift) / mesh.n_b)
    return x


@cache
def relaxed(film: tuple[int, float, float], edges: int, shift: float = 0.0) -> Equilibrium:
    """The polygon that an exact film relaxes to."""
    mesh, (lobes, load, diameter) = shapes.fan(edges), film
    problem = Problem(mesh, "area", in_plane=True, diameter=diameter)
    start = placed(film_at(lobes, load, diameter), mesh, shift)
    found = solve(problem, load, start)
    assert found.is_minimum
    return found


def force(found: Equilibrium) -> float:
    assert found.contacts is not None
    assert (found.contacts.forces > 0).all()
    return found.contacts.force


def on_one_strand(contacts: Contacts) -> FloatArray:
    """Where strands touch, on that of the first place: either may come first in a pair."""
    first = contacts.s[0]
    both = (np.stack([contacts.s, contacts.t]) - first + 0.5) % 1.0 - 0.5
    return first + np.where(np.abs(both[0]) < np.abs(both[1]), *both)


def length_of_line(found: Equilibrium) -> float:
    """The contact's length l, as its force F and the force's second moment M tell it.

    A film pushes along a line with its tension, and the rest of F is half at each end:
    M = (F - sigma l) l^2 / 4 + sigma l^3 / 12. The outermost places say it to an edge.
    """
    assert found.contacts is not None
    pushes, s = found.contacts.forces, on_one_strand(found.contacts)
    total, middle = pushes.sum(), pushes @ s / pushes.sum()
    moment = pushes @ (s - middle) ** 2
    roots = np.roots([-found.load / 6, total / 4, 0.0, -moment])
    return float(roots[(np.isreal(roots)) & (roots.real > 0)].real.min())


def held_along_lines(edges: int) -> tuple[TangentModel, float]:
    """Three lobes whose strands are held where the exact film's touch; their energy."""
    mesh, (lobes, load, diameter) = shapes.fan(edges), LINES_OF_THREE
    film = film_at(*LINES_OF_THREE)
    problem = Problem(mesh, "area", in_plane=True, diameter=diameter)
    place, (first, last) = np.arange(edges) / edges, film.half_lobe.ends[1:3]
    flank = place[(place > first) & (place < last)]
    tips = np.arange(lobes)[:, None] / lobes
    s, t = ((tips + side * flank).ravel() % 1 for side in (1, -1))
    gaps = Gaps(s, t, np.zeros(len(s), dtype=bool))
    energy = loop_energy(problem, load)
    held = with_gaps_held(energy, strands_of(problem.loop), gaps)
    start = held.constraint.project(placed(film, mesh)[mesh.loop, :2])
    assert start is not None
    model = critical_point(held, start)
    return model, energy.change(np.zeros_like(start), model.x)


def assert_second_order(
    values: list[float], exact: float, band: float, rest: float
) -> None:
    """Of values at edges h, h/2, h/4; their limit is nearer than the last by `rest`."""
    errors = [value - exact for value in values]
    assert shapes.fitted_order([4.0, 2.0, 1.0], errors) == pytest.approx(2, abs=band)
    limit = (4 * values[-1] - values[-2]) / 3
    assert abs(limit - exact) < rest * abs(errors[-1])


@pytest.mark.slow
@pytest.mark.parametrize("film", POINT)
def test_films_that_touch_at_points_converge_with_second_order(
    film: tuple[int, float, float],
) -> None:
    exact = film_at(*film)
    found = [relaxed(film, edges) for edges in (84, 168, 336)]
    for each in found:
        assert each.contacts is not None
        assert len(each.contacts) == (1 if film[0] == 2 else film[0])
    energies, forces = [each.energy for each in found], [force(each) for each in found]
    assert_second_order(energies, exact.energy, 0.02, 0.02)
    assert_second_order(forces, exact.contact_force, 0.05, 0.02)


@pytest.mark.slow
@pytest.mark.parametrize("film", LINE)
def test_films_that_touch_along_a_line_converge_with_second_order(
    film: tuple[int, float, float],
) -> None:
    """Where between two vertices the line ends makes the factor before h^2 uneven."""
    exact = film_at(*film)
    found = [relaxed(film, edges) for edges in (84, 168, 336)]
    energies, forces = [each.energy for each in found], [force(each) for each in found]
    assert_second_order(energies, exact.energy, 0.05, 0.02)
    assert_second_order(forces, exact.contact_force, 0.2, 0.2)
    line, lengths = 2 * exact.contact_length, [length_of_line(each) for each in found]
    order = shapes.fitted_order([4.0, 2.0, 1.0], [each - line for each in lengths])
    assert order == pytest.approx(2, abs=0.4)
    for each in found:
        assert each.contacts is not None
        reach = np.ptp(on_one_strand(each.contacts))
        assert abs(reach - line) < 2 / len(each.shape.loop)


@pytest.mark.slow
def test_three_lobes_along_lines_converge_and_share_them_at_no_cost() -> None:
    """Lobes may exchange line: heads and arcs keep their shape, line is as long as before.

    So two modes are neutral; on polygons they are so as edges are short, of either sign.
    """
    exact = film_at(*LINES_OF_THREE)
    energies, forces, lowest = [], [], []
    for edges in (180, 360):
        model, energy = held_along_lines(edges)
        energies.append(energy - exact.energy)
        forces.append(-model.tensions[edges:].sum() - exact.contact_force)
        lowest.append(model.eigenvalues[:3])
        # What the film pushes with on an edge: so exactly is a line's end known.
        assert abs(forces[-1]) < exact.tension / edges
    assert np.log2(energies[0] / energies[1]) == pytest.approx(2, abs=0.4)
    pairs = np.abs(lowest)
    np.testing.assert_allclose(pairs[:, 0], pairs[:, 1], rtol=1e-6)
    assert pairs[0, 0] / pairs[1, 0] > 1.5
    assert lowest[1][2] > 0


@pytest.mark.parametrize("film", [POINT[3], pytest.param(LINE[0], marks=pytest.mark.slow)])
def test_errors_of_energy_and_force_are_of_second_order(
    film: tuple[int, float, float],
) -> None:
    exact = film_at(*film)
    found = [relaxed(film, edges) for edges in (84, 168)]
    for values, limit, band in (
        ([each.energy for each in found], exact.energy, 0.02),
        ([force(each) for each in found], exact.contact_force, 0.3),
    ):
        errors = np.abs(np.array(values) - limit)
        assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=band)


@pytest.mark.parametrize(
    "film",
    [
        POINT[1],
        pytest.param(POINT[5], marks=pytest.mark.slow),
        pytest.param(LINE[0], marks=pytest.mark.slow),
    ],
)
def test_slopes_of_the_energy_are_force_and_area(film: tuple[int, float, float]) -> None:
    _, load, diameter = film
    found = relaxed(film, 84)

    def energy(load: float, diameter: float) -> float:
        problem = Problem(shapes.fan(84), "area", in_plane=True, diameter=diameter)
        return solve(problem, load, found).energy

    h = 2e-3 * diameter
    slope = (energy(load, diameter + h) - energy(load, diameter - h)) / (2 * h)
    assert force(found) == pytest.approx(slope, rel=1e-4)
    h = 1e-3 * load
    slope = (energy(load + h, diameter) - energy(load - h, diameter)) / (2 * h)
    assert found.film_energy / load == pytest.approx(slope, rel=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize(
    "film", [POINT[1], pytest.param(POINT[-1], marks=pytest.mark.slow)]
)
def test_where_on_its_edges_a_loop_touches_itself_makes_little_difference(
    film: tuple[int, float, float],
) -> None:
    """Little beside the error of the edges, of the same order; and no other index."""
    exact, spreads = film_at(*film), []
    for edges in (84, 168):
        found = [relaxed(film, edges, shift) for shift in (0.0, 0.25, 0.5)]
        forces = [force(each) for each in found]
        spreads.append(np.ptp(forces))
        assert spreads[-1] < 0.1 * abs(forces[0] - exact.contact_force)
        for each in found:
            assert each.stability is not None
            assert each.stability.n_unstable == 0
    assert np.log2(spreads[0] / spreads[1]) > 1.75


@pytest.mark.parametrize(
    "loads",
    [
        [2200.0, 2600.0, 4000.0],
        pytest.param([4000.0, 5600.0, 6200.0, 7000.0], marks=pytest.mark.slow),
    ],
    ids=["point", "line"],
)
def test_a_sweep_in_the_plane_passes_an_onset_of_contact_and_comes_back(
    loads: list[float],
) -> None:
    diameter, mesh = 0.02, shapes.fan(84)
    limits = thresholds(2, diameter)
    problem = Problem(mesh, "area", in_plane=True, diameter=diameter)
    start = placed(film_at(2, loads[0], diameter), mesh)
    rows = list(sweep(problem, [*loads, *loads[-2::-1]], start))
    up, down = rows[: len(loads)], rows[: len(loads) - 2 : -1]
    for load, found, back in zip(loads, up, down, strict=True):
        assert found.status is Status.CONVERGED
        assert found.is_minimum
        assert found.contacts is not None
        assert (found.contacts.forces > 0).all()
        assert (np.abs(found.contacts.gaps) < 1e-10).all()
        touching = (load > limits.sigma_contact, load > limits.sigma_line_contact)
        assert (len(found.contacts) > 0, len(found.contacts) > 1) == touching
        assert found.contacts.smallest_gap > -2e-6 * diameter
        assert back.energy == pytest.approx(found.energy, rel=1e-6)
    # Minima of energies linear in the load: concave, and area is the slope.
    energies = np.array([found.energy for found in up])
    areas = np.array([found.film_energy / found.load for found in up])
    slopes = np.diff(energies) / np.diff(loads)
    assert (slopes < areas[:-1]).all()
    assert (slopes > areas[1:]).all()
