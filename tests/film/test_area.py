"""The area of a triangulated film, its derivatives and its differences."""

from __future__ import annotations

from decimal import Decimal, localcontext

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.film.area import (
    AreaFilm,
)
from eulerplateau.film.models import (
    area,
    make_film,
)
from eulerplateau.film.tiling import Tiling, TriangleGeometry
from eulerplateau.loop.kernels import area_beyond_linear
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.triangles import smallest_angle
from tests.helpers import shapes, soap_films, twins


@pytest.fixture(scope="module")
def film(oval: Disk) -> AreaFilm:
    return area(oval)


@pytest.fixture(scope="module")
def tiling(oval: Disk, film: AreaFilm) -> Tiling:
    return film.tiling(oval.triangles)


@pytest.fixture(scope="module")
def x(oval: Disk) -> FloatArray:
    """A shape without any symmetry, its triangles far from flat against each other."""
    return shapes.crumpled(oval, 0.01) @ shapes.rotation().T


def direction(x: FloatArray, seed: int = 1) -> FloatArray:
    step = np.random.default_rng(seed).standard_normal(x.shape)
    return 0.01 * step / np.linalg.norm(step, axis=1).max()


def twin(tiling: Tiling, x: FloatArray) -> float:
    """Heron's formula, triangle by triangle."""
    total = 0.0
    for i, j, k in tiling.triangles:
        a, b, c = (np.linalg.norm(x[p] - x[q]) for p, q in ((i, j), (j, k), (k, i)))
        s = (a + b + c) / 2
        total += np.sqrt(s * (s - a) * (s - b) * (s - c))
    return float(total)


def test_energy_is_the_load_times_the_area_of_the_triangles(
    oval: Disk, film: AreaFilm, tiling: Tiling, x: FloatArray
) -> None:
    energy = film.energy_gradient(oval.shape.moved(x), 3.0)[0]
    assert energy == pytest.approx(3 * twin(tiling, x), rel=1e-12)
    assert isinstance(make_film(oval, "area"), AreaFilm)
    assert film.load.tension_per_load == 1.0


def test_flat_film_has_the_area_of_its_polygon(oval: Disk, film: AreaFilm) -> None:
    """The shoelace formula, whatever the triangles inside."""
    a, b = oval.x[oval.loop, :2].T
    shoelace = 0.5 * np.sum(a * np.roll(b, -1) - np.roll(a, -1) * b)
    assert film.energy_gradient(oval.shape, 1.0)[0] == pytest.approx(shoelace, rel=1e-14)


def energy_at(disk: Disk, film: AreaFilm, load: float) -> twins.Field:
    return lambda x: film.energy_gradient(disk.shape.moved(x), load)


def test_gradient_leaves_a_remainder_of_second_order(
    oval: Disk, film: AreaFilm, x: FloatArray
) -> None:
    slope = twins.taylor_slope(energy_at(oval, film, 2.0), x, direction(x))
    assert slope == pytest.approx(2.0, abs=0.05)


def test_hessian_leaves_a_remainder_of_third_order(
    oval: Disk, film: AreaFilm, tiling: Tiling, x: FloatArray
) -> None:
    p, area_at = direction(x), energy_at(oval, film, 1.0)
    hessian = soap_films.hessian(tiling, x)

    def curved(y: FloatArray) -> tuple[float, FloatArray]:
        """The area with its second-order part about x taken away."""
        moved = (y - x).ravel()
        value, gradient = area_at(y)
        bent = hessian @ moved
        return value - 0.5 * float(moved @ bent), gradient - bent.reshape(x.shape)

    assert twins.taylor_slope(curved, x, p) == pytest.approx(3.0, abs=0.05)
    asymmetry = abs(hessian - hessian.T).max()
    assert asymmetry < 1e-13 * abs(hessian).max()


def test_gradient_is_the_cotangent_laplacian_of_the_positions(
    tiling: Tiling, x: FloatArray
) -> None:
    """Pinkall and Polthier (1993)."""
    sides = tiling.sides(x)
    laplacian = tiling.matrix(tiling.cotangent_laplacian(sides))
    np.testing.assert_allclose(laplacian @ x, tiling.gradient(sides), atol=1e-14)
    np.testing.assert_allclose(laplacian.sum(axis=1), 0, atol=1e-12)


def test_normal_hessian_is_the_hessian_along_the_directions(
    tiling: Tiling, x: FloatArray
) -> None:
    sides = tiling.sides(x)
    directions = np.random.default_rng(2).standard_normal(x.shape)
    columns = np.zeros((3 * len(x), len(x)))
    for d in range(3):
        columns[d::3][np.diag_indices(len(x))] = directions[:, d]
    expected = columns.T @ (soap_films.hessian(tiling, x) @ columns)
    found = tiling.matrix(tiling.normal_hessian(sides, directions)).toarray()
    np.testing.assert_allclose(found, expected, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("size", [1e-1, 1e-6, 1e-12])
def test_change_keeps_its_relative_precision_however_small_the_step(
    tiling: Tiling, x: FloatArray, size: float
) -> None:
    """Against fifty digits, where a plain difference has as few as four."""
    after = x + size * direction(x, 3)
    with localcontext() as context:
        context.prec = 50
        exact = float(
            sum(_exact_area(after[t]) - _exact_area(x[t]) for t in tiling.triangles)
        )
    assert tiling.change(x, after) == pytest.approx(exact, rel=1e-11)


def _exact_area(corners: FloatArray) -> Decimal:
    a, b, c = ([Decimal(float(v)) for v in corner] for corner in corners)
    p = [v - u for u, v in zip(a, b, strict=True)]
    q = [v - u for u, v in zip(a, c, strict=True)]
    cross = [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ]
    return sum((v * v for v in cross), Decimal(0)).sqrt() / 2


@pytest.mark.parametrize("size", [1.0, 1e-6, 1e-12])
def test_kernel_for_differences_is_the_area_beyond_its_linear_part(
    tiling: Tiling, x: FloatArray, size: float
) -> None:
    """Value and gradient against the twin; in small steps it is half p H p, and H p."""
    sides, moved = tiling.sides(x), size * direction(x, 4)
    gradient = np.zeros_like(x)
    value = area_beyond_linear(moved, x, tiling.triangles, gradient)
    if size == 1.0:
        force = tiling.gradient(sides)
        linear = float(np.vdot(force, moved))
        expected = tiling.change(x, x + moved) - linear
        by_then = tiling.gradient(tiling.sides(x + moved)) - force
        tolerance = 1e-10
    else:
        by_then = (soap_films.hessian(tiling, x) @ moved.ravel()).reshape(x.shape)
        expected = 0.5 * float(np.vdot(moved, by_then))
        # What comes next is smaller by the step over the shortest edge's height.
        tolerance = max(100 * size, 1e-9)
    assert value == pytest.approx(expected, rel=tolerance)
    np.testing.assert_allclose(gradient, by_then, atol=tolerance * np.abs(by_then).max())


def test_rigid_motions_change_nothing_and_lengths_scale(
    oval: Disk, film: AreaFilm, x: FloatArray
) -> None:
    area_at = energy_at(oval, film, 1.0)
    turn, shift = shapes.rotation(), np.array([0.3, -0.2, 0.5])
    value, gradient = area_at(x)
    moved, turned = area_at(x @ turn.T + shift)
    assert moved == pytest.approx(value, rel=1e-13)
    np.testing.assert_allclose(turned, gradient @ turn.T, atol=1e-14)
    larger, steeper = area_at(8 * x)
    assert larger == 64 * value
    np.testing.assert_array_equal(steeper, 8 * gradient)
    # Neither does a motion do work: no total force, no total torque.
    np.testing.assert_allclose(gradient.sum(axis=0), 0, atol=1e-15)
    np.testing.assert_allclose(np.cross(x, gradient).sum(axis=0), 0, atol=1e-15)


def test_flat_film_pulls_at_nothing_inside_and_lets_its_vertices_slide(
    oval: Disk, tiling: Tiling
) -> None:
    sides = tiling.sides(oval.x)
    inside = tiling.interior
    assert np.abs(tiling.gradient(sides)[inside]).max() < 1e-15
    free = (3 * inside[:, None] + [0, 1]).ravel()
    sliding = soap_films.hessian(tiling, oval.x)[:, free][free]
    assert abs(sliding).max() < 1e-13
    # Across its plane it resists: the matrix of the heights is positive definite.
    upwards = np.tile([0.0, 0.0, 1.0], (len(oval.x), 1))
    across = tiling.matrix(tiling.normal_hessian(sides, upwards))
    assert np.linalg.eigvalsh(across[:, inside][inside].toarray())[0] > 0.01


def sides_of(disk: Disk, x: FloatArray) -> TriangleGeometry:
    return area(disk).tiling(disk.triangles).sides(x)


def test_smallest_angle_of_known_triangles(oval: Disk) -> None:
    lattice = shapes.mesh_of(*shapes.hexagon_points(3))
    assert sides_of(lattice, lattice.x).smallest_angle == pytest.approx(60.0)
    right = Disk.from_triangles([[0, 0, 0], [1, 0, 0], [1, 1e-3, 0]], [[0, 1, 2]])
    angle = sides_of(right, right.x).smallest_angle
    assert angle == pytest.approx(np.degrees(np.arctan(1e-3)), rel=1e-9)
    assert sides_of(oval, 0 * oval.x).smallest_angle == 0.0


def test_smallest_angle_is_that_of_the_plain_formula(tiling: Tiling, x: FloatArray) -> None:
    sides = tiling.sides(x)
    assert sides.smallest_angle == pytest.approx(
        smallest_angle(sides.edges, sides.areas), rel=1e-13
    )


def test_triangles_stand_unless_one_turns_too_far_or_has_no_area(
    oval: Disk, tiling: Tiling
) -> None:
    flat = tiling.sides(oval.x).normals
    # By 60 degrees, whose cosine is one half.
    turned = oval.x.copy()
    turned[:, 1:] = oval.x[:, 1:2] * [0.5, np.sqrt(0.75)]
    standing = tiling.standing(turned, flat, 0.5 - 1e-12)
    assert standing is not None
    sides, gradient = standing
    np.testing.assert_allclose(sides.areas, tiling.sides(turned).areas, rtol=1e-14)
    np.testing.assert_allclose(gradient, tiling.gradient(tiling.sides(turned)), rtol=1e-14)
    assert tiling.standing(turned, flat, 0.5 + 1e-12) is None
    thin = oval.x.copy()
    thin[tiling.triangles[0, 0]] = thin[tiling.triangles[0, 1]]
    assert tiling.standing(thin, flat, 0.3) is None
    lost = oval.x.copy()
    lost[tiling.interior[0]] = np.nan
    assert tiling.standing(lost, flat, 0.3) is None


def test_triangles_without_area_have_no_normal_and_no_pull(
    oval: Disk, tiling: Tiling
) -> None:
    sides = tiling.sides(oval.x * [1.0, 0.0, 0.0])
    assert not sides.normals.any()
    assert not sides.cotangent.any()
    assert not tiling.gradient(sides).any()


def test_normals_at_vertices_do_not_depend_on_how_a_triangle_is_cut(
    oval: Disk, tiling: Tiling, x: FloatArray
) -> None:
    """Weighted by areas: two halves of a triangle count as it does, there and elsewhere."""
    i, j, k = tiling.triangles[7]
    new = oval.n_v
    halves = [[i, j, new], [i, new, k]]
    # A vertex in the middle of a side, which the triangle beyond does not see.
    cut = Tiling(
        np.vstack([np.delete(tiling.triangles, 7, axis=0), halves]),
        tiling.loop,
        np.append(tiling.interior, new),
    )
    there = np.vstack([x, 0.5 * (x[j] + x[k])])
    whole = tiling.vertex_normals(tiling.sides(x))
    halved = cut.vertex_normals(cut.sides(there))
    np.testing.assert_allclose(halved[[i]], whole[[i]], atol=1e-13)
    others = np.setdiff1d(np.arange(oval.n_v), [i, j, k])
    np.testing.assert_array_equal(halved[others], whole[others])


def test_film_of_a_loop_is_near_the_shape_that_is_asked_for(oval: Disk) -> None:
    """Also where another shape on the same triangles came just before."""
    made = area(oval)
    given = [oval.shape.moved(shapes.crumpled(oval, size)) for size in (0.0, 1e-3)]
    one, other = (made.prepared(shape) for shape in given)
    assert one.triangles is other.triangles
    for shape in (one, other, one):
        found = made.of_loop(shape)
        np.testing.assert_array_equal(found.reference.x_loop, shape.x_loop)
