"""The compiled kernels against NumPy twins, Taylor's theorem, symmetries and scaling."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import kernels
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers.problem import Problem
from tests.helpers import shapes, twins

LOAD = 700.0
PENALTY = 3e3
RNG = np.random.default_rng(11)


def film(mesh: Disk) -> twins.Field:
    springs = Problem(mesh).film
    return lambda x: springs.energy_gradient(mesh.shape.moved(x), LOAD)


def bending(mesh: Disk) -> twins.Field:
    problem = Problem(mesh)
    return lambda x: problem.bending_energy(mesh.shape.moved(x))


def augmented(problem: Problem, base: FloatArray, lam: FloatArray) -> twins.Field:
    """The kernel's difference from `base`, as a function of the displacement."""
    loop, shape = problem.loop, problem.shape(base)
    excess = loop.constraint(shape.x_loop)
    tension = lam + PENALTY * excess / loop.rest_lengths
    at_base = (
        problem.film.energy_gradient(shape, LOAD)[1]
        + problem.bending_energy(shape)[1]
        + problem.tension_force(shape, tension)
    )

    def difference(u: FloatArray) -> tuple[float, FloatArray]:
        gradient = np.empty_like(u)
        value = kernels.augmented_difference(
            u,
            base,
            at_base,
            problem.film.edges,
            LOAD * problem.film.weights,
            problem.disk.loop,
            loop.rest_lengths,
            tension,
            PENALTY,
            gradient,
        )
        return value, gradient

    return difference


def test_film_energy_is_that_of_the_numpy_twin(oval: Disk, hexagon: Disk) -> None:
    for mesh in (oval, hexagon):
        x = shapes.crumpled(mesh, 0.05)
        assert film(mesh)(x)[0] == pytest.approx(
            twins.film_energy(mesh, x, LOAD), rel=1e-13
        )


def test_bending_energy_is_that_of_the_numpy_twin(oval: Disk, hexagon: Disk) -> None:
    for mesh in (oval, hexagon):
        x = shapes.crumpled(mesh, 0.05)
        assert bending(mesh)(x)[0] == pytest.approx(
            twins.bending_energy(mesh, x), rel=1e-12
        )


def test_augmented_difference_is_the_difference_of_two_twins(oval: Disk) -> None:
    base = shapes.crumpled(oval, 0.01)
    lam = 50 * RNG.standard_normal(oval.n_b)
    field = augmented(Problem(oval), base, lam)
    for size in (1e-2, 1e-1, 1.0):
        u = size * RNG.standard_normal(base.shape)
        expected = twins.lagrangian(oval, base + u, LOAD, lam, PENALTY)
        expected -= twins.lagrangian(oval, base, LOAD, lam, PENALTY)
        assert field(u)[0] == pytest.approx(expected, rel=1e-10)


def test_augmented_difference_keeps_its_digits_for_displacements_of_1e_9(
    oval: Disk,
) -> None:
    """It is a polynomial of u: what it is at 1e-9 follows from what it is at 1e-5."""
    base = shapes.crumpled(oval, 0.01)
    lam = 50 * RNG.standard_normal(oval.n_b)
    problem = Problem(oval)
    field = augmented(problem, base, lam)
    u = 1e-9 * RNG.standard_normal(base.shape)
    slope = field(np.zeros_like(u))[1]
    value = field(u)[0]
    twice = field(2 * u)[0]
    large = 2e4 * u
    curvature = field(large)[0] - np.vdot(slope, large)
    assert value == pytest.approx(np.vdot(slope, u) + curvature / 4e8, rel=1e-12)
    assert twice - 2 * value == pytest.approx(2 * curvature / 4e8, rel=1e-3)
    naive = twins.lagrangian(oval, base + u, LOAD, lam, PENALTY)
    naive -= twins.lagrangian(oval, base, LOAD, lam, PENALTY)
    assert abs(naive / value - 1) > 1e-9


@pytest.mark.parametrize("name", ["film", "bending", "augmented"])
def test_gradient_has_taylor_slope_2(oval: Disk, name: str) -> None:
    x = shapes.crumpled(oval, 0.02)
    fields = {
        "film": film(oval),
        "bending": bending(oval),
        "augmented": augmented(Problem(oval), oval.x, RNG.standard_normal(oval.n_b)),
    }
    start = 0.01 * x if name == "augmented" else x
    for _ in range(3):
        p = 0.01 * RNG.standard_normal(x.shape)
        assert twins.taylor_slope(fields[name], start, p) == pytest.approx(2.0, abs=0.05)


@pytest.mark.parametrize("energy", [film, bending])
def test_quadratic_energy_has_no_remainder_beyond_second_order(
    oval: Disk, energy: Callable[[Disk], twins.Field]
) -> None:
    """E(x + p) - E(x) - g.p = E(p), exactly: the Hessian of a quadratic energy."""
    field = energy(oval)
    x, p = shapes.crumpled(oval, 0.02), RNG.standard_normal(oval.x.shape)
    after, (value, gradient), second = field(x + p)[0], field(x), field(p)[0]
    assert abs(after - value - np.vdot(gradient, p) - second) <= 1e-13 * after


@pytest.mark.parametrize("energy", [film, bending])
def test_gradient_is_added_to_what_is_there(
    oval: Disk, energy: Callable[[Disk], twins.Field]
) -> None:
    problem = Problem(oval)
    x = shapes.crumpled(oval, 0.02)
    there = np.ones_like(x)
    if energy is film:
        weights = LOAD * problem.film.weights
        kernels.film_energy_gradient(x, problem.film.edges, weights, there)
    else:
        kernels.bending_energy_gradient(
            x, problem.disk.loop, problem.loop.rest_lengths, there
        )
    np.testing.assert_allclose(there, 1 + energy(oval)(x)[1], rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("energy", [film, bending])
def test_rigid_motions_change_the_energy_by_less_than_1e_12_of_itself(
    elongated: Disk, energy: Callable[[Disk], twins.Field]
) -> None:
    field = energy(elongated)
    for x in (elongated.x, shapes.crumpled(elongated, 0.02)):
        value, gradient = field(x)
        moved = x @ shapes.rotation().T + [0.3, -0.2, 0.7]
        assert abs(field(moved)[0] / value - 1) < 1e-12
        turned = gradient @ shapes.rotation().T
        np.testing.assert_allclose(field(moved)[1], turned, atol=1e-10 * abs(turned).max())


def test_film_scales_as_length_squared_and_bending_as_one_over_length(
    oval: Disk,
) -> None:
    x = shapes.crumpled(oval, 0.02)
    scale = 3.7
    assert film(oval)(scale * x)[0] == pytest.approx(scale**2 * film(oval)(x)[0])
    gradient = np.zeros_like(x)
    longer = kernels.bending_energy_gradient(
        scale * x, oval.loop, scale * oval.rest_lengths, gradient
    )
    value, force = bending(oval)(x)
    assert longer == pytest.approx(value / scale, rel=1e-12)
    np.testing.assert_allclose(gradient, force / scale**2, rtol=1e-9)


def test_flat_lattice_has_the_film_energy_of_its_area_with_tension_2_sqrt_3_k() -> None:
    """On equilateral triangles 2 sqrt 3 area = sum_inside |e|^2 + sum_loop |e|^2 / 2."""
    for rings in (1, 3, 8):
        points, triangles = shapes.hexagon_points(rings)
        mesh = shapes.mesh_of(points, triangles)
        side = 1 / 6
        area = 1.5 * np.sqrt(3) * side**2
        loop = mesh.n_b * (1 / mesh.n_b) ** 2
        expected = LOAD * (2 * np.sqrt(3) * area - 0.5 * loop)
        assert film(mesh)(mesh.x)[0] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("rings", [1, 2, 6])
def test_regular_polygon_has_exactly_the_bending_energy_of_its_angles(rings: int) -> None:
    """n turns of 2 sin(pi/n) at vertices that own L/n: 4 n^2 sin^2(pi/n) for L = 1."""
    mesh = shapes.mesh_of(*shapes.disk_points(rings))
    n = mesh.n_b
    expected = 4 * n**2 * np.sin(np.pi / n) ** 2
    assert bending(mesh)(mesh.x)[0] == pytest.approx(expected, rel=1e-13)


def test_bending_energy_of_a_circle_converges_to_4_pi_squared_at_second_order() -> None:
    sizes, errors = [], []
    for rings in (4, 8, 16, 32):
        mesh = shapes.mesh_of(*shapes.disk_points(rings))
        sizes.append(1 / mesh.n_b)
        errors.append(bending(mesh)(mesh.x)[0] - 4 * np.pi**2)
    assert shapes.fitted_order(sizes, errors) == pytest.approx(2.0, abs=0.02)
