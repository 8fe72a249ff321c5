"""The film as edge weights; its effective tension."""

from __future__ import annotations

import equilibria
import numpy as np
import pytest
import shapes
import twins
from scipy.sparse import csc_array

from eulerplateau.film import FILMS, SPRING_TENSION, springs
from eulerplateau.mesh import DiskMesh


def test_springs_are_one_on_every_edge_that_is_not_on_the_loop(oval: DiskMesh) -> None:
    film = springs(oval)
    assert len(film.edges) == len(oval.edges) - oval.n_b
    assert (film.weights == 1).all()
    assert film.tension_per_load == SPRING_TENSION == pytest.approx(np.sqrt(12))
    assert FILMS["springs"] is springs


def test_laplacian_gives_the_energy_of_the_twin(oval: DiskMesh) -> None:
    x = shapes.crumpled(oval, 0.05)
    laplacian = springs(oval).laplacian(oval.n_v)
    assert isinstance(laplacian, csc_array)
    expected = twins.film_energy(oval, x, 1.0)
    assert np.sum(x * (laplacian @ x)) == pytest.approx(expected, rel=1e-13)


def test_laplacian_is_semidefinite_with_constants_and_nothing_else_in_its_kernel(
    oval: DiskMesh,
) -> None:
    laplacian = springs(oval).laplacian(oval.n_v).toarray()
    np.testing.assert_array_equal(laplacian, laplacian.T)
    np.testing.assert_array_equal(laplacian.sum(axis=1), 0)
    values = np.linalg.eigvalsh(laplacian)
    assert abs(values[0]) < 1e-12
    assert values[1] > 1e-3


def test_springs_are_the_dirichlet_film_of_an_equilateral_lattice_with_2_sqrt_3_k() -> None:
    """Edge by edge and exactly, but for the loop's own edges, whose energy is constant."""
    mesh = shapes.mesh_of(*shapes.hexagon_points(4))
    exact = equilibria.dirichlet(mesh).laplacian(mesh.n_v).toarray()
    difference = SPRING_TENSION * exact - springs(mesh).laplacian(mesh.n_v).toarray()
    around, following = mesh.loop, np.roll(mesh.loop, -1)
    # A loop edge borders one triangle where an inner one borders two: half a spring.
    for v, w in zip(around, following, strict=True):
        difference[[v, w], [w, v]] += 0.5
        difference[[v, w], [v, w]] -= 0.5
    np.testing.assert_allclose(difference, 0, atol=1e-12)
