"""Saddles that a search would take for minima: so flat that a kick comes back to them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Problem, solving
from eulerplateau.solvers.augmented_lagrangian import descend
from eulerplateau.solvers.conjugate_gradient import CONDITIONED
from eulerplateau.solvers.newton import lowest_modes
from eulerplateau.solvers.saddles import way_down
from eulerplateau.solvers.start import KICK
from tests.helpers import shapes

LOAD = 900.0

# A film on a regular hexagon buckles to a saddle surface, turned against its mesh as x y or
# as x^2 - y^2: by symmetry both balance, and the energy of turning has its least at one.
Wave = Callable[[FloatArray], FloatArray]


def along(x: FloatArray) -> FloatArray:
    return 0.5 * (x[:, 0] ** 2 - x[:, 1] ** 2)


def across(x: FloatArray) -> FloatArray:
    return x[:, 0] * x[:, 1]


@pytest.fixture(scope="module")
def hexagon_of_61() -> Disk:
    return shapes.mesh_of(*shapes.hexagon_points(4))


@pytest.mark.parametrize(("wave", "is_saddle"), [(along, True), (across, False)])
@pytest.mark.parametrize("turned", [0.0, 1e-3])
def test_saddle_is_told_by_a_trace_of_its_softest_motion(
    hexagon_of_61: Disk, wave: Wave, is_saddle: bool, turned: float
) -> None:
    """Wherever in space a kick has left it: a rotation is no way down."""
    mesh, problem = hexagon_of_61, Problem(hexagon_of_61)
    start = mesh.x.copy()
    start[:, 2] += wave(mesh.x)
    found = descend(
        problem,
        problem.shape(start),
        np.zeros(mesh.n_b),
        LOAD,
        300,
        lambda _: None,
        CONDITIONED,
        CONDITIONED.residual,
    )
    assert found.converged
    softest = lowest_modes(problem, found, 1)["mode_0"]
    c, s = np.cos(turned), np.sin(turned)
    rotation = np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])
    shape = problem.shape((found.shape.x + 1e-6 * softest) @ rotation)
    down = way_down(problem, found, replace(found, shape=shape), LOAD)
    assert (down is not None) == is_saddle
    exact = solving.solve(problem, LOAD, found)
    assert (exact.energy < found.energy * (1 - 1e-8)) == is_saddle
    if down is not None:
        assert problem.length_error(down) < 1e-12
        gap = np.linalg.norm(down.x_loop - found.shape.x_loop, axis=1).max()
        assert KICK < gap < 2 * KICK


@pytest.mark.slow
def test_sweep_goes_over_to_the_other_minimum_where_its_own_becomes_a_saddle(
    hexagon: Disk,
) -> None:
    """The paper's hexagon turns against its mesh between the loads 1350 and 1400."""
    problem = Problem(hexagon)
    loads = [*range(820, 901, 20), *range(950, 1501, 50)]
    for found in solving.sweep(problem, loads, solver="cg"):
        exact = solving.solve(problem, found.load, found)
        assert found.converged
        assert exact.is_minimum
        assert found.energy == pytest.approx(exact.energy, rel=1e-8)
