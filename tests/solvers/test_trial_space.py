"""What conjugate gradients vary: the energy's differences from a base shape are exact."""

from __future__ import annotations

import numpy as np
import pytest

from eulerplateau.loop.kernels import film_energy_gradient
from eulerplateau.mesh.disk import Disk
from eulerplateau.solvers import Problem
from eulerplateau.solvers.trial_space import trial_space
from tests.helpers import shapes

LOAD = 700.0
RNG = np.random.default_rng(3)


@pytest.mark.parametrize("film", ["springs", "dirichlet", "area", "plane"])
def test_films_energy_beyond_its_linear_part_is_that_of_the_shape_reached(
    oval: Disk, film: str
) -> None:
    """Value and gradient, for a step that is not small."""
    plane = film == "plane"
    problem = Problem(oval, "area" if plane else film, in_plane=plane)
    start = oval.shape if plane else oval.shape.moved(shapes.crumpled(oval, 0.01))
    shape = problem.film.prepared(start)
    space = trial_space(problem, shape, LOAD)
    moved = space.displacement(1e-3 * RNG.standard_normal(space.size))
    before, slope = problem.film.energy_gradient(shape, LOAD)
    after, steeper = problem.film.energy_gradient(shape.moved(shape.x + moved), LOAD)
    gradient = np.zeros_like(shape.x)
    value = film_energy_gradient(moved, *space.springs, gradient)
    value += space.beyond_linear(moved, gradient)
    expected = after - before - np.vdot(slope, moved)
    assert expected > 1e-6 * after or plane
    assert value == pytest.approx(expected, abs=1e-12 * after)
    np.testing.assert_allclose(gradient, steeper - slope, atol=1e-12 * np.abs(slope).max())
