"""The problem as a solver sees it, and the energies of disks."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Problem, Status
from tests.helpers import equilibria, shapes, twins

LOAD = 700.0
RNG = np.random.default_rng(4)


def test_energies_are_those_of_the_twins(oval: Disk, oval_problem: Problem) -> None:
    x = shapes.crumpled(oval, 0.02)
    shape = oval.shape.moved(x)
    record = oval_problem.equilibrium(shape, np.zeros(oval.n_b), LOAD, Status.CONVERGED)
    film, bending = twins.film_energy(oval, x, LOAD), twins.bending_energy(oval, x)
    assert record.film_energy == pytest.approx(film, rel=1e-12)
    assert record.bending_energy == pytest.approx(bending, rel=1e-12)
    assert record.energy == record.film_energy + record.bending_energy


def test_residual_is_the_imbalance_over_the_largest_of_the_three_forces(
    oval: Disk, oval_problem: Problem
) -> None:
    """With the gradients of the twins, by central differences of quartic polynomials."""
    x, lam = shapes.crumpled(oval, 0.02), 100 * RNG.standard_normal(oval.n_b)
    terms = (
        lambda y: twins.bending_energy(oval, y),
        lambda y: twins.film_energy(oval, y, LOAD),
        lambda y: float(lam @ twins.constraint(oval, y)),
    )
    forces = []
    for term in terms:
        force = np.empty_like(x)
        for index in np.ndindex(*x.shape):
            step = np.zeros_like(x)
            step[index] = 1e-3  # exact for a quadratic but for rounding
            force[index] = (term(x + step) - term(x - step)) / 2e-3
        forces.append(force)
    largest = max(np.abs(force).max() for force in forces)
    expected = np.abs(np.sum(forces, axis=0)).max() / largest
    residual = oval_problem.residual(oval.shape.moved(x), lam, LOAD)
    assert residual == pytest.approx(expected, rel=1e-9)
    # Where tension is all there is nothing balances it.
    residual = oval_problem.residual(oval.shape.moved(x), 1e9 * lam, LOAD)
    assert residual == pytest.approx(1.0, rel=1e-6)


def test_residual_vanishes_at_an_equilibrium_and_says_by_how_much_one_is_missed(
    oval: Disk, oval_problem: Problem
) -> None:
    model = equilibria.planar(oval_problem, [300.0, LOAD])[-1]
    shape = equilibria.spanned(oval_problem, model.x)
    assert oval_problem.residual(shape, model.tensions, LOAD) < 1e-10
    direction = RNG.standard_normal(shape.x.shape)
    once, twice = (
        oval_problem.residual(shape.moved(shape.x + size * direction), model.tensions, LOAD)
        for size in (1e-8, 2e-8)
    )
    assert twice == pytest.approx(2 * once, rel=1e-2)


def test_residual_does_not_depend_on_the_unit_of_energy(
    oval: Disk, oval_problem: Problem
) -> None:
    """At load 0 the film is slack: bending and tension alone, both linear in x."""
    x, lam = shapes.crumpled(oval, 0.02), 100 * RNG.standard_normal(oval.n_b)
    one, three = (
        oval_problem.residual(oval.shape.moved(size * x), lam, LOAD) for size in (1, 3)
    )
    assert three == pytest.approx(one, rel=1e-10)


def test_rigid_motions_change_the_energy_by_less_than_1e_12_of_itself(
    oval: Disk, oval_problem: Problem
) -> None:
    model = equilibria.planar(oval_problem, [300.0, LOAD])[-1]
    shape = equilibria.spanned(oval_problem, model.x)
    here = oval_problem.equilibrium(shape, model.tensions, LOAD, Status.CONVERGED)
    moved = shape.moved(shape.x @ shapes.rotation().T + [0.3, -0.2, 0.7])
    there = oval_problem.equilibrium(moved, model.tensions, LOAD, Status.CONVERGED)
    assert abs(there.energy / here.energy - 1) < 1e-12
    assert there.residual < 1e-10


def test_a_length_error_is_the_largest_strain_of_the_loop(
    oval: Disk, oval_problem: Problem
) -> None:
    assert oval_problem.length_error(oval.shape) < 1e-14
    longer = oval.shape.moved(1.25 * oval.x)
    assert oval_problem.length_error(longer) == pytest.approx(0.25, rel=1e-12)


def test_energy_of_a_disk_converges_to_sigma_over_4_pi_plus_4_pi_squared() -> None:
    """In units alpha/L, at second order in the length of the loop's edges."""
    sigma_hat, sizes, errors = 1234.0, [], []
    for rings in (6, 12, 24):
        mesh = shapes.mesh_of(*shapes.disk_points(rings))
        problem = Problem(mesh, "dirichlet")
        shape = equilibria.spanned(problem, mesh.x[mesh.loop])
        np.testing.assert_allclose(shape.x, mesh.x, atol=1e-13)  # already relaxed
        energy = problem.film.energy_gradient(shape, sigma_hat)[0]
        energy += problem.bending_energy(shape)[0]
        sizes.append(1 / mesh.n_b)
        errors.append(energy - (sigma_hat / (4 * np.pi) + 4 * np.pi**2))
    assert shapes.fitted_order(sizes, errors) == pytest.approx(2.0, abs=0.05)


def test_spring_film_of_an_unstructured_disk_has_that_energy_to_a_percent(
    hexagon: Disk,
) -> None:
    """2 sqrt 3 k is exact on equilateral triangles; Gmsh's are equilateral to a percent.

    Film of the flat mesh, without the loop's edges: 2 sqrt 3 k area - k sum_loop s^2 / 2.
    """
    area = np.cross(
        hexagon.x[hexagon.triangles[:, 1]] - hexagon.x[hexagon.triangles[:, 0]],
        hexagon.x[hexagon.triangles[:, 2]] - hexagon.x[hexagon.triangles[:, 0]],
    )[:, 2]
    expected = np.sqrt(12) * area.sum() / 2 - (hexagon.rest_lengths**2).sum() / 2
    energy = Problem(hexagon).film.energy_gradient(hexagon.shape, 1.0)[0]
    assert energy == pytest.approx(expected, rel=0.01)
