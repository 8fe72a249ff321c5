"""An eight in contact that is no minimum: its index on meshes is that without one."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from eulerplateau.branches.conformal import ThickEight
from eulerplateau.solvers import Equilibrium
from scripts.studies.contact_eight.on_meshes import limit, off, orders, round_disk
from scripts.studies.contact_eight.unstable import both_on, rods

EDGES = (120, 240)


@cache
def films() -> tuple[ThickEight, ThickEight]:
    """One film of a rod of stiff twist, and of a rod of soft twist."""
    return rods()


@cache
def on_meshes(edges: int) -> tuple[Equilibrium, Equilibrium]:
    return both_on(round_disk(edges), *films())


@pytest.mark.slow
def test_a_film_of_two_rods_is_a_minimum_of_the_stiffer_one() -> None:
    """Shape, force and moment are the same; the soft rod has come past a fold."""
    stiff, soft = films()
    for film in (stiff, soft):
        assert film.status == "converged"
        assert film.contact_force > 0.0
        assert film.convexity > 0.1
    for name in ("contact_force", "crossing_angle", "writhe", "twist_moment"):
        assert getattr(soft, name) == pytest.approx(getattr(stiff, name), rel=1e-7)
    by_twist = soft.twist_energy - stiff.twist_energy
    assert soft.energy - stiff.energy == pytest.approx(by_twist, rel=1e-7)
    assert stiff.n_unstable == 0
    assert soft.n_unstable == 1


@pytest.mark.slow
@pytest.mark.parametrize("rod", [0, 1])
def test_meshes_have_the_index_of_the_film_without_one(rod: int) -> None:
    exact = films()[rod]
    rows = [off(on_meshes(edges)[rod], exact) for edges in EDGES]
    assert {row.n_unstable for row in rows} == {exact.n_unstable}
    np.testing.assert_allclose(orders(rows), 2.0, atol=0.15)
    energy, force, angle = limit(rows)
    assert abs(energy) < 1e-4
    assert abs(force) < 1e-2
    assert abs(angle) < 0.3
