"""The short cut of a descent: what it comes to is believed close by only."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import DenseModels, Descent, Problem, solve
from eulerplateau.solvers.equilibrium import Settled
from tests.helpers import equilibria, shapes

LOAD = 900.0


@dataclass(frozen=True)
class Leading(DenseModels):
    """Models with a short cut that leads where it is told."""

    end: Settled

    def settle(
        self,
        x: FloatArray,
        tensions: FloatArray,
        limit: int,
        observe: Callable[[FloatArray], None],
    ) -> Settled:
        return self.end


@pytest.mark.parametrize(("away", "believed"), [(0.0, True), (0.07, True), (0.13, False)])
def test_short_cut_is_believed_up_to_a_tenth_of_the_length(
    oval: Disk, oval_problem: Problem, away: float, believed: bool
) -> None:
    """Here to a minimum as low as where it starts: the start is that, moved as a whole."""
    found = solve(oval_problem, LOAD, shapes.crumpled(oval, 1e-3))
    assert found.is_minimum
    end = Settled(found.shape.x_loop, found.tensions, 3)
    descent = Descent(Leading(equilibria.loop_energy(oval_problem, LOAD), end), 100)
    state = descent.settled(end.x + np.array([0.0, 0.0, away]), end.tensions, 7)
    assert (state is not None) is believed
    if state is not None:
        np.testing.assert_allclose(state.model.x, end.x, atol=1e-14)
        assert state.iteration == 10
        assert state.stability is not None
        assert state.stability.n_unstable == 0
