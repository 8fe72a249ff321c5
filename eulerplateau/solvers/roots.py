"""The root of a function between two places where it has opposite signs (Brent 1973)."""

from __future__ import annotations

import math
from collections.abc import Callable

_MOST_STEPS = 100


def root_between(
    function: Callable[[float], float], low: float, high: float, xtol: float, rtol: float
) -> float:
    """Return where `function` vanishes, within xtol + rtol |x|, or the end where it does.

    To the last bit what scipy.optimize.brentq returns, which takes longer to load than many
    a sweep to carry out. Raises ValueError if the function has one sign at both ends, or is
    NaN, and ArithmeticError if it is not found in a hundred steps.
    """
    before, here, beyond = low, high, 0.0
    value_before, value, value_beyond = _at(function, low), _at(function, high), 0.0
    if value_before == 0 or value == 0:
        return before if value_before == 0 else here
    if (value_before < 0) == (value < 0):
        raise ValueError(f"the function has one sign at {low:g} and {high:g}")
    earlier = step = 0.0
    for _ in range(_MOST_STEPS):
        if value_before != 0 and (value_before < 0) != (value < 0):
            beyond, value_beyond = before, value_before
            earlier = step = here - before
        if abs(value_beyond) < abs(value):
            before, here, beyond = here, beyond, here
            value_before, value, value_beyond = value, value_beyond, value
        tolerance = (xtol + rtol * abs(here)) / 2
        half = (beyond - here) / 2
        if value == 0 or abs(half) < tolerance:
            return here
        guess = math.inf
        if abs(earlier) > tolerance and abs(value) < abs(value_before):
            if before == beyond:  # along the secant
                guess = -value * (here - before) / (value - value_before)
            else:  # along the inverse parabola
                one = (value_before - value) / (before - here)
                other = (value_beyond - value) / (beyond - here)
                along = value_beyond * other - value_before * one
                below = other * one * (value_beyond - value_before)
                guess = -value * along / below if below else math.inf
        if 2 * abs(guess) < min(abs(earlier), 3 * abs(half) - tolerance):
            earlier, step = step, guess
        else:
            earlier = step = half
        before, value_before = here, value
        here += step if abs(step) > tolerance else math.copysign(tolerance, half)
        value = _at(function, here)
    raise ArithmeticError(f"no root is found between {low:g} and {high:g}")


def _at(function: Callable[[float], float], place: float) -> float:
    value = float(function(place))
    if math.isnan(value):
        raise ValueError(f"the function is NaN at {place:g}")
    return value
