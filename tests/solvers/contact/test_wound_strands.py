"""Strands that wind round each other at high loads: the racket on a mesh."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from eulerplateau.loop import strands_of
from eulerplateau.solvers import Equilibrium, Problem, solve
from scripts.studies.contact_starts.brute_force import least_distance
from tests.solvers.test_contact import crossed, disk

DIAMETER, LOADS = 0.05, (2000.0, 3000.0, 4000.0, 5000.0, 6000.0)


@cache
def wound() -> tuple[Equilibrium, ...]:
    """The eight loaded until its strands touch along a stretch of them."""
    mesh, found = disk(12), []
    problem, start = Problem(mesh, "area", diameter=DIAMETER), crossed(mesh)
    for load in LOADS:
        found.append(solve(problem, load, found[-1] if found else start))
    return tuple(found)


@pytest.mark.slow
@pytest.mark.parametrize("row", range(1, len(LOADS)))
def test_strands_come_to_wind_round_each_other_in_tens_of_steps(row: int) -> None:
    found = wound()[row]
    contacts = found.contacts
    assert found.is_minimum
    assert found.iterations < 60
    assert contacts is not None
    assert contacts.forces.min() > 0.0
    assert contacts.force > 5 / 4 * wound()[row - 1].contacts.force
    strands, x = strands_of(Problem(disk(12), diameter=DIAMETER).loop), found.shape.x_loop
    widths = strands.at(x, contacts.places)[1]
    np.testing.assert_allclose(widths, 0.0, atol=1e-11)
    loop = found.shape.x_loop
    least = least_distance(loop, disk(12).rest_lengths, 0.5 * np.pi * DIAMETER)
    assert least > (1 - 2e-6) * DIAMETER
    assert contacts.smallest_gap == pytest.approx(least - DIAMETER, abs=1e-7 * DIAMETER)


@pytest.mark.slow
def test_wound_strands_push_with_the_energy_s_slope_in_the_diameter() -> None:
    found = wound()[-1]
    assert found.contacts is not None
    assert not found.contacts.at_a_point.any()

    def slope(step: float) -> float:
        thick, thin = (
            solve(Problem(disk(12), "area", diameter=DIAMETER + way), LOADS[-1], found)
            for way in (step, -step)
        )
        assert thick.is_minimum
        assert thin.is_minimum
        return (thick.energy - thin.energy) / (2 * step)

    # Farther off the film is laid on other triangles.
    wide, near = slope(1e-4), slope(5e-5)
    assert found.contacts.force == pytest.approx((4 * near - wide) / 3, rel=1e-5)
