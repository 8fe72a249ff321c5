"""A soap film relaxed on its loop: derivatives by the loop, limits, exact surfaces."""

from __future__ import annotations

import gc
import weakref

import numpy as np
import pytest
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.film.area import (
    local_film,
)
from eulerplateau.film.harmonic import balance, follow_loop, follower
from eulerplateau.film.interior import (
    FilmAtRest,
    LocalFilm,
)
from eulerplateau.film.models import (
    area,
)
from eulerplateau.film.tiling import Tiling
from eulerplateau.loop.loop import Loop
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.polygon import (
    polygon_area,
    polygon_gradient,
)
from tests.helpers import shapes, twins

RADIUS = 0.8  # of Enneper's surface: stable as a film up to 1


def enneper(rings: int, radius: float = RADIUS, jitter: float = 0.2) -> Disk:
    points, triangles = shapes.disk_points(rings, jitter)
    return shapes.mesh_of(shapes.enneper(points, radius), triangles)


def tiling_of(mesh: Disk) -> Tiling:
    return area(mesh).tiling(mesh.triangles)


def relaxed(mesh: Disk) -> FilmAtRest:
    return local_film(tiling_of(mesh), mesh.x).relax(mesh.x[mesh.loop])


@pytest.fixture(scope="module")
def local() -> LocalFilm:
    """At a curved film that is not at rest, and without symmetry."""
    mesh = enneper(4)
    turned = shapes.rotation()
    return local_film(tiling_of(mesh), (mesh.x * [1.1, 1.0, 0.8]) @ turned.T)


@pytest.mark.parametrize("mesh", [shapes.mesh_of(*shapes.disk_points(4)), enneper(4)])
def test_films_go_once_nothing_holds_them(mesh: Disk) -> None:
    """At once, whatever has been asked of them: of large ones that is hundreds of MiB."""
    local = local_film(tiling_of(mesh), mesh.x)
    loop = mesh.x[mesh.loop]
    gc.disable()
    try:
        film = local.relax(loop)
        assert film.hessian.shape == (loop.size, loop.size)
        gone = [weakref.ref(film), weakref.ref(local)]
        del film, local
        assert [each() for each in gone] == [None, None]
    finally:
        gc.enable()


def test_force_on_the_loop_leaves_a_remainder_of_second_order(local: LocalFilm) -> None:
    x_loop = local.x[local.tiling.loop]

    def condensed(x: FloatArray) -> tuple[float, FloatArray]:
        found = local.relax(x)
        return found.area, found.force

    slope = twins.taylor_slope(condensed, x_loop, shapes.wave(len(local.tiling.loop), 0.05))
    assert slope == pytest.approx(2.0, abs=0.05)


def test_an_array_that_was_changed_is_another_loop(local: LocalFilm) -> None:
    """Films asked for are known again by their loops, and not by who holds these."""
    x_loop = local.x[local.tiling.loop]
    before = local.relax(x_loop).area
    x_loop *= 1.01
    assert local.relax(x_loop).area == pytest.approx(1.01**2 * before, rel=1e-6)


def test_film_follows_its_loop_to_first_order(local: LocalFilm) -> None:
    x_loop = local.x[local.tiling.loop]
    here, step = local.relax(x_loop), shapes.wave(len(local.tiling.loop), 1e-5)
    there = local.relax(x_loop + step)
    moved = here.displacement(step)
    np.testing.assert_array_equal(moved[local.tiling.loop], step)
    gap = np.abs(there.x - here.x - moved).max()
    assert gap < 1e-3 * np.abs(moved).max()


def test_film_at_rest_has_no_force_along_the_normals_inside(local: LocalFilm) -> None:
    film = local.tiling
    found = local.relax(local.x[film.loop] + shapes.wave(len(local.tiling.loop), 0.02))
    along = (found.gradient[film.interior] * local.normals).sum(axis=1)
    assert np.abs(along).max() < 1e-15
    assert (
        found.area < film.sides(follow_loop(film, local.x, found.x[film.loop])).areas.sum()
    )


def test_balance_is_the_force_of_a_film_made_at_the_shape() -> None:
    mesh = enneper(4)
    x = mesh.x
    for _ in range(10):
        found = local_film(tiling_of(mesh), x).relax(mesh.x[mesh.loop])
        x = found.x
    assert found.central
    forces = balance(tiling_of(mesh), found.x)
    np.testing.assert_allclose(forces[mesh.loop], found.force, atol=1e-12)
    # Inside nothing is left but what the normals there and the film's own differ by.
    assert np.abs(forces[mesh.interior]).max() < 1e-12


def test_film_on_a_flat_loop_is_its_polygon(oval: Disk) -> None:
    local = local_film(tiling_of(oval), shapes.crumpled(oval, 1e-3) * [1.0, 1.0, 0.0])
    x_loop = oval.x[oval.loop] * [1.05, 0.9, 0.0]
    found = local.relax(x_loop)
    assert found.area == pytest.approx(polygon_area(x_loop[:, :2]), rel=1e-14)
    np.testing.assert_allclose(
        found.force[:, :2], polygon_gradient(x_loop[:, :2]), atol=1e-15
    )
    np.testing.assert_allclose(found.force[:, 2], 0, atol=1e-15)
    np.testing.assert_array_equal(found.u, 0)


def test_harmonic_values_are_linear_ones_on_a_flat_film_and_within_the_loops() -> None:
    mesh = shapes.mesh_of(*shapes.disk_points(5, jitter=0.1))
    film = tiling_of(mesh)
    linear = np.column_stack([np.ones(mesh.n_v), mesh.x @ [0.3, -2.0, 0.0]])
    found = follower(film, film.sides(mesh.x)).extend(linear[mesh.loop])
    np.testing.assert_allclose(found, linear, atol=1e-14)


def distance(x: FloatArray, start: FloatArray) -> FloatArray:
    """Distances (n,) of points (n, 3) from Enneper's surface, Gauss-Newton from (u, v)."""
    uv = start
    for _ in range(20):
        u, v = uv.T
        along_u = np.stack([1 - u**2 + v**2, 2 * u * v, 2 * u], axis=1)
        along_v = np.stack([2 * u * v, 1 - v**2 + u**2, -2 * v], axis=1)
        gap = x - shapes.enneper(uv, 1.0)
        # Conformal parameters: the tangents are orthogonal and of equal length.
        part = np.stack([(gap * along_u).sum(axis=1), (gap * along_v).sum(axis=1)], axis=1)
        uv = uv + part / (along_u**2).sum(axis=1)[:, None]
    return np.asarray(np.linalg.norm(x - shapes.enneper(uv, 1.0), axis=1))


@pytest.mark.parametrize("jitter", [0.0, 0.2])
def test_film_converges_to_ennepers_surface_at_second_order(jitter: float) -> None:
    """Area pi ((1 + R^2)^3 - 1) / 3 for the radius R in the conformal parameters."""
    exact = np.pi * ((1 + RADIUS**2) ** 3 - 1) / 3
    rings = [6, 9, 13, 19]
    areas, distances, sliding = [], [], []
    for number in rings:
        points, triangles = shapes.disk_points(number, jitter)
        surface = shapes.enneper(points, RADIUS)
        mesh = shapes.mesh_of(surface, triangles)
        found = relaxed(mesh)
        areas.append(found.area * mesh.length**2 - exact)
        x = found.x * mesh.length + surface[mesh.loop].mean(axis=0)
        inside = mesh.interior
        distances.append(distance(x[inside], RADIUS * points[inside]).max())
        # What is left inside is along the film: per vertex, in units of an edge's pull.
        remainder = np.linalg.norm(found.gradient[inside], axis=1) * number
        sliding.append(np.sqrt((remainder**2).mean()))
    sizes = [1 / number for number in rings]
    assert shapes.fitted_order(sizes, areas) == pytest.approx(2.0, abs=0.1)
    assert shapes.fitted_order(sizes, distances) == pytest.approx(2.0, abs=0.1)
    assert shapes.fitted_order(sizes, sliding) > 1.95
    assert areas[-1] < 0 < exact  # inscribed


def test_pull_on_an_even_loop_is_along_the_conormal_to_second_order() -> None:
    """dA/dx_b per length is the outward conormal -T of the exact surface, of length 1."""
    rings, errors = [6, 9, 13, 19], []
    for number in rings:
        points, triangles = shapes.disk_points(number)
        mesh = shapes.mesh_of(shapes.enneper(points, RADIUS), triangles)
        u, v = (RADIUS * points[mesh.loop]).T
        outward = np.stack([u - u**3 + 3 * u * v**2, v + 3 * u**2 * v - v**3], axis=1)
        outward = np.column_stack([outward, 2 * (u**2 - v**2)])
        outward /= np.linalg.norm(outward, axis=1)[:, None]
        per_length = relaxed(mesh).force / Loop(mesh.rest_lengths).mean_lengths[:, None]
        errors.append(float(np.abs(per_length - outward).max()))
    order = shapes.fitted_order([1 / number for number in rings], errors)
    assert order == pytest.approx(2.0, abs=0.1)


def test_loop_without_a_stable_film_near_by_is_refused() -> None:
    """Enneper's surface is a saddle of the area beyond R = 1, where K encloses 2 pi."""
    relaxed(enneper(6, 0.95, jitter=0.0))
    with pytest.raises(LinAlgError):
        relaxed(enneper(6, 1.3, jitter=0.0))


def test_loop_that_folds_the_film_over_is_refused(local: LocalFilm) -> None:
    x_loop = local.x[local.tiling.loop]
    mirrored = x_loop[::-1]
    with pytest.raises(LinAlgError):
        local.relax(mirrored)
    # It is none the worse for it.
    assert local.relax(x_loop).area > 0


def test_film_holds_until_it_has_tilted_by_26_degrees(local: LocalFilm) -> None:
    """The cosine is 0.9 then, wherever the axis lies in the film."""
    normal = local.tiling.sides(local.x).normals.mean(axis=0)
    along = np.cross(normal, [1.0, 0.0, 0.0])
    k = along / np.linalg.norm(along)
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    for degrees, holds in ((0.0, True), (15.0, True), (40.0, False), (80.0, False)):
        angle = np.radians(degrees)
        turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
        assert local.holds(local.tiling.sides(local.x @ turn.T)) is holds
