"""A loop that is a trefoil knot: strands lie along each other nearly everywhere."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from eulerplateau.loop import close_with_lengths
from eulerplateau.mesh import Shape
from eulerplateau.solvers import Equilibrium, Problem, solve
from scripts.studies.contact_eight.on_meshes import round_disk
from scripts.studies.contact_starts.brute_force import least_distance

DIAMETER, EDGES = 0.03, 60


def trefoil() -> Shape:
    mesh = round_disk(EDGES)
    t = 2 * np.pi * np.cumsum(mesh.rest_lengths)
    x = np.stack(
        [
            np.sin(t) + 2 * np.sin(2 * t),
            np.cos(t) - 2 * np.cos(2 * t),
            -np.sin(3 * t),
        ],
        axis=1,
    )
    x /= np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1).sum()
    problem = Problem(mesh)
    tied, loop = problem.tied_film(), close_with_lengths(problem.loop, x)
    assert tied is not None
    assert loop is not None
    return tied.shape(loop)


def tied(load: float, diameter: float, start: Shape | Equilibrium) -> Equilibrium:
    return solve(Problem(round_disk(EDGES), "springs", diameter=diameter), load, start)


@cache
def under_load() -> Equilibrium:
    return tied(1000.0, DIAMETER, trefoil())


@pytest.mark.slow
def test_a_film_holds_a_knot_whose_strands_overlap_nowhere() -> None:
    found = under_load()
    assert found.is_minimum
    assert found.contacts is not None
    assert found.contacts.forces.min() > 0.0
    assert found.contacts.complementarity < 1e-12 * found.energy
    lengths = round_disk(EDGES).rest_lengths
    least = least_distance(found.shape.x_loop, lengths, 0.5 * np.pi * DIAMETER)
    assert least > (1 - 1e-5) * DIAMETER


@pytest.mark.slow
def test_a_knot_pushes_with_the_energy_s_slope_in_the_diameter() -> None:
    found, h = under_load(), 1e-4
    thick, thin = (tied(1000.0, DIAMETER + way, found) for way in (h, -h))
    assert thick.is_minimum
    assert thin.is_minimum
    assert found.contacts is not None
    slope = (thick.energy - thin.energy) / (2 * h)
    assert found.contacts.force == pytest.approx(slope, rel=1e-3)


@pytest.mark.slow
def test_a_knot_that_no_film_holds_slides_along_itself_for_nothing() -> None:
    """A mode so soft that whether it rests, and is a minimum, is the mesh's affair."""
    found = tied(1.0, DIAMETER, trefoil())
    assert found.residual < 1e-3
    assert found.stability is not None
    lowest, second = found.stability.eigenvalues[:2]
    assert abs(lowest) < 1e-3 * second
