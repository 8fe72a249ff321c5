"""A zero between two places of opposite sign, by Brent's method (1973, chapter 4).

Step for step what SciPy's `brentq` does. That lies beside all of its optimisers, which take
as long to load as a fifth of an exploration takes.
"""

from __future__ import annotations

from collections.abc import Callable

# Four times the rounding of a double.
_ROUNDING = 8.9e-16


def zero_between(
    of: Callable[[float], float],
    low: float,
    high: float,
    xtol: float,
    rtol: float = _ROUNDING,
    tries: int = 100,
) -> float:
    """Return where a function vanishes, within xtol + rtol |x|.

    `low` and `high` are places of opposite sign, or zeros. After so many tries it returns
    as far as it came.
    """
    before, here = low, high
    at_before, at_here = of(before), of(here)
    if at_before == 0.0 or at_here == 0.0:
        return before if at_before == 0.0 else here
    beyond = at_beyond = last = step = 0.0
    for _ in range(tries):
        if (at_before < 0.0) != (at_here < 0.0) and at_before != 0.0:
            beyond, at_beyond, last = before, at_before, here - before
            step = last
        if abs(at_beyond) < abs(at_here):
            before, here, beyond = here, beyond, here
            at_before, at_here, at_beyond = at_here, at_beyond, at_here
        near, half = (xtol + rtol * abs(here)) / 2, (beyond - here) / 2
        if at_here == 0.0 or abs(half) < near:
            break
        tried = None
        if abs(last) > near and abs(at_here) < abs(at_before):
            if before == beyond:  # the secant
                tried = -at_here * (here - before) / (at_here - at_before)
            else:  # the inverse parabola
                one = (at_before - at_here) / (before - here)
                other = (at_beyond - at_here) / (beyond - here)
                rise = other * one * (at_beyond - at_before)
                tried = -at_here * (at_beyond * other - at_before * one) / rise
        if tried is not None and 2 * abs(tried) < min(abs(last), 3 * abs(half) - near):
            last, step = step, tried
        else:
            last = step = half
        before, at_before = here, at_here
        here += step if abs(step) > near else (near if half > 0.0 else -near)
        at_here = of(here)
    return here
