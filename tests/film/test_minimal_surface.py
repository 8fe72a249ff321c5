"""Discrete minimal surfaces: no vertex inside that could make the film smaller."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.exploration import Limits, explore_from
from eulerplateau.branches.film_family import FilmFamily
from eulerplateau.film.area import (
    AreaFilm,
    local_film,
)
from eulerplateau.film.flips import (
    delaunay_flips,
)
from eulerplateau.film.interior import (
    LocalFilm,
)
from eulerplateau.film.minimal_surface import find_minimal_surface, is_flat
from eulerplateau.film.models import (
    area,
)
from eulerplateau.film.quadratic import dirichlet
from eulerplateau.film.tiling import Tiling
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers.equilibrium import Status
from tests.helpers import shapes, soap_films

RADIUS = 0.8  # of Enneper's surface: stable as a film up to 1


def tiling_of(mesh: Disk) -> Tiling:
    return area(mesh).tiling(mesh.triangles)


def enneper(rings: int, jitter: float = 0.2) -> tuple[Tiling, FloatArray, Disk]:
    points, triangles = shapes.disk_points(rings, jitter)
    mesh = shapes.mesh_of(shapes.enneper(points, RADIUS), triangles)
    return tiling_of(mesh), mesh.x, mesh


def found_near(film: Tiling, x: FloatArray) -> tuple[Tiling, FloatArray]:
    found = find_minimal_surface(film, x)
    assert found is not None
    return found


def pull_inside(film: Tiling, x: FloatArray) -> float:
    """The largest gradient of the area inside, over the largest on the loop."""
    gradient = np.abs(film.gradient(film.sides(x)))
    return float(gradient[film.interior].max() / gradient[film.loop].max())


@pytest.mark.parametrize("rings", [4, 6, 9, 13])
@pytest.mark.parametrize("jitter", [0.0, 0.2])
def test_gradient_vanishes_at_every_vertex_inside_with_good_triangles(
    rings: int, jitter: float
) -> None:
    film, x, _ = enneper(rings, jitter)
    assert pull_inside(film, x) > 1e-4
    better, there = found_near(film, x)
    assert pull_inside(better, there) < 1e-13
    sides = better.sides(there)
    assert sides.smallest_angle > 15
    assert sides.areas.sum() < film.sides(x).areas.sum()
    np.testing.assert_array_equal(there[film.loop], x[film.loop])
    # Triangles are Delaunay's, and found again at once.
    assert delaunay_flips(better, there) is better
    again, same = found_near(better, there)
    assert again is better
    np.testing.assert_array_equal(same, there)


def test_it_is_a_minimum_of_all_coordinates_inside() -> None:
    film, x = found_near(*enneper(6)[:2])
    free = (3 * film.interior[:, None] + [0, 1, 2]).ravel()
    hessian = soap_films.hessian(film, x)[free][:, free].toarray()
    assert np.linalg.eigvalsh(hessian)[0] > 0


def test_area_converges_at_second_order_to_ennepers() -> None:
    """Area pi ((1 + R^2)^3 - 1) / 3 for the radius R in the conformal parameters."""
    exact = np.pi * ((1 + RADIUS**2) ** 3 - 1) / 3
    rings, errors = [5, 7, 10, 13], []
    for number in rings:
        film, x, mesh = enneper(number)
        better, there = found_near(film, x)
        errors.append(better.sides(there).areas.sum() * mesh.length**2 - exact)
    order = shapes.fitted_order([1 / number for number in rings], errors)
    assert order == pytest.approx(2.0, abs=0.15)


def test_it_turns_with_the_film_and_grows_with_it() -> None:
    film, x, _ = enneper(5)
    better, there = found_near(film, x)
    turn = shapes.rotation()
    other, turned = found_near(film, 4 * x @ turn.T)
    np.testing.assert_array_equal(other.triangles, better.triangles)
    np.testing.assert_allclose(turned, 4 * there @ turn.T, atol=1e-9)


def test_waist_narrower_than_the_loops_edges_has_none() -> None:
    """There triangles with an edge on the loop would lose their height."""
    points, triangles = shapes.disk_points(6, 0.1)
    strip = points * [1.0, 0.12 + 0.88 * 0.1]
    x = np.column_stack([strip, 4 * strip[:, 0] * strip[:, 1]])
    mesh = shapes.mesh_of(x, triangles)
    x = local_film(tiling_of(mesh), mesh.x).relax(mesh.x[mesh.loop]).x
    assert find_minimal_surface(tiling_of(mesh), x) is None


def test_vertices_of_a_flat_film_are_left_where_they_are(oval: Disk) -> None:
    turned = oval.shape.moved(oval.x @ shapes.rotation().T)
    assert is_flat(tiling_of(oval), turned.x)
    for film in (area(oval), dirichlet(oval)):
        of_loop = film.of_loop(turned)
        assert of_loop.released(turned.x_loop) is of_loop


@pytest.fixture(scope="module")
def local() -> LocalFilm:
    film, x = found_near(*enneper(5)[:2])
    return local_film(film, x, free=True)


def test_free_film_has_its_loops_gradient_and_second_variation_exactly(
    local: LocalFilm,
) -> None:
    """The force is dA/dx_b alone, and linear but for a remainder of second order."""
    x_loop = local.x[local.tiling.loop] + shapes.wave(len(local.tiling.loop), 1e-3)
    here = local.relax(x_loop)
    assert pull_inside(local.tiling, here.x) < 1e-13
    np.testing.assert_allclose(here.force, here.gradient[local.tiling.loop], atol=1e-14)
    step = shapes.wave(len(local.tiling.loop), 1.0)
    linear = (here.hessian @ step.ravel()).reshape(step.shape)
    sizes = np.geomspace(1e-3, 1e-5, 7).tolist()
    left = [
        float(
            np.linalg.norm(local.relax(x_loop + t * step).force - here.force - t * linear)
        )
        for t in sizes
    ]
    assert shapes.fitted_order(sizes, left) == pytest.approx(2.0, abs=0.1)


def test_free_second_variation_is_the_schur_complement(local: LocalFilm) -> None:
    film, x_loop = local.tiling, local.x[local.tiling.loop]
    found = local.relax(x_loop)
    whole = soap_films.hessian(film, found.x).toarray()
    i, b = ((3 * part[:, None] + [0, 1, 2]).ravel() for part in (film.interior, film.loop))
    inner = np.linalg.solve(whole[np.ix_(i, i)], whole[np.ix_(i, b)])
    expected = whole[np.ix_(b, b)] - whole[np.ix_(b, i)] @ inner
    # Sliding is resisted by 1e-5 of the rest: so much less is certain of what it does.
    np.testing.assert_allclose(found.hessian, expected, atol=1e-7)


def test_branch_that_leaves_the_plane_is_of_discrete_minimal_surfaces() -> None:
    mesh = soap_films.irregular_disk(7)
    start = soap_films.two_lobed(mesh, 1780.0)
    limits = Limits(1, 2, stop=lambda point: not 1650 < point.value < 1850)
    curved = 0
    for visit in explore_from(start, soap_films.CONTROL, limits):
        family, shape = visit.point.family, soap_films.shape(visit.point)
        assert isinstance(family, FilmFamily)
        problem, film = family.problem, family.problem.film
        found = problem.equilibrium(
            shape, visit.point.model.tensions, visit.point.value, Status.CONVERGED
        )
        assert found.film_residual < 1e-12
        assert found.residual < 1e-8
        assert isinstance(film, AreaFilm)
        tiling = film.tiling(shape.triangles)
        assert tiling.sides(shape.x).smallest_angle > 10
        # Forces balance as they are, at every vertex and all three coordinates.
        bending = problem.bending_energy(shape)[1]
        forces = bending + film.energy_gradient(shape, found.load)[1]
        forces += problem.tension_force(shape, found.tensions)
        scale = np.abs(bending).max()
        assert np.abs(problem.without_sliding(shape, forces)).max() < 1e-8 * scale
        curved += not is_flat(tiling, shape.x)
    assert curved > 5


@pytest.mark.parametrize(("slope", "flat"), [(1e-8, True), (1e-5, False), (1e-3, False)])
def test_film_is_flat_as_far_as_its_triangles_do_not_tilt(
    oval: Disk, slope: float, flat: bool
) -> None:
    """Wherever its plane lies: the slope is that of a fold across the middle."""
    x = oval.x + np.outer(slope * np.abs(oval.x[:, 0]), [0.0, 0.0, 1.0])
    assert is_flat(tiling_of(oval), x @ shapes.rotation().T) is flat
