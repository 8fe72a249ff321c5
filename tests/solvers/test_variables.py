"""The variables of conjugate gradients: what they are to shape, energy and lengths."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Lengths
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Problem
from eulerplateau.solvers.equilibrium import SOFTEST_BENDING
from eulerplateau.solvers.trial_space import trial_space
from eulerplateau.solvers.variables import Variables, conditioned, plain
from tests.helpers import shapes

LOAD, PENALTY = 700.0, 1e6
FILMS = [("springs", False), ("dirichlet", False), ("area", False), ("area", True)]
MAKERS = {"conditioned": conditioned, "plain": plain}


def oval() -> Disk:
    points, triangles = shapes.disk_points(3, jitter=0.2)
    return shapes.mesh_of(points * [1.5, 1.0], triangles)


def made(film: str, plane: bool, name: str = "conditioned") -> tuple[Problem, Variables]:
    """Variables about a bent disk, or of a flat film about a flat one."""
    mesh = oval()
    problem = Problem(mesh, film, in_plane=plane)
    shape = problem.film.prepared(problem.shape(shapes.crumpled(mesh, 1e-2)))
    space = trial_space(problem, shape, LOAD)
    return problem, MAKERS[name](space, problem.loop, shape.x_loop, PENALTY)


def columns(variables: Variables, n_v: int) -> FloatArray:
    """The displacement per variable (3 n_v, m), by the derivative of every coordinate."""
    at, unit = np.zeros(variables.size), np.eye(3 * n_v)
    return np.array([variables.derivative(at, row.reshape(n_v, 3)) for row in unit])


@pytest.mark.parametrize("name", MAKERS)
@pytest.mark.parametrize(("film", "plane"), FILMS)
def test_derivative_is_the_one_of_the_displacement(
    film: str, plane: bool, name: str
) -> None:
    """Central differences err by the third derivative: by a quarter at half the step."""
    problem, variables = made(film, plane, name)
    rng = np.random.default_rng(0)
    gradient = rng.standard_normal((problem.disk.n_v, 3))
    y, step = 0.3 * rng.standard_normal((2, variables.size))
    exact = float(variables.derivative(y, gradient) @ step)

    def error(h: float) -> float:
        ahead, behind = (variables.displacement(y + s * h * step) for s in (1, -1))
        return abs(float(np.vdot(gradient, ahead - behind)) / (2 * h) - exact)

    size = abs(exact)
    assert error(0.05) < 0.26 * error(0.1) + 1e-11 * size
    assert error(0.1) < 0.1 * size


@pytest.mark.parametrize("film", ["springs", "dirichlet"])
def test_in_conditioned_variables_the_second_derivative_is_one(film: str) -> None:
    """C^T M C = 1, M put together over all vertices: C is a factor of M^-1, and M of C."""
    problem, variables = made(film, plane=False)
    shape = problem.film.prepared(problem.shape(shapes.crumpled(problem.disk, 1e-2)))
    loop, n_v = problem.loop, problem.disk.n_v
    whole = 2 * LOAD * problem.film.laplacian().toarray()
    around = np.ix_(shape.loop, shape.loop)
    whole[around] += 2 * loop.bending_matrix + SOFTEST_BENDING * np.diag(loop.mean_lengths)
    whole = np.kron(whole, np.eye(3))
    jacobian = np.zeros((len(shape.loop), n_v, 3))
    jacobian[:, shape.loop] = (
        Lengths(loop).jacobian(shape.x_loop).reshape(len(shape.loop), -1, 3)
    )
    rows = jacobian.reshape(len(shape.loop), -1)
    whole += PENALTY * rows.T @ (rows / loop.rest_lengths[:, None])
    root = columns(variables, n_v)
    assert root.shape == whole.shape
    np.testing.assert_allclose(root.T @ whole @ root, np.eye(len(whole)), atol=1e-8)
    inverse = root.T @ whole
    step = np.random.default_rng(1).standard_normal(variables.size)
    np.testing.assert_allclose(inverse @ (root @ step), step, atol=1e-8)


@pytest.mark.parametrize(("film", "plane"), FILMS)
def test_variables_change_lengths_as_to_first_order_and_then_to_fourth(
    film: str, plane: bool
) -> None:
    """Half as far, a sixteenth of what the lengths change beyond what they do at first."""
    problem, variables = made(film, plane)
    shape = problem.film.prepared(problem.shape(shapes.crumpled(problem.disk, 1e-2)))
    straight = columns(variables, problem.disk.n_v)
    loop, x = problem.loop, shape.x_loop
    # Smooth moves of the loop: those that cost most are out of the expansion's reach.
    y = straight.T @ np.random.default_rng(2).standard_normal(len(straight))
    first = Lengths(loop).jacobian(x) @ ((straight @ y).reshape(-1, 3)[shape.loop].ravel())
    size = 0.05 / np.abs(straight @ y).max()

    def beyond(part: float) -> float:
        moved = variables.displacement(part * size * y)[shape.loop]
        change = loop.constraint(x + moved) - loop.constraint(x)
        return float(np.abs(change - part * size * first).max())

    assert 12 < beyond(0.5) / beyond(0.25) < 20
