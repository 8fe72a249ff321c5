"""The film of true area in extreme cases: right, or refused, and never wrong unnoticed.

Loads sigma_hat: a round disk at 1000, two flat lobes at 1700.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import pytest

from eulerplateau.solvers.equilibrium import Status
from tests.helpers.equilibria import assert_same_bits
from tests.helpers.extremes import as_made, assert_same, cases, hexagon, oval

LOADS = (1000.0, 1700.0)
# How far a loop that may slide along itself moves the energy: its mesh's error, relative.
SLIDING = 1e-8

SAME: dict[str, Callable[[cases.DisplacedDisk], cases.DisplacedDisk]] = {
    "nanometres": partial(cases.scaled, factor=1e-9),
    "gigametres": partial(cases.scaled, factor=1e9),
    "rotated": cases.rotated,
    "next to the origin": partial(cases.offset, sizes=3.0),
    "renumbered": cases.renumbered,
}


@pytest.mark.parametrize("make", [oval, hexagon])
@pytest.mark.parametrize("change", SAME)
@pytest.mark.parametrize("load", LOADS)
def test_otherwise_given_all_agrees_to_rounding(
    load: float, change: str, make: Callable[[], cases.DisplacedDisk]
) -> None:
    one = as_made(make, "area", load)
    assert one.found is not None
    assert one.found.status is Status.CONVERGED
    assert_same(one, cases.run(SAME[change](make()), "area", load))


@pytest.mark.parametrize("power", [-30, 30])
def test_powers_of_two_change_not_one_bit(power: int) -> None:
    one = as_made(oval, "area", 1700.0).found
    two = cases.run(cases.scaled(oval(), 2.0**power), "area", 1700.0).found
    assert one is not None
    assert two is not None
    assert_same_bits(one, two)


@pytest.mark.parametrize("make", [cases.needle, cases.sliver])
@pytest.mark.parametrize("load", LOADS)
def test_sliver_of_1e8_changes_nothing(
    load: float, make: Callable[[cases.DisplacedDisk, float], cases.DisplacedDisk]
) -> None:
    """A film of true area does not know how its mesh was given: slivers are mended."""
    one = as_made(oval, "area", load).found
    two = cases.run(make(oval(), 1e-8), "area", load).found
    assert one is not None
    assert two is not None
    assert two.status is Status.CONVERGED
    assert two.energy == pytest.approx(one.energy, rel=SLIDING)


@pytest.mark.parametrize("size", [0.05, 0.5])
@pytest.mark.parametrize("load", [0.0, 1000.0])
def test_crumpled_start_comes_to_the_only_minimum(load: float, size: float) -> None:
    one = as_made(oval, "area", load).found
    two = cases.run(cases.crumpled(oval(), size), "area", load).found
    assert one is not None
    assert two is not None
    assert two.status is Status.CONVERGED
    assert two.n_unstable == 0
    assert two.energy == pytest.approx(one.energy, rel=SLIDING)


@pytest.mark.parametrize("solver", cases.SOLVERS)
@pytest.mark.parametrize(
    "start",
    [cases.crossed, cases.doubly_covered, cases.as_a_point,
     partial(cases.started_as, value=np.inf)],
    ids=["crossed", "doubly covered", "a point", "infinite"],
)  # fmt: skip
def test_start_without_a_disk_between_its_strands_is_not_called_converged(
    start: Callable[[cases.DisplacedDisk], cases.DisplacedDisk], solver: str
) -> None:
    found = cases.run(start(oval(4)), "area", 1000.0, solver).found
    assert found is not None
    assert found.status in (Status.PINCHED, Status.STALLED, Status.NOT_FINITE)


@pytest.mark.parametrize("load", [1e5, 1e6, 1e8, 1e12])
def test_load_beyond_contact_is_not_called_converged(load: float) -> None:
    """All of these lie beyond line contact, where no free loop bounds a disk of film."""
    found = cases.run(oval(), "area", load).found
    assert found is not None
    assert found.status not in (Status.CONVERGED, Status.SADDLE)


@pytest.mark.parametrize("load", [0.0, 1e-12, 1e-6])
def test_load_next_to_nothing_leaves_the_bare_circle(load: float) -> None:
    found = cases.run(oval(), "area", load).found
    bare = as_made(oval, "dirichlet", 0.0).found
    assert found is not None
    assert bare is not None
    assert found.status is Status.CONVERGED
    assert found.bending_energy == pytest.approx(bare.energy, rel=SLIDING)


@pytest.mark.parametrize("sides", [3, 4, 5, 6])
@pytest.mark.parametrize("load", [1.0, 1000.0])
def test_loop_of_three_to_six_vertices_is_not_called_converged(
    load: float, sides: int
) -> None:
    found = cases.run(cases.polygon(sides), "area", load).found
    assert found is not None
    assert not found.converged
