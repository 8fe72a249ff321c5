"""Films as edge weights; their effective tension."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csc_array

from eulerplateau.errors import MeshError
from eulerplateau.film.load import FILM_LOADS, SPRING_TENSION
from eulerplateau.film.models import make_film
from eulerplateau.film.quadratic import QuadraticFilm, dirichlet, springs
from eulerplateau.mesh.disk import Disk
from tests.helpers import shapes, twins


def test_springs_are_one_on_every_edge_that_is_not_on_the_loop(oval: Disk) -> None:
    film = springs(oval)
    assert len(film.edges) == len(oval.edges) - oval.n_b
    assert (film.weights == 1).all()
    tension = film.load.tension_per_load
    assert tension == SPRING_TENSION == pytest.approx(np.sqrt(12))
    made = make_film(oval, "springs")
    assert isinstance(made, QuadraticFilm)
    np.testing.assert_array_equal(made.edges, film.edges)
    np.testing.assert_array_equal(made.weights, film.weights)


def test_laplacian_gives_the_energy_of_the_twin(oval: Disk) -> None:
    x = shapes.crumpled(oval, 0.05)
    laplacian = springs(oval).laplacian()
    assert isinstance(laplacian, csc_array)
    expected = twins.film_energy(oval, x, 1.0)
    assert np.sum(x * (laplacian @ x)) == pytest.approx(expected, rel=1e-13)


def test_laplacian_is_semidefinite_with_constants_and_nothing_else_in_its_kernel(
    oval: Disk,
) -> None:
    laplacian = springs(oval).laplacian().toarray()
    np.testing.assert_array_equal(laplacian, laplacian.T)
    np.testing.assert_array_equal(laplacian.sum(axis=1), 0)
    values = np.linalg.eigvalsh(laplacian)
    assert abs(values[0]) < 1e-12
    assert values[1] > 1e-3


def test_springs_are_the_dirichlet_film_of_an_equilateral_lattice_with_2_sqrt_3_k() -> None:
    """Edge by edge, but for the loop's own edges, whose energy is constant."""
    mesh = shapes.mesh_of(*shapes.hexagon_points(4))
    exact = dirichlet(mesh).laplacian().toarray()
    difference = SPRING_TENSION * exact - springs(mesh).laplacian().toarray()
    around, following = mesh.loop, np.roll(mesh.loop, -1)
    # A loop edge borders one triangle where an inner one borders two: half a spring.
    for v, w in zip(around, following, strict=True):
        difference[[v, w], [w, v]] += 0.5
        difference[[v, w], [v, w]] -= 0.5
    np.testing.assert_allclose(difference, 0, atol=1e-12)


def test_every_film_has_its_effective_tension_per_load(oval: Disk) -> None:
    for name, load in FILM_LOADS.items():
        film = make_film(oval, name)
        assert film.load.tension_per_load == load.tension_per_load


def test_dirichlet_is_half_the_integral_of_the_gradient_squared(oval: Disk) -> None:
    """For a linear map x = A r it is |A|^2 times half the rest area, for the identity the
    area itself. Loop edges are part of it."""
    laplacian = dirichlet(oval).laplacian()
    sides = np.diff(oval.x[oval.triangles], axis=1)
    area = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum()
    assert np.sum(oval.x * (laplacian @ oval.x)) == pytest.approx(area, rel=1e-13)
    linear = np.random.default_rng(2).standard_normal((3, 3))
    x = oval.x @ linear.T
    half = 0.5 * np.sum(linear[:, :2] ** 2) * area
    assert np.sum(x * (laplacian @ x)) == pytest.approx(half, rel=1e-13)


def test_dirichlet_is_the_energy_of_every_triangle_gradient_by_gradient(
    oval: Disk,
) -> None:
    """Against gradients of x in each rest triangle, by solving for them."""
    x, energy = shapes.crumpled(oval, 0.05), 0.0
    for a, b, c in oval.triangles:
        rest = oval.x[[b, c], :2] - oval.x[a, :2]
        gradient = np.linalg.solve(rest, x[[b, c]] - x[a])
        energy += 0.25 * abs(np.linalg.det(rest)) * np.sum(gradient**2)
    laplacian = dirichlet(oval).laplacian()
    assert np.sum(x * (laplacian @ x)) == pytest.approx(energy, rel=1e-12)


def test_obtuse_rest_triangles_have_negative_weights_in_a_film_never_negative() -> None:
    points, triangles = shapes.disk_points(6, jitter=0.3)
    mesh = shapes.mesh_of(points * [4.0, 1.0], triangles)
    film = dirichlet(mesh)
    assert film.weights.min() < -1.0
    values = np.linalg.eigvalsh(film.laplacian().toarray())
    assert values[0] > -1e-12 * values[-1]
    # Constants and nothing else cost nothing.
    assert values[1] > 1e-6 * values[-1]


@pytest.mark.parametrize("shape", ["cap", "needle"])
@pytest.mark.parametrize("thickness", [1e-4, 1e-6, 1e-8, 4e-12])
def test_slivers_that_are_not_refused_leave_the_dirichlet_film_alone(
    thickness: float, shape: str
) -> None:
    """A linear map is linear in a split triangle too: same energy to what rounding of a
    weight as large as 1 / thickness leaves."""
    split, whole = (
        shapes.mesh_of(*mesh)
        for mesh in (shapes.sliver(thickness, shape), shapes.disk_points(4))
    )
    x = split.x @ shapes.rotation().T * [1.0, 2.0, 3.0]
    y = whole.x @ shapes.rotation().T * [1.0, 2.0, 3.0]
    energy = np.sum(x * (dirichlet(split).laplacian() @ x))
    expected = np.sum(y * (dirichlet(whole).laplacian() @ y))
    assert energy == pytest.approx(expected, rel=10 * 2.3e-16 / thickness)


@pytest.mark.parametrize("thickness", [5e-13, 1e-15, 0.0])
def test_triangle_without_a_shape_is_refused_before_it_has_weights(
    thickness: float,
) -> None:
    with pytest.raises(MeshError) as caught:
        dirichlet(shapes.mesh_of(*shapes.sliver(thickness, "cap")))
    assert caught.value.exit_code == 3
    assert (caught.value.kind, caught.value.index) == ("triangle", 20)
