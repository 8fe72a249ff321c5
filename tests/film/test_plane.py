"""A film kept in its plane: its energy, and convergence to the exact planar films."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import MeshError
from eulerplateau.exact.planar import planar_film
from eulerplateau.film.plane import (
    PlaneFilm,
    plane_film,
)
from eulerplateau.loop import Loop, project_lengths
from eulerplateau.mesh.curvature import loop_frame
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.measures import Measurer
from eulerplateau.mesh.polygon import (
    polygon_area,
    polygon_gradient,
)
from eulerplateau.solvers import Problem, Status, solve, tangent_model
from eulerplateau.solvers.in_plane.newton import settle_in_plane
from tests.helpers import shapes, twins
from tests.helpers.equilibria import distance_up_to_motion, energy_in_plane
from tests.helpers.marks import quick_with

# Loop edges; multiples of twelve have vertices at all tips and waists of an even loop.
EDGES = (72, 108, 168)


def turned(mesh: Disk) -> Disk:
    """The mesh in a plane of no special direction, its film seen from below."""
    flip = np.diag([1.0, -1.0, -1.0]) @ shapes.rotation()
    return Disk.from_triangles(mesh.x @ flip, mesh.triangles)


def test_energy_is_the_load_times_the_area_of_the_polygon(oval: Disk) -> None:
    for mesh in (oval, turned(oval)):
        film = plane_film(mesh)
        exact = film.soap.energy_gradient(mesh.shape, 3.0)
        energy, gradient = film.energy_gradient(mesh.shape, 3.0)
        assert energy == pytest.approx(exact[0], rel=1e-13)
        np.testing.assert_allclose(gradient[mesh.loop], exact[1][mesh.loop], atol=1e-14)
        assert not gradient[mesh.interior].any()


def test_gradient_of_a_polygon_is_exact_and_its_area_quadratic(oval: Disk) -> None:
    film = plane_film(oval)
    rng = np.random.default_rng(8)
    x, p = shapes.crumpled(oval, 0.01), rng.standard_normal(oval.x.shape)

    def energy(y: FloatArray) -> tuple[float, FloatArray]:
        return film.energy_gradient(oval.shape.moved(y), 2.0)

    slope = twins.taylor_slope(energy, x, 0.1 * p)
    assert slope == pytest.approx(2.0, abs=1e-3)
    square = np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]])
    assert polygon_area(square) == 2.0
    assert polygon_area(square[::-1]) == -2.0
    # The gradient is linear, so halfway it gives the whole change.
    step = rng.standard_normal((4, 2))
    change = np.vdot(step, polygon_gradient(square + 0.5 * step))
    assert change == pytest.approx(polygon_area(square + step) - 2.0, rel=1e-13)


def test_hessian_of_the_energy_in_the_plane_leaves_nothing(oval: Disk) -> None:
    """E + lambda . c is quadratic where lambda is held, once lengths are forgotten."""
    film = plane_film(oval)
    energy = plane_film(oval).of_loop(oval.shape).energy(Loop(oval.rest_lengths), 700.0)
    x = oval.x[oval.loop] @ film.axes.T
    step = 0.01 * np.random.default_rng(3).standard_normal(x.shape)
    hessian = energy.lagrangian_hessian(x, np.zeros(oval.n_b))
    force, after = sum(energy.forces(x)), sum(energy.forces(x + step))
    np.testing.assert_allclose(
        (hessian @ step.ravel()).reshape(x.shape), after - force, atol=1e-9
    )
    change = np.vdot(step, force) + 0.5 * step.ravel() @ hessian @ step.ravel()
    assert energy.change(x, step) == pytest.approx(change, rel=1e-12)


def test_mesh_that_is_not_flat_has_no_plane_to_be_kept_in(oval: Disk) -> None:
    bent = Disk.from_triangles(
        oval.x + 1e-6 * np.outer(oval.x[:, 0] ** 2, [0, 0, 1]), oval.triangles
    )
    with pytest.raises(MeshError) as caught:
        Problem(bent, "area", in_plane=True)
    assert caught.value.exit_code == 3
    assert (caught.value.kind, caught.value.index) == ("mesh", None)


@pytest.mark.parametrize("jitter", [0.0, 0.2], ids=["even", "uneven"])
@pytest.mark.parametrize(
    "sigma_hat", quick_with([1600.0, 2400.0], [1600.0, 2000.0, 2400.0])
)
def test_two_lobed_film_on_meshes_converges_at_second_order(
    sigma_hat: float, jitter: float
) -> None:
    exact = planar_film(2, sigma_hat)
    errors = []
    for edges in EDGES:
        mesh = shapes.mesh_of(*shapes.disk_points(edges // 6, jitter))
        problem = Problem(mesh, "area", in_plane=True)
        start = mesh.x * [1.2, 0.8, 1.0]
        found = solve(problem, sigma_hat, start)
        assert found.status is Status.CONVERGED
        assert found.n_unstable == 0
        kappa = loop_frame(Measurer(mesh).disk_of(found.shape), found.shape.x).kappa_g
        errors.append(
            [
                found.energy - exact.energy,
                found.film_energy / sigma_hat - exact.area,
                kappa.max() - exact.kappa_max,
                kappa.min() - exact.kappa_min,
            ]
        )
    sizes = [1 / edges for edges in EDGES]
    for column in np.transpose(errors).tolist():
        assert shapes.fitted_order(sizes, column) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize(
    ("n", "sigma_hat"), [(2, 1600.0), (2, 2000.0), (2, 2400.0), (3, 4500.0)]
)
def test_equilibrium_next_to_the_exact_shape_converges_to_it(
    n: int, sigma_hat: float
) -> None:
    """Stable or not: with three lobes it is a saddle in the plane."""
    exact = planar_film(n, sigma_hat)
    errors = []
    for edges in EDGES:
        loop = Loop(np.full(edges, 1 / edges))
        sampled = exact.positions(np.arange(edges) / edges)
        start = project_lengths(loop, sampled)
        assert start is not None
        energy = energy_in_plane(loop, sigma_hat)
        found = settle_in_plane(loop, sigma_hat, start, 20)
        assert found is not None
        model = tangent_model(energy, found.x)
        assert model.residual < 1e-9
        unstable = int((model.eigenvalues < 0).sum())
        assert (unstable > 0) == (n == 3)
        tangent = loop.chords(found.x) * edges
        turn = tangent - np.roll(tangent, 1, axis=0)
        left = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
        bend = np.linalg.norm(turn, axis=1) * edges * np.sign((turn * left).sum(axis=1))
        total = sigma_hat * polygon_area(found.x) + (bend**2).sum() / edges
        errors.append(
            [
                total - exact.energy,
                bend.max() - exact.kappa_max,
                bend.min() - exact.kappa_min,
                distance_up_to_motion(found.x, sampled),
            ]
        )
    sizes = [1 / edges for edges in EDGES]
    for column in np.transpose(errors).tolist():
        assert shapes.fitted_order(sizes, column) == pytest.approx(2.0, abs=0.1)


def test_three_lobed_saddle_is_reached_from_a_rough_guess() -> None:
    edges, sigma_hat = 120, 4500.0
    loop = Loop(np.full(edges, 1 / edges))
    turns = 2 * np.pi * np.arange(edges) / edges
    radius = (1 + 0.3 * np.cos(3 * turns)) / (2 * np.pi)
    guess = radius[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    start = project_lengths(loop, guess)
    assert start is not None
    found = settle_in_plane(loop, sigma_hat, start, 20)
    assert found is not None
    exact = planar_film(3, sigma_hat).positions(np.arange(edges) / edges)
    assert distance_up_to_motion(found.x, exact) < 0.002


@pytest.mark.parametrize("solver", ["newton", "cg"])
def test_start_that_lies_face_down_is_turned_over(solver: str) -> None:
    """Its loop runs clockwise, round a negative area that more tension would enlarge."""
    points, triangles = shapes.disk_points(4, jitter=0.2)
    mesh = shapes.mesh_of(points * [1.5, 1.0], triangles)
    problem = Problem(mesh, "area", in_plane=True)
    down, up = (
        solve(problem, 1000.0, mesh.x * [1.0, side, 1.0], solver=solver)
        for side in (-1.0, 1.0)
    )
    assert down.status is up.status is Status.CONVERGED
    assert down.energy == pytest.approx(up.energy, rel=1e-6)
    assert down.film_energy > 0


def test_film_turned_inside_out_is_no_equilibrium(oval: Disk) -> None:
    problem = Problem(oval, "area", in_plane=True)
    found = problem.equilibrium(
        problem.shape(oval.x * [1.0, -1.0, 1.0]),
        np.zeros(oval.n_b),
        100.0,
        Status.CONVERGED,
    )
    assert problem.classified(found).status is Status.PINCHED


def test_film_stays_in_its_plane_and_in_good_triangles(oval: Disk) -> None:
    mesh = turned(oval)
    problem = Problem(mesh, "area", in_plane=True)
    film = problem.film
    assert isinstance(film, PlaneFilm)
    start = shapes.crumpled(mesh, 2e-3)
    found = solve(problem, 1500.0, start)
    assert found.status is Status.CONVERGED
    normal = np.cross(*film.axes)
    assert np.abs(found.shape.x @ normal).max() < 1e-15
    sides = film.soap.tiling(found.shape.triangles).sides(found.shape.x)
    assert sides.smallest_angle > 12
    assert sides.areas.sum() == pytest.approx(found.film_energy / 1500, rel=1e-12)
    assert (sides.normals @ normal > 0.999).all()


def test_place_far_from_the_origin_costs_the_area_no_digits(oval: Disk) -> None:
    """A billion sizes away, of a polygon whose corners are known there exactly."""
    corners = np.ldexp(np.round(np.ldexp(oval.x[oval.loop][:, :2], 20)), -20)
    far = corners + np.ldexp([1.0, -3.0], 30)
    np.testing.assert_array_equal(far - np.ldexp([1.0, -3.0], 30), corners)
    assert polygon_area(far) == pytest.approx(polygon_area(corners), rel=1e-13)
