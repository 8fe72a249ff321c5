"""The area's second variation by the loop: against all of the Hessian, and differences."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.film.area import (
    Area,
    local_film,
)
from eulerplateau.film.interior import (
    LocalFilm,
)
from eulerplateau.film.models import (
    area,
)
from eulerplateau.loop import Loop, free_motions, inextensible
from eulerplateau.mesh.disk import Disk
from tests.helpers import shapes, soap_films, twins

RADIUS = 0.8  # of Enneper's surface: stable as a film up to 1


def enneper(rings: int, jitter: float) -> Disk:
    points, triangles = shapes.disk_points(rings, jitter)
    return shapes.mesh_of(shapes.enneper(points, RADIUS), triangles)


def made_at(mesh: Disk, x: FloatArray) -> LocalFilm:
    return local_film(area(mesh).tiling(mesh.triangles), x)


@pytest.fixture(scope="module")
def local() -> LocalFilm:
    """At a curved film that is not at rest, and without symmetry."""
    mesh = enneper(4, 0.2)
    turned = shapes.rotation()
    return made_at(mesh, (mesh.x * [1.1, 1.0, 0.8]) @ turned.T)


def whole(local: LocalFilm, x: FloatArray) -> FloatArray:
    """The Hessian by the loop (3 n_b) and then by the heights (n_i), nothing eliminated."""
    varied, film = local.variations, local.tiling
    n_b, inside = len(film.loop), film.interior
    columns = np.zeros((film.n_v, 3, 3 * n_b + len(inside)))
    for d in range(3):
        columns[np.arange(film.n_v), d, 3 * varied.strip.leader + d] = varied.strip.weight
    columns[inside, :, 3 * n_b + np.arange(len(inside))] = local.normals
    flat = columns.reshape(3 * film.n_v, -1)
    found: FloatArray = flat.T @ (soap_films.hessian(film, x) @ flat)
    return found


def test_condensed_hessian_is_the_schur_complement(local: LocalFilm) -> None:
    x_loop = local.x[local.tiling.loop] + shapes.wave(len(local.tiling.loop), 0.01)
    found = local.relax(x_loop)
    hessian, n = whole(local, found.x), x_loop.size
    coupling = hessian[n:, :n]
    expected = hessian[:n, :n] - coupling.T @ np.linalg.solve(hessian[n:, n:], coupling)
    scale = np.abs(expected).max()
    np.testing.assert_allclose(found.hessian, expected, atol=1e-12 * scale)
    np.testing.assert_array_equal(found.hessian, found.hessian.T)


@pytest.mark.parametrize("free", [False, True])
def test_product_with_the_hessian_needs_none(local: LocalFilm, free: bool) -> None:
    if free:
        film = area(mesh := enneper(4, 0.2)).of_loop(mesh.shape)
        local = film.released(mesh.x[mesh.loop]).local
    assert local.is_free == free
    step = shapes.wave(n := len(local.tiling.loop), 1.0)
    x_loop = local.x[local.tiling.loop] + shapes.wave(n, 0.01)
    product = local.relax(x_loop).product(step)
    expected = (local.relax(x_loop).hessian @ step.ravel()).reshape(n, 3)
    np.testing.assert_allclose(product, expected, atol=1e-10 * np.abs(expected).max())


@pytest.mark.parametrize("load", [30.0, 3000.0])
def test_condensed_hessian_has_the_index_of_the_whole(
    local: LocalFilm, load: float
) -> None:
    """Sylvester's law: the eliminated block is positive definite, so the index stays."""
    loop = Loop(np.full(len(local.tiling.loop), 1 / len(local.tiling.loop)))
    energy = inextensible(loop, Area(local, load), partial(free_motions, loop, slides=True))
    x_loop = local.x[local.tiling.loop] + shapes.wave(len(local.tiling.loop), 0.01)
    condensed = energy.lagrangian_hessian(x_loop, np.zeros(len(local.tiling.loop)))
    full, n = load * whole(local, local.relax(x_loop).x), len(condensed)
    full[:n, :n] += np.kron(2 * loop.bending_matrix, np.eye(3))
    indices = []
    for hessian in (condensed, full):
        values = np.linalg.eigvalsh(hessian)
        # Translations cost nothing, and rounding would decide their sign.
        indices.append(int((values < -1e-12 * values[-1]).sum()))
    assert indices[0] == indices[1]
    assert (indices[0] > 0) == (load > 1000)


def test_hessian_of_a_flat_film_leaves_a_remainder_of_third_order(oval: Disk) -> None:
    local = made_at(oval, oval.x)
    x_loop = oval.x[oval.loop]
    hessian = local.relax(x_loop).hessian

    def curved(x: FloatArray) -> tuple[float, FloatArray]:
        moved = (x - x_loop).ravel()
        found, bent = local.relax(x), hessian @ moved
        return found.area - 0.5 * float(moved @ bent), found.force - bent.reshape(-1, 3)

    # Steep enough for the film to leave its plane, and its polygon to change.
    slope = twins.taylor_slope(curved, x_loop, shapes.wave(len(local.tiling.loop), 0.05))
    assert slope == pytest.approx(3.0, abs=0.1)


@pytest.mark.parametrize("jitter", [0.0, 0.2])
def test_hessian_is_the_forces_derivative_to_second_order_in_the_mesh(
    jitter: float,
) -> None:
    """On curved films; displacements are the same on every mesh, per length of the loop."""
    rings, gaps = [10, 14, 20, 28, 40], []
    for number in rings:
        mesh = enneper(number, jitter)
        local = made_at(mesh, mesh.x)
        x_loop = mesh.x[mesh.loop]
        step = shapes.wave(len(local.tiling.loop), 1e-4)
        ahead, behind = local.relax(x_loop + step), local.relax(x_loop - step)
        curvature = 0.5 * float(np.vdot(ahead.force - behind.force, step))
        found = float(step.ravel() @ local.relax(x_loop).hessian @ step.ravel())
        gaps.append(abs(found / curvature - 1))
    order = shapes.fitted_order([1 / number for number in rings], gaps)
    assert order == pytest.approx(2.0, abs=0.2)


def test_strip_that_follows_the_loop_ends_smoothly() -> None:
    """Of a film a third of L across a tenth of L follows: wholly at the loop, and towards
    the strip's end as the square of what is left of its width."""
    mesh = shapes.mesh_of(*shapes.disk_points(40))
    weight = made_at(mesh, mesh.x).variations.strip.weight
    assert (weight[mesh.loop] == 1).all()
    gap = mesh.x[mesh.interior][:, None] - mesh.x[mesh.loop][None]
    left = 1 - np.linalg.norm(gap, axis=2).min(axis=1) / 0.1
    inside = weight[mesh.interior]
    assert (inside[left <= 0] == 0).all()
    assert (inside[left > 1e-9] > 0).all()
    ends = (left > 0) & (left < 0.2)
    assert ends.any()
    assert (inside[ends] < 0.2 * left[ends]).all()
