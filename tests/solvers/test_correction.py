"""Equilibria corrected to a higher order: exact films, flat and curved, and laws."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, make_interp_spline
from scipy.optimize import minimize_scalar

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import equilibrium
from eulerplateau.errors import EulerPlateauError
from eulerplateau.exact.conformal import ConformalFilm
from eulerplateau.exact.planar import PlanarFilm, planar_film
from eulerplateau.mesh import Disk, mesh_polygon
from eulerplateau.mesh.polygon import ellipse
from eulerplateau.solvers import Corrected, Equilibrium, Problem, Status, corrected, solve
from tests.helpers import shapes, soap_films
from tests.helpers.conformal_films import twisted
from tests.helpers.equilibria import distance_up_to_motion

Curve = Callable[[FloatArray], FloatArray]

DISK, LOBES, TWISTED = 1300.0, 1600.0, 1700.0
EDGES = [36, 48, 66, 90]
# Of the film against its mesh: no different one by symmetry.
ANGLE = 0.35


@cache
def flat(edges: int, load: float) -> tuple[Problem, Equilibrium]:
    """The film on an oval of so many equal edges, from a start out of its plane."""
    corners = ellipse(1.7, edges)
    longest = float(np.linalg.norm(np.diff(corners, axis=0), axis=1).max())
    problem = Problem(mesh_polygon(corners, edge_length=longest), "area")
    assert problem.disk.n_b == edges
    x = problem.disk.x.copy()
    x[:, 2] += 0.3 * x[:, 0] * x[:, 1]
    return problem, solve(problem, load, x)


@cache
def curved(rings: int) -> tuple[Problem, Equilibrium]:
    """The twisted film, a saddle, on a mesh without its symmetry."""
    mesh = soap_films.irregular_disk(rings)
    point = soap_films.on_the_exact_loop(mesh, twisted(TWISTED).film, ANGLE)
    return Problem(mesh, "area"), equilibrium(point)


def planar_curve(exact: PlanarFilm) -> Curve:
    """Its positions (n, 3) at arc lengths (n,)."""
    return lambda places: np.pad(exact.positions(places), ((0, 0), (0, 1)))


def curve_in_space(exact: ConformalFilm) -> Curve:
    """The same of a film without a mesh."""
    phi = np.linspace(0, 2 * np.pi, 8193)
    at = exact.basis.at(exact.coefficients, phi)
    speed = CubicSpline(phi, np.linalg.norm(at.x1, axis=1), bc_type="periodic")
    x = at.x.copy()
    x[-1] = x[0]
    length = speed.antiderivative()(phi)
    found = CubicSpline(length / length[-1], x, bc_type="periodic")
    return lambda places: found(places % 1.0)


def distance(curve: Curve, lengths: FloatArray, x: FloatArray) -> float:
    """How far a loop's vertices are from a curve that may slide along itself, in L."""
    places = np.cumsum(lengths) - lengths

    def after(slide: float) -> float:
        return distance_up_to_motion(x, curve(places + slide))

    first = np.linspace(0.0, 0.5, 24, endpoint=False)  # half a turn changes nothing
    best = first[np.argmin([after(slide) for slide in first])]
    near = (best - 0.5 / 24, best + 0.5 / 24)
    return float(minimize_scalar(after, bounds=near, options={"xatol": 1e-12}).fun)


def errors(
    exact: PlanarFilm | ConformalFilm, problem: Problem, found: Corrected | Equilibrium
) -> FloatArray:
    """Of the energy, of area and bending energy (the worse), relative; the shape's in L."""
    planar = isinstance(exact, PlanarFilm)
    curve = planar_curve(exact) if planar else curve_in_space(exact)
    area = (found.energy - found.bending_energy) / found.load
    bending = found.bending_energy / (exact.energy - found.load * exact.area)
    return np.array(
        [
            abs(found.energy / exact.energy - 1),
            max(abs(area / exact.area - 1), abs(bending - 1)),
            distance(curve, problem.loop.rest_lengths, found.shape.x_loop),
        ]
    )


@pytest.mark.parametrize("load", [DISK, LOBES])
def test_flat_films_are_right_to_fourth_order_in_all_they_say(load: float) -> None:
    """Or better; of the same meshes what is not corrected is of second order."""
    exact = planar_film(lobes=2, tension=load)
    assert_orders(exact, [flat(edges, load) for edges in EDGES])


def test_curved_films_are_right_to_fourth_order_in_all_they_say() -> None:
    """Against the film without a mesh."""
    assert_orders(twisted(TWISTED).film, [curved(rings) for rings in (6, 8, 10)])


def assert_orders(
    exact: PlanarFilm | ConformalFilm, known: list[tuple[Problem, Equilibrium]]
) -> None:
    """Second order of what is found, fourth or more of what is corrected."""
    sizes = [1 / problem.disk.n_b for problem, _ in known]
    plain = [errors(exact, problem, found) for problem, found in known]
    better = [errors(exact, problem, corrected(problem, found)) for problem, found in known]
    for before, after in zip(np.array(plain).T, np.array(better).T, strict=True):
        assert abs(shapes.fitted_order(sizes, list(before)) - 2) < 0.2
        # What is right to rounding from the first mesh on has no order.
        assert shapes.fitted_order(sizes, list(after)) > 3.8 or after.max() < 1e-11
        assert (after < 0.01 * before).all()


def test_what_changes_is_about_the_error_and_its_square_about_what_is_left() -> None:
    for exact, (problem, found) in (
        (planar_film(lobes=2, tension=LOBES), flat(48, LOBES)),
        (twisted(TWISTED).film, curved(8)),
    ):
        better = corrected(problem, found)
        energy, worst, shape = errors(exact, problem, found)
        area, bent = exact.area, exact.energy - found.load * exact.area
        assert np.isclose(abs(better.energy_change), energy * exact.energy, rtol=0.01)
        changes = abs(better.area_change) / area, abs(better.bending_change) / bent
        assert np.isclose(max(changes), worst, rtol=0.01)
        assert shape / 3 < better.moved < 3 * shape
        assert errors(exact, problem, better)[:2].max() < better.error_estimate


def test_disk_that_buckles_on_its_mesh_alone_is_made_round_again() -> None:
    """Below 48 pi^3 the disk is stable; on 36 edges it has two lobes 2.5 % below that."""
    load = 47.4 * np.pi**3
    problem, found = flat(36, load)

    def roundness(x: FloatArray) -> float:
        radii = np.linalg.norm(x - x.mean(axis=0), axis=1)
        return float(radii.min() / radii.max())

    better = corrected(problem, found)
    assert roundness(found.shape.x_loop) < 0.9
    assert roundness(better.shape.x_loop) > 0.99
    assert np.isclose(better.energy, load / (4 * np.pi) + 4 * np.pi**2, rtol=1e-5)


@pytest.mark.parametrize("bent", [False, True])
def test_energy_grows_with_the_load_by_the_area(bent: bool) -> None:
    """dE/d load = A of equilibria (Hellmann and Feynman), by differences of fourth order.

    From one equilibrium, which the correction brings to rest at loads near by as well.
    """
    problem, found = curved(8) if bent else flat(48, LOBES)

    def energy(change: float) -> float:
        load = found.load + change
        near = replace(found, load=load, film_energy=found.film_energy * load / found.load)
        return corrected(problem, near).energy

    near, far = energy(5.0) - energy(-5.0), energy(10.0) - energy(-10.0)
    slope = (8 * near - far) / 60.0
    assert np.isclose(slope, corrected(problem, found).area, rtol=1e-4)


@pytest.mark.parametrize("bent", [False, True])
def test_edges_keep_their_lengths_along_the_curve(bent: bool) -> None:
    """Those of a spline of scipy's, not ours, by the arc lengths at rest."""
    problem, found = curved(8) if bent else flat(66, LOBES)
    lengths, smooth = problem.loop.rest_lengths, corrected(problem, found).shape.x_loop
    places = np.concatenate([[0.0], np.cumsum(lengths)])

    def excess(x: FloatArray) -> FloatArray:
        closed = np.concatenate([x, x[:1]])
        along = make_interp_spline(places, closed, k=5, bc_type="periodic").derivative()
        fine = np.linspace(0.0, places[-1], 20000)
        speed = np.linalg.norm(along(fine), axis=1)
        arcs: FloatArray = np.diff(CubicSpline(fine, speed).antiderivative()(places))
        return np.abs(arcs / lengths - 1)

    assert excess(smooth).max() < 1e-4 * excess(found.shape.x_loop).max()


@pytest.mark.parametrize("bent", [False, True])
def test_moved_and_renumbered_it_is_the_same(bent: bool) -> None:
    problem, found = curved(6) if bent else flat(36, LOBES)
    one, disk = corrected(problem, found), problem.disk
    new = np.random.default_rng(1).permutation(disk.n_v)
    turn = shapes.rotation()
    x, rest = np.empty_like(disk.x), np.empty_like(disk.x)
    x[new], rest[new] = found.shape.x @ turn + 0.4, disk.x
    triangles = new[found.shape.triangles]
    first = 5
    loop, lengths = np.roll(new[disk.loop], first), np.roll(disk.rest_lengths, first)
    other = Problem(Disk(rest, triangles, loop, lengths, 1.0), "area")
    moved = replace(found, shape=other.disk.shape.moved(x))
    two = corrected(other, moved)
    assert np.isclose(two.energy, one.energy, rtol=1e-9)
    assert np.isclose(two.area, one.area, rtol=1e-8)
    gap = two.shape.x[new] - (one.shape.x @ turn + 0.4)
    assert np.abs(gap[disk.loop]).max() < 1e-6


def test_it_says_what_it_is_and_what_changed() -> None:
    problem, found = flat(36, LOBES)
    better = corrected(problem, found)
    assert np.isclose(better.energy, better.load * better.area + better.bending_energy)
    assert better.found is found
    assert repr(better).startswith("<Corrected at load 1600: energy 166.2")
    assert np.array_equal(better.shape.triangles, found.shape.triangles)
    assert better.unevenness < 1e-4


@pytest.mark.parametrize(
    ("settings", "word"),
    [
        ({"film": "springs"}, "film: found QuadraticFilm"),
        ({"film": "area", "in_plane": True}, "film: found PlaneFilm"),
        ({"film": "area", "twist_ratio": 0.7}, "loop: resists twist"),
        ({"film": "area", "diameter": 0.02}, "diameter: should be none"),
    ],
)
def test_other_films_and_loops_are_refused_in_a_line(
    oval: Disk, settings: dict[str, str | bool | float], word: str
) -> None:
    _, found = flat(36, LOBES)
    with pytest.raises(EulerPlateauError, match=word) as refused:
        corrected(Problem(oval, **settings), found)  # type: ignore[arg-type]
    assert "\n" not in str(refused.value)


def test_what_is_no_equilibrium_of_the_problem_is_refused(oval: Disk) -> None:
    problem, found = flat(36, LOBES)
    with pytest.raises(EulerPlateauError, match="stalled"):
        corrected(problem, replace(found, status=Status.STALLED))
    longer = replace(oval, rest_lengths=1.1 * oval.rest_lengths)
    with pytest.raises(EulerPlateauError, match="another problem"):
        corrected(Problem(longer, "area"), found)
