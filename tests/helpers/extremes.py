"""What the tests of extreme cases share: two disks, three tensions, "the same answer"."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from scripts.studies.stability import cases
from scripts.studies.stability.cases import Outcome
from tests.helpers import shapes

EPS = float(np.finfo(np.float64).eps)
# Films of fixed weights; the film of true area has tests of its own (test_extreme_area).
FIXED = ("springs", "dirichlet")
# Flat and round, flat and long or twisted, overhanging: tensions sigma L^3 / alpha.
TENSIONS = (1000.0, 2600.0, 5200.0)
# The bare circle's lowest eigenvalue: what an eigenvalue next to zero is measured by.
SOFTEST = 2 * (2 * np.pi) ** 4 * 36 / 5


def oval(rings: int = 6) -> cases.DisplacedDisk:
    """Without any symmetry; six loop vertices for each ring."""
    points, triangles = shapes.disk_points(rings, jitter=0.2)
    return cases.disk(points * [1.5, 1.0], triangles)


def hexagon() -> cases.DisplacedDisk:
    """A regular lattice: three axes are equally long."""
    return cases.disk(*shapes.hexagon_points(6))


@cache
def as_made(make: Callable[[], cases.DisplacedDisk], film: str, load: float) -> Outcome:
    """The answer for a disk before anything is done to it, found once."""
    return cases.run(make(), film, load)


def assert_same(one: Outcome, two: Outcome, loss: float = 0.0) -> None:
    """Energies to 1e-11, shapes to 1e-9, eigenvalues to 1e-8; or what was lost before."""
    assert one.found is not None
    assert two.found is not None
    assert one.measures is not None
    assert two.measures is not None
    assert two.found.status is one.found.status
    assert two.found.energy == pytest.approx(one.found.energy, rel=max(1e-11, loss))
    assert one.found.lowest_eigenvalue is not None
    near = max(abs(one.found.lowest_eigenvalue), SOFTEST)
    gap = abs(two.found.lowest_eigenvalue - one.found.lowest_eigenvalue)
    assert gap < max(1e-8, loss) * near
    assert two.found.n_unstable == one.found.n_unstable
    for name, value in one.measures.items():
        within = max(1e-9, loss) * max(1.0, abs(value))
        assert two.measures[name] == pytest.approx(value, abs=within), name
