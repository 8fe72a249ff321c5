"""The merit function of strands kept apart everywhere, evaluated without the solver."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from eulerplateau.loop import close_with_lengths
from eulerplateau.solvers import Problem, solve
from eulerplateau.solvers.contact.everywhere import Everywhere
from eulerplateau.solvers.contact.keeping import Touching
from eulerplateau.solvers.contact.merit import Merit
from scripts.studies.contact_starts.brute_force import least_distance
from scripts.studies.contact_starts.starts import case, disk_of, loop_of

# Films tied to their mesh whose strands come to lie along each other, of springs and of
# Dirichlet's energy: from the energy alone these would not be told to fall.
HARD = (18, pytest.param(37, marks=pytest.mark.slow))


@pytest.mark.parametrize("seed", HARD)
def test_the_merit_function_falls_in_every_step_though_the_energy_does_not(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """P = E + price times overlap; E that of the whole film, the overlap by brute force."""
    told = case(seed)
    mesh = disk_of(told.aspect)
    problem = Problem(mesh, told.film, diameter=told.diameter)
    film = (
        problem.tied_film()
        if told.film == "dirichlet"
        else problem.film.of_loop(mesh.shape)
    )
    assert film is not None
    steps: list[tuple[float, Touching, Touching]] = []
    advance = Everywhere._advance

    def recorded(self: Everywhere, state: Touching, known: object, merit: Merit) -> object:
        found = advance(self, state, known, merit)
        if found is not None:
            steps.append((merit.price, state, found[0]))
        return found

    monkeypatch.setattr(Everywhere, "_advance", recorded)
    start = close_with_lengths(problem.loop, loop_of(mesh, told))
    assert start is not None
    found = solve(problem, told.load, film.shape(start))
    assert found.is_minimum
    assert len(steps) > 3

    def parts(state: Touching) -> tuple[float, float]:
        x, apart = state.model.x, 0.5 * np.pi * told.diameter
        least = least_distance(x, mesh.rest_lengths, apart)
        return problem.energy(film.shape(x), told.load), max(0.0, told.diameter - least)

    energies, falls = [], []
    for price, before, after in steps:
        assert price > after.forces.sum()
        (e0, o0), (e1, o1) = parts(before), parts(after)
        energies.append(e1 - e0)
        falls.append(e0 - e1 + price * (o0 - o1))
    # Sums of squares of a thousand vertices, and brute force that ends at 1e-9 L.
    rounding = 1e-12 * found.energy
    assert min(falls) > -rounding
    assert max(energies) > 1e3 * rounding
    for (_, _, one), (_, other, _) in pairwise(steps):
        assert np.array_equal(one.model.x, other.model.x)
