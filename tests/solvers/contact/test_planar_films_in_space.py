"""Planar films of a thick loop within space: the same equilibria, and what leaves them."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from eulerplateau.loop import Gaps, strands_of, with_gaps_held
from eulerplateau.mesh import Disk
from eulerplateau.solvers import Equilibrium, Problem, solve, stability, tangent_model
from tests.helpers import shapes
from tests.helpers.equilibria import loop_energy

DIAMETER = 0.05
POINT, LINE = 3500.0, 6000.0


@cache
def disk() -> Disk:
    return shapes.mesh_of(*shapes.disk_points(10))


@cache
def flat(load: float) -> Equilibrium:
    """The film in its plane, by way of one that does not touch itself."""
    problem = Problem(disk(), "area", in_plane=True, diameter=DIAMETER)
    found = solve(problem, load, solve(problem, 2000.0))
    assert found.is_minimum
    return found


def force(found: Equilibrium) -> float:
    assert found.contacts is not None
    assert (found.contacts.forces > 0).all()
    return found.contacts.force


def in_space(twist_ratio: float | None) -> Problem:
    return Problem(disk(), "area", diameter=DIAMETER, twist_ratio=twist_ratio)


@pytest.mark.parametrize("load", [POINT, pytest.param(LINE, marks=pytest.mark.slow)])
def test_a_rod_that_resists_twist_as_bending_stays_flat_where_strands_touch(
    load: float,
) -> None:
    """As it does up to where they touch, whatever the load (docs/welded-loop.md)."""
    found = solve(in_space(1.0), load, flat(load))
    assert found.is_minimum
    assert np.ptp(found.shape.x_loop[:, 2]) < 1e-9
    assert found.energy == pytest.approx(flat(load).energy, rel=1e-7)
    # Along a line both say it by other places: a hundredth of what the mesh errs by.
    within = 1e-6 if load == POINT else 1e-4
    assert force(found) == pytest.approx(force(flat(load)), rel=within)


@pytest.mark.slow
def test_a_rod_that_does_not_resist_twist_leaves_the_plane() -> None:
    """The flat film balances as well, and is a saddle: its two lobes turn."""
    saddle, problem = flat(POINT), in_space(None)
    assert saddle.contacts is not None
    contacts = saddle.contacts
    gaps = Gaps(contacts.s, contacts.t, contacts.slides)
    energy = loop_energy(problem, POINT, saddle.shape)
    held = with_gaps_held(energy, strands_of(problem.loop), gaps)
    model = tangent_model(held, saddle.shape.x_loop)
    assert model.residual < 1e-9
    assert -model.tensions[disk().n_b :].sum() == pytest.approx(force(saddle), rel=1e-9)
    assert stability(model).n_unstable == 1
    found = solve(problem, POINT, saddle)
    assert found.is_minimum
    assert found.energy < saddle.energy - 1.0
    x = found.shape.x_loop
    assert np.linalg.svd(x - x.mean(axis=0), compute_uv=False)[2] > 0.05
    assert force(found) > 0


@pytest.mark.slow
def test_force_is_the_slope_of_the_twisted_film_s_energy_in_the_diameter() -> None:
    found = solve(in_space(None), POINT, flat(POINT))

    def energy(diameter: float) -> float:
        near = solve(Problem(disk(), "area", diameter=diameter), POINT, found)
        assert near.is_minimum
        return near.energy

    step = 1e-3 * DIAMETER
    slope = (energy(DIAMETER + step) - energy(DIAMETER - step)) / (2 * step)
    assert force(found) == pytest.approx(slope, rel=1e-5)
