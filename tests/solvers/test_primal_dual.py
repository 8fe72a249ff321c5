"""Newton's method on positions and tensions together, without the descent around it."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Problem, solve
from eulerplateau.solvers.equilibrium import Settled
from eulerplateau.solvers.primal_dual import settle
from tests.helpers import equilibria, shapes

AWAY = 1e-3


def settled(
    problem: Problem, load: float, x: FloatArray, tensions: FloatArray
) -> tuple[Settled, list[FloatArray]]:
    """Where it settles from a loop (n_b, 3), and the loops it is shown on the way."""
    energy, shown = equilibria.loop_energy(problem, load), [x]
    found = settle(energy, problem.loop, energy.hessian(x), x, tensions, 12, shown.append)
    assert found is not None
    return found, shown


@pytest.mark.parametrize("load", [1.0, 500.0, 900.0, 1600.0])
@pytest.mark.parametrize("turned", [False, True])
def test_it_settles_by_itself_and_quadratically(
    oval: Disk, oval_problem: Problem, load: float, turned: bool
) -> None:
    """From the minimum bent by a thousandth of the length, its tensions off by as much."""
    minimum = solve(oval_problem, load, shapes.crumpled(oval, 1e-3))
    assert minimum.n_unstable == 0
    bent = minimum.shape.x_loop + shapes.wave(oval.n_b, AWAY)
    x = bent @ shapes.rotation().T + [0.3, -0.2, 0.7] if turned else bent
    off = np.random.default_rng(2).uniform(-AWAY, AWAY, oval.n_b)
    found, shown = settled(oval_problem, load, x, (1 + off) * minimum.tensions)
    assert found.iterations == len(shown) - 1 == 3
    gap = equilibria.distance_up_to_motion(found.x, minimum.shape.x_loop)
    assert gap < 1e-8
    largest = np.abs(minimum.tensions).max()
    np.testing.assert_allclose(found.tensions, minimum.tensions, atol=1e-8 * largest)
    errors = [float(np.abs(at - found.x).max()) for at in shown]
    order = np.log(errors[2] / errors[1]) / np.log(errors[1] / errors[0])
    assert errors[0] > AWAY / 2
    assert order > 1.8
