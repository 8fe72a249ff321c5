"""Newton for soap films: one film from many starts, its laws, the disk's thresholds."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh

from eulerplateau.arrays import FloatArray
from eulerplateau.film.models import (
    area,
)
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Problem, lowest_modes, solving, tangent_model
from eulerplateau.solvers.equilibrium import (
    LENGTH_TOLERANCE,
    RESIDUAL_TOLERANCE,
    Equilibrium,
    Status,
)
from tests.helpers import shapes, soap_films
from tests.helpers.equilibria import loop_energy

OVAL = np.array([1.25, 0.8, 1.0])
# Loads sigma_hat at which disk and two-lobed film are stable, in their plane and across it.
LOADS = (1000.0, 1700.0)


def solve(problem: Problem, x: FloatArray, load: float) -> Equilibrium:
    found = solving.solve(problem, load, x)
    assert found.status is Status.CONVERGED
    assert found.n_unstable == 0
    assert found.residual < RESIDUAL_TOLERANCE
    assert found.length_error < LENGTH_TOLERANCE
    return found


@pytest.fixture(scope="module")
def mesh() -> Disk:
    return soap_films.irregular_disk(8)


@pytest.mark.parametrize("load", LOADS)
def test_same_film_is_reached_from_flat_rough_and_turned_starts(
    mesh: Disk, load: float
) -> None:
    problem = Problem(mesh, "area")
    rough = shapes.crumpled(mesh, 2e-3) * OVAL
    bowl = mesh.x * OVAL + np.outer((mesh.x**2).sum(axis=1), [0.0, 0.0, 0.5])
    starts = (mesh.x * OVAL, rough, bowl, rough @ shapes.rotation().T + [1.0, 2.0, 3.0])
    found = [solve(problem, x, load) for x in starts]
    for other in found[1:]:
        assert other.energy == pytest.approx(found[0].energy, rel=1e-8)
        # The energy is stationary, its parts are not. (Where the loop's vertices lie on the
        # curve is left open: it slides along itself.)
        assert other.bending_energy == pytest.approx(found[0].bending_energy, rel=1e-5)


@pytest.mark.slow
def test_crumpled_fine_disk_becomes_the_regular_polygon_on_its_edges() -> None:
    # Noise as large as the triangles, as the default start is on 40,000 vertices.
    mesh = shapes.mesh_of(*shapes.disk_points(23))
    found = solve(Problem(mesh, "area"), shapes.crumpled(mesh, 2e-3), 1000.0)
    n = mesh.n_b
    assert found.film_energy / 1000.0 == pytest.approx(
        1 / (4 * n * np.tan(np.pi / n)), rel=1e-12
    )


@pytest.mark.slow
def test_film_on_40000_vertices_comes_to_rest_from_the_default_start() -> None:
    mesh = shapes.mesh_of(*shapes.disk_points(115))
    found = solving.solve(Problem(mesh, "area"), 1000.0)
    assert found.is_minimum
    n = mesh.n_b
    assert found.film_energy / 1000.0 == pytest.approx(
        1 / (4 * n * np.tan(np.pi / n)), rel=1e-12
    )


@pytest.mark.parametrize("load", LOADS)
def test_flat_film_is_the_one_that_is_kept_in_its_plane(mesh: Disk, load: float) -> None:
    space, plane = (
        solve(Problem(mesh, "area", in_plane=plane), mesh.x * OVAL, load)
        for plane in (False, True)
    )
    assert space.energy == pytest.approx(plane.energy, rel=1e-9)
    assert space.bending_energy == pytest.approx(plane.bending_energy, rel=1e-6)
    assert np.abs(space.shape.x[:, 2]).max() < 1e-12


def test_energy_rises_with_the_tension_as_fast_as_the_film_is_large(mesh: Disk) -> None:
    """dE/d sigma_hat = area along equilibria; central differences converge to it."""
    problem = Problem(mesh, "area")
    here = solve(problem, mesh.x * OVAL, 1700.0)
    steps, errors = [80.0, 40.0, 20.0], []
    for step in steps:
        low, high = (solve(problem, here.shape.x, 1700.0 + s).energy for s in (-step, step))
        errors.append((high - low) / (2 * step) - here.film_energy / 1700.0)
    assert shapes.fitted_order(steps, errors) == pytest.approx(2.0, abs=0.1)


def test_rigid_motions_and_units_change_nothing(mesh: Disk) -> None:
    start = shapes.crumpled(mesh, 1e-3) * OVAL
    plain = solve(Problem(mesh, "area"), start, 1700.0)
    turn = shapes.rotation()
    moved = Disk.from_triangles(4 * mesh.x @ turn.T, mesh.triangles)
    other = solve(Problem(moved, "area"), start @ turn.T + 0.5, 1700.0)
    assert other.energy == pytest.approx(plain.energy, rel=1e-11)
    assert other.lowest_eigenvalue == pytest.approx(plain.lowest_eigenvalue, rel=1e-8)
    np.testing.assert_allclose(other.shape.x, plain.shape.x @ turn.T + 0.5, atol=1e-8)


def test_long_way_leaves_good_triangles_and_the_same_loop() -> None:
    """From four times as long as wide to a disk."""
    points, triangles = shapes.disk_points(8, jitter=0.1)
    mesh = shapes.mesh_of(points * [4.0, 1.0], triangles)
    found = solve(Problem(mesh, "area"), mesh.x, 500.0)
    assert not np.array_equal(found.shape.triangles, mesh.triangles)
    tiling = area(mesh).tiling(found.shape.triangles)
    assert tiling.sides(found.shape.x).smallest_angle > 12
    again = Disk.from_triangles(found.shape.x, found.shape.triangles)
    np.testing.assert_allclose(again.rest_lengths, mesh.rest_lengths, rtol=1e-8)
    start = int(np.flatnonzero(again.loop == mesh.loop[0])[0])
    np.testing.assert_array_equal(np.roll(again.loop, -start), mesh.loop)


@pytest.mark.parametrize("load", LOADS)
def test_film_at_rest_has_no_mean_curvature_inside(mesh: Disk, load: float) -> None:
    """The area's gradient vanishes at every interior vertex of a flat film: all of it."""
    problem = Problem(mesh, "area")
    found = solve(problem, shapes.crumpled(mesh, 1e-3) * OVAL, load)
    tiling = area(mesh).tiling(found.shape.triangles)
    gradient = tiling.gradient(tiling.sides(found.shape.x))
    assert np.abs(gradient[mesh.interior]).max() < 1e-12 * np.abs(gradient).max()


def test_softest_mode_of_the_two_lobed_film_twists_it_across_its_plane(
    mesh: Disk,
) -> None:
    problem = Problem(mesh, "area")
    found = solve(problem, mesh.x * OVAL, 1750.0)
    mode = lowest_modes(problem, found, 1)["mode_0"]
    assert np.linalg.norm(mode, axis=1).max() == pytest.approx(1.0)
    np.testing.assert_allclose(mode[:, :2], 0, atol=1e-6)
    # Opposite quadrants go the same way: x y z has one sign, all but near the axes.
    axes = np.linalg.svd(found.shape.x_loop)[2]
    quadrant = np.prod((found.shape.x_loop @ axes.T)[:, :2], axis=1)
    alike = quadrant * mode[mesh.loop, 2]
    assert abs(alike.sum()) > 0.95 * np.abs(alike).sum()


def thresholds(mesh: Disk) -> tuple[FloatArray, FloatArray]:
    """Loads at which the disk is neutral, in the plane and across it, ascending.

    On the disk's branch neither shape nor basis changes and the Hessian is linear in the
    load: H = H_0 - load H_1 is singular where 1 / load is an eigenvalue of H_1 in H_0.
    """
    problem = Problem(mesh, "area")
    bare, loaded = (
        tangent_model(loop_energy(problem, load), mesh.x[mesh.loop]) for load in (0.0, 1e3)
    )
    assert loaded.residual < 1e-9
    np.testing.assert_array_equal(bare.basis, loaded.basis)
    slope = (bare.hessian - loaded.hessian) / 1e3
    inverse, vectors = eigh(slope, bare.hessian)
    modes = (bare.basis @ vectors).reshape(mesh.n_b, 3, -1)
    across = (modes[:, 2] ** 2).sum(axis=0) / (modes**2).sum(axis=(0, 1))
    np.testing.assert_allclose(across * (1 - across), 0, atol=1e-9)
    softened = inverse > 1e-9
    return (
        np.sort(1 / inverse[softened & (across < 0.5)]),
        np.sort(1 / inverse[softened & (across > 0.5)]),
    )


@pytest.mark.parametrize("irregular", [False, True])
def test_disk_gives_way_where_theory_says_to_second_order(irregular: bool) -> None:
    """16 pi^3 (n^2 - 1) in the plane, 16 pi^3 n (n + 1) across it, each mode twice."""
    exact = 16 * np.pi**3 * np.array([[3, 3, 8, 8], [6, 6, 12, 12]])
    rings, errors = [6, 9, 13, 19], []
    for number in rings:
        mesh = soap_films.irregular_disk(number, 0.2 if irregular else 0.0)
        found = np.array([values[:4] for values in thresholds(mesh)])
        errors.append((found / exact - 1).ravel())
    for column in np.transpose(errors).tolist():
        order = shapes.fitted_order([1 / number for number in rings], column)
        assert order == pytest.approx(2.0, abs=0.15)
