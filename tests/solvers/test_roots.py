"""Roots between two places: those of SciPy's Brent to the last bit, and the way there."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress

import numpy as np
import pytest
from scipy.optimize import brentq

from eulerplateau.solvers.roots import root_between

Function = Callable[[float], float]

# Smooth, steep, flat at the root, with a pole beside it, and with a jump in its place.
FUNCTIONS: dict[str, Function] = {
    "line": lambda x: x - 0.1,
    "cubic": lambda x: (x - 0.3) ** 3,
    "flat": lambda x: math.copysign(abs(x - 0.7) ** 9, x - 0.7),
    "exponential": lambda x: math.exp(8 * x) - 20.0,
    "pole": lambda x: 1 / (x + 1e-3) - 1e2,
    "jump": lambda x: 1.0 if x > 1 / 3 else -2.0,
    "tiny": lambda x: 1e-200 * (x**2 - 0.2),
}


def noted(function: Function, places: list[float]) -> Function:
    def value(x: float) -> float:
        places.append(x)
        return function(x)

    return value


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize(("xtol", "rtol"), [(1e-14, 8.9e-16), (1e-3, 1e-12)])
def test_root_and_the_way_to_it_are_brent_s_bit_for_bit(
    name: str, xtol: float, rtol: float
) -> None:
    draw = np.random.default_rng(3)
    for low, high in [(0.0, 1.0), (1.0, 0.0), *draw.uniform([0, 0.8], [0.008, 2], (20, 2))]:
        ours: list[float] = []
        theirs: list[float] = []
        with suppress(ArithmeticError):  # of a root that is flat: neither gets there
            found = root_between(noted(FUNCTIONS[name], ours), low, high, xtol, rtol)
        with suppress(RuntimeError):
            wanted = brentq(noted(FUNCTIONS[name], theirs), low, high, xtol=xtol, rtol=rtol)
            assert found == wanted
        assert ours == theirs


@pytest.mark.parametrize("end", [0.25, 2.0])
def test_end_where_the_function_vanishes_is_the_root(end: float) -> None:
    assert root_between(lambda x: x - end, 0.25, 2.0, 1e-12, 1e-12) == end


def test_no_change_of_sign_and_no_number_are_errors() -> None:
    for function in (lambda x: 1.0 + x, lambda x: math.nan):
        with pytest.raises(ValueError, match="function"):
            root_between(function, 0.0, 1.0, 1e-12, 1e-12)
