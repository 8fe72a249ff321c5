"""Films of curved triangles on smooth loops: exact minimal surfaces, derivatives."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.film.curved_film import CurvedNeighbour, FlatFilm, SmoothFilm, smooth_film
from eulerplateau.film.curved_triangles import CurvedTriangles
from eulerplateau.film.models import area
from eulerplateau.loop import Splines
from eulerplateau.mesh.disk import Disk
from tests.helpers import shapes

RADIUS = 0.7  # of Enneper's surface: stable as a film up to 1
RINGS = [4, 6, 8, 11]


def enneper(rings: int, jitter: float) -> tuple[Disk, float]:
    """A mesh on Enneper's surface, and the unit of the formulas in its own units."""
    points, triangles = shapes.disk_points(rings, jitter)
    raw = shapes.enneper(points, RADIUS)
    mesh = shapes.mesh_of(raw, triangles)
    unit = np.linalg.norm(mesh.x[1] - mesh.x[0]) / np.linalg.norm(raw[1] - raw[0])
    return mesh, float(unit)


def splines_of(mesh: Disk, unit: float) -> Splines:
    """On the loop the surface is R (1 + R^2) times as long as in the plane of u and v."""
    points, _ = shapes.disk_points(mesh.n_b // 6, 0.2)
    edge = points[mesh.loop]
    turns = np.unwrap(np.arctan2(edge[:, 1], edge[:, 0]))
    steps = np.diff(turns, append=turns[0] + 2 * np.pi)
    return Splines(unit * RADIUS * (1 + RADIUS**2) * steps)


def known(mesh: Disk) -> SmoothFilm:
    film = area(mesh).of_loop(mesh.shape)
    return smooth_film(film, mesh.x[mesh.loop])


def test_area_of_enneper_s_surface_is_right_to_fourth_order() -> None:
    """That over a disk of radius R is pi (R^2 + R^4 + R^6 / 3); meshes are irregular."""
    exact = np.pi * (RADIUS**2 + RADIUS**4 + RADIUS**6 / 3)
    errors, plain = [], []
    for rings in RINGS:
        mesh, unit = enneper(rings, 0.2)
        film, loop = known(mesh), splines_of(mesh, unit).through(mesh.x[mesh.loop])
        assert isinstance(film, CurvedNeighbour)
        errors.append(film.at_rest(loop, None).area / (exact * unit**2) - 1)
        plain.append(film.plane.area / (exact * unit**2) - 1)
    sizes = [1 / rings for rings in RINGS]
    assert shapes.fitted_order(sizes, errors) > 3.7
    assert shapes.fitted_order(sizes, plain) < 2.3
    assert abs(errors[0]) < 0.02 * abs(plain[0])


@pytest.mark.parametrize("bent", [False, True])
def test_gradient_is_that_of_the_area_at_rest(bent: bool) -> None:
    """By differences, the film relaxed anew on every loop."""
    mesh, unit = enneper(5, 0.2)
    if not bent:
        mesh = Disk.from_triangles(mesh.x * [1.0, 1.0, 0.0], mesh.triangles)
    film, splines = known(mesh), splines_of(mesh, unit)
    assert isinstance(film, CurvedNeighbour if bent else FlatFilm)
    x = mesh.x[mesh.loop]
    step = shapes.wave(len(x), 1e-3)
    if not bent:
        step[:, 2] = 0.0
    before = film.at_rest(splines.through(x), None)
    after, behind = (
        film.at_rest(splines.through(x + sign * step), before).area for sign in (1, -1)
    )
    slope = float(np.vdot(splines.pulled_back(before.gradient), step))
    assert np.isclose((after - behind) / 2, slope, rtol=1e-4)


def curved(jitter: float) -> tuple[CurvedTriangles, FloatArray]:
    """Nodes of a bent film, none in the middle of its edge."""
    mesh, _ = enneper(3, 0.1)
    triangles = CurvedTriangles.of(mesh.triangles, mesh.loop, mesh.n_v)
    nodes = triangles.spread(mesh.x)
    return triangles, nodes + jitter * np.random.default_rng(0).standard_normal(nodes.shape)


def test_first_and_second_derivative_of_the_area() -> None:
    triangles, x = curved(1e-3)
    rng = np.random.default_rng(1)
    directions, heights = rng.standard_normal(x.shape), rng.standard_normal(triangles.size)
    step, film = heights[:, None] * directions, triangles.at(x)
    slope = float(np.vdot(film.gradient, step))
    along = heights[triangles.nodes]
    bend = float(np.einsum("ti,tij,tj->", along, film.stiffness(directions), along))
    sizes = [8e-5, 4e-5, 2e-5]
    changes = [triangles.at(x + t * step).area - film.area for t in sizes]
    first = [change - t * slope for change, t in zip(changes, sizes, strict=True)]
    second = [left - t**2 / 2 * bend for left, t in zip(first, sizes, strict=True)]
    assert abs(shapes.fitted_order(sizes, first) - 2) < 0.1
    assert abs(shapes.fitted_order(sizes, second) - 3) < 0.1


def test_spreading_and_gathering_are_adjoint() -> None:
    triangles, x = curved(0.0)
    rng = np.random.default_rng(2)
    values, forces = rng.standard_normal((triangles.n_v, 3)), rng.standard_normal(x.shape)
    work = np.vdot(triangles.spread(values), forces)
    assert np.isclose(work, np.vdot(values, triangles.gathered(forces)), rtol=1e-12)


def test_flat_triangles_have_the_area_of_their_polygon() -> None:
    mesh, _ = enneper(3, 0.1)
    triangles = CurvedTriangles.of(mesh.triangles, mesh.loop, mesh.n_v)
    film = triangles.at(triangles.spread(mesh.x))
    plane = area(mesh).tiling(mesh.triangles).sides(mesh.x)
    assert np.isclose(film.area, plane.areas.sum(), rtol=1e-13)
