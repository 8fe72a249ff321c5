"""Brent's method against SciPy's, step for step."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq

from eulerplateau.branches.brent import zero_between


@pytest.mark.parametrize("seed", range(20))
def test_it_asks_for_the_same_places_as_scipy(seed: int) -> None:
    rng = np.random.default_rng(seed)
    root, width, bend = rng.uniform(size=3) * (1.0, 4.0, 3.0)
    low, high = root - rng.uniform(0.1, 2.0), root + rng.uniform(0.1, 2.0)

    def noted(places: list[float]) -> Callable[[float], float]:
        def value(x: float) -> float:
            places.append(x)
            return float(np.tanh(width * (x - root)) + bend * (x - root) ** 3)

        return value

    ours: list[float] = []
    scipys: list[float] = []
    found = zero_between(noted(ours), low, high, 1e-11)
    assert found == brentq(noted(scipys), low, high, xtol=1e-11, rtol=8.9e-16)
    assert ours == scipys
    assert found == pytest.approx(root, abs=1e-10)


def test_after_so_many_tries_it_is_as_far_as_it_came() -> None:
    found = zero_between(lambda x: x**3 - 2.0, 0.0, 5.0, 0.0, tries=3)
    assert 1e-6 < abs(found**3 - 2.0) < 2.0


def test_a_zero_at_an_end_is_found_there() -> None:
    assert zero_between(lambda x: x, 0.0, 1.0, 1e-12) == 0.0
    assert zero_between(lambda x: x - 1.0, 0.0, 1.0, 1e-12) == 1.0
