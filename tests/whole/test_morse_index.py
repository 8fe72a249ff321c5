"""The Morse index of the condensed problem against that of the whole film."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.motions import rigid_motions
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.shape import Shape
from eulerplateau.solvers import Problem, solve, stability
from tests.helpers import equilibria, shapes
from tests.helpers.equilibria import loop_energy


def whole_film_index(
    problem: Problem, shape: Shape, tensions: FloatArray, load: float
) -> int:
    """Negative eigenvalues of the Lagrangian's Hessian over all vertices, interior too.

    Built from the gradients alone, column by column: they are linear in x, so their
    difference is the Hessian. By Haynsworth's theorem it has as many negative eigenvalues
    as the condensed one, for what is eliminated is positive definite.
    """
    x, size = shape.x, shape.x.size

    def force(y: FloatArray) -> FloatArray:
        at = shape.moved(y.reshape(x.shape))
        bent = problem.bending_energy(at)[1] + problem.tension_force(at, tensions)
        return (problem.film.energy_gradient(at, load)[1] + bent).ravel()

    hessian = np.stack([force(row) for row in np.eye(size)])
    b = problem.disk.loop
    rows = []
    for v in range(len(b)):
        row = np.zeros_like(x)
        after = b[(v + 1) % len(b)]
        row[after], row[b[v]] = x[after] - x[b[v]], x[b[v]] - x[after]
        rows.append(row.ravel())
    normals = np.column_stack([*rows, rigid_motions(x)])
    tangent = np.linalg.qr(normals, mode="complete")[0][:, normals.shape[1] :]
    values = np.linalg.eigvalsh(tangent.T @ hessian @ tangent)
    assert np.abs(values).min() > 1e-9 * values[-1]
    return int((values < 0).sum())


@pytest.fixture(scope="module")
def long_lattice() -> Disk:
    """A hexagonal lattice stretched to twice its length: its modes come one by one."""
    points, triangles = shapes.hexagon_points(5)
    return shapes.mesh_of(points * [2.0, 1.0], triangles)


def test_morse_index_of_planar_films_is_that_of_the_whole_film(
    long_lattice: Disk,
) -> None:
    """Along the planar branch: stable, then with one unstable mode, then with two."""
    problem, met = Problem(long_lattice), []
    loads = [100, 250, 400, 550, 700, 850, 1000]
    models = equilibria.planar(problem, loads)
    for load, model in zip(loads, models, strict=True):
        found = stability(model)
        shape = equilibria.spanned(problem, model.x)
        assert np.abs(shape.x[:, 2]).max() < 1e-12
        assert problem.residual(shape, model.tensions, load) < 1e-9
        assert found.n_neutral == 0
        assert found.n_unstable == whole_film_index(problem, shape, model.tensions, load)
        met.append(found.n_unstable)
    assert met == sorted(met)
    assert set(met) == {0, 1, 2}


def test_morse_index_of_a_regular_hexagon_jumps_by_two_and_that_of_its_saddle_is_zero() -> (
    None
):
    """Its sixfold symmetry makes the twofold modes a pair."""
    mesh = shapes.mesh_of(*shapes.hexagon_points(5))
    problem = Problem(mesh)
    loads = [100.0, 500.0, 900.0]
    indices = []
    for load, model in zip(loads, equilibria.planar(problem, loads), strict=True):
        shape = equilibria.spanned(problem, model.x)
        indices.append(stability(model).n_unstable)
        assert indices[-1] == whole_film_index(problem, shape, model.tensions, load)
    assert indices == [0, 0, 2]
    saddle = solve(problem, loads[-1], mesh.x)
    assert np.ptp(saddle.shape.x[:, 2]) > 0.01
    assert saddle.n_unstable == 0


def test_morse_index_of_films_in_space_is_that_of_the_whole_film(
    oval: Disk, oval_problem: Problem
) -> None:
    """A stable film followed down in load, where it turns unstable once and again."""
    load, met = 1200.0, []
    around = solve(oval_problem, load, shapes.crumpled(oval, 1e-3)).shape.x_loop
    while load >= 500.0:
        model = equilibria.critical_point(loop_energy(oval_problem, load), around)
        shape = equilibria.spanned(oval_problem, model.x)
        met.append(stability(model).n_unstable)
        assert met[-1] == whole_film_index(oval_problem, shape, model.tensions, load)
        around, load = model.x, load - 100.0
    assert np.ptp(around[:, 2]) > 0.1
    assert set(met) == {0, 1, 2}
