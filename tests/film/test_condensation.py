"""Static condensation against the full film it stands for."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.film.condensation import Condensation
from eulerplateau.film.quadratic import QuadraticFilm, dirichlet, springs
from eulerplateau.mesh.disk import Disk
from tests.helpers import shapes


def wild_loop(mesh: Disk) -> FloatArray:
    """A loop far from the plane and from its rest lengths."""
    return shapes.crumpled(mesh, 0.1)[mesh.loop]


@pytest.fixture(params=["oval", "hexagon", "elongated"])
def mesh(request: pytest.FixtureRequest) -> Disk:
    found: Disk = request.getfixturevalue(request.param)
    return found


@pytest.fixture
def film(mesh: Disk) -> QuadraticFilm:
    return springs(mesh)


@pytest.fixture
def condensed(film: QuadraticFilm) -> Condensation:
    return film.of_loop(film.rest).condensed


def test_relaxed_film_is_in_balance_inside_to_rounding(
    film: QuadraticFilm, condensed: Condensation, mesh: Disk
) -> None:
    around = wild_loop(mesh)
    x = condensed.extend(around)
    np.testing.assert_array_equal(x[mesh.loop], around)
    force = film.energy_gradient(mesh.shape.moved(x), 1.0)[1]
    assert np.abs(force[mesh.interior]).max() < 1e-13 * np.abs(force).max() * len(x)


def test_stiffness_is_the_schur_complement_of_the_laplacian(
    film: QuadraticFilm, condensed: Condensation, mesh: Disk
) -> None:
    laplacian = film.laplacian().toarray()
    b, i = mesh.loop, mesh.interior
    inner = np.linalg.solve(laplacian[np.ix_(i, i)], laplacian[np.ix_(i, b)])
    expected = laplacian[np.ix_(b, b)] - laplacian[np.ix_(b, i)] @ inner
    np.testing.assert_allclose(condensed.stiffness, expected, atol=1e-12)


def test_stiffness_is_symmetric_semidefinite_with_constants_in_its_kernel(
    film: QuadraticFilm, condensed: Condensation, mesh: Disk
) -> None:
    stiffness = condensed.stiffness
    np.testing.assert_array_equal(stiffness, stiffness.T)
    values = np.linalg.eigvalsh(stiffness)
    assert abs(values[0]) < 1e-12 * values[-1]
    assert values[1] > 1e-3 * values[-1]
    np.testing.assert_allclose(stiffness @ np.ones(mesh.n_b), 0, atol=1e-12)


@pytest.mark.parametrize("shape", ["cap", "needle"])
def test_translations_cost_nothing_next_to_a_sliver_of_1e_8(shape: str) -> None:
    """Its weights of 1e8 cancel, and what rounding leaves of that must not pull."""
    film = dirichlet(shapes.mesh_of(*shapes.sliver(1e-8, shape)))
    condensed = film.of_loop(film.rest).condensed
    assert film.weights.max() > 1e7
    assert np.abs(condensed.stiffness.sum(axis=1)).max() < 1e-14


def test_energy_and_pull_from_the_stiffness_are_those_of_the_whole_relaxed_film(
    film: QuadraticFilm, condensed: Condensation, mesh: Disk
) -> None:
    around = wild_loop(mesh)
    relaxed = mesh.shape.moved(condensed.extend(around))
    energy, force = film.energy_gradient(relaxed, 700.0)
    pull = condensed.stiffness @ around
    assert 700 * np.sum(around * pull) == pytest.approx(energy, rel=1e-12)
    np.testing.assert_allclose(
        1400 * pull, force[mesh.loop], atol=1e-12 * np.abs(force).max() * mesh.n_b
    )


def test_relaxed_film_has_the_least_energy(
    film: QuadraticFilm, condensed: Condensation, mesh: Disk
) -> None:
    x = condensed.extend(wild_loop(mesh))
    energy = film.energy_gradient(mesh.shape.moved(x), 1.0)[0]
    rng = np.random.default_rng(0)
    for size in (1e-3, 1e-1):
        other = x.copy()
        other[mesh.interior] += size * rng.standard_normal((len(mesh.interior), 3))
        assert film.energy_gradient(mesh.shape.moved(other), 1.0)[0] > energy


def test_pull_of_a_relaxed_film_has_no_total_force_or_torque_which_tests_only_code(
    film: QuadraticFilm, condensed: Condensation, mesh: Disk
) -> None:
    """True on any loop whatever, equilibrium or not: it says nothing about physics."""
    around = wild_loop(mesh)
    pull = condensed.stiffness @ around
    scale = np.abs(pull).sum()
    assert np.abs(pull.sum(axis=0)).max() < 1e-13 * scale
    assert np.abs(np.cross(around, pull).sum(axis=0)).max() < 1e-13 * scale


def test_film_without_interior_vertices_is_its_own_condensation() -> None:
    """A fan of triangles over a regular octagon, from one of its corners."""
    angle = np.pi / 4 * np.arange(8)
    fan = np.array([(0, i, i + 1) for i in range(1, 7)])
    mesh = shapes.mesh_of(np.stack([np.cos(angle), np.sin(angle)], axis=1), fan)
    film = springs(mesh)
    laplacian, condensed = film.laplacian(), film.of_loop(film.rest).condensed
    b = mesh.loop
    np.testing.assert_allclose(condensed.stiffness, laplacian.toarray()[np.ix_(b, b)])
    around = wild_loop(mesh)
    np.testing.assert_array_equal(condensed.extend(around)[b], around)


def test_stiffness_of_a_disk_converges_to_the_dirichlet_to_neumann_map() -> None:
    """Mode n of a disk's film of tension sigma: load tr(x^T S x) = sigma/2 n int x^2 dphi.

    Second order in the edge length, as piecewise linear elements have it.
    """
    sizes = [6, 12, 24]
    errors: dict[int, list[float]] = {1: [], 2: [], 4: []}
    for rings in sizes:
        mesh = shapes.mesh_of(*shapes.disk_points(rings))
        film = dirichlet(mesh)
        stiffness = film.of_loop(film.rest).condensed.stiffness
        phi = np.arctan2(*mesh.x[mesh.loop].T[1::-1])
        for n, found in errors.items():
            found.append(
                np.cos(n * phi) @ stiffness @ np.cos(n * phi) / (np.pi * n / 2) - 1
            )
    for found in errors.values():
        order = -shapes.fitted_order([float(n) for n in sizes], found)
        assert order == pytest.approx(2.0, abs=0.15)
        assert abs(found[-1]) < 0.02
