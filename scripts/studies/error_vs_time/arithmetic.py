"""Arithmetic of the error-against-run-time report: orders, limits, fronts, ratios."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

BoolArray = NDArray[np.bool_]
FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Limit:
    """A value for h -> 0, how far it may be off, and the order of the approach to it."""

    value: float
    uncertainty: float
    order: float


def fitted_order(x: ArrayLike, error: ArrayLike) -> tuple[float, float]:
    """Return p of error = C x^p and its standard error; nan for fewer than three points.

    x, error : (n,) float, positive: element sizes, or seconds.
    """
    a, b = np.log(np.asarray(x, dtype=float)), np.log(np.asarray(error, dtype=float))
    if len(a) < 3:
        return float("nan"), float("nan")
    slope, offset = np.polyfit(a, b, 1)
    scatter = float(np.sum((b - offset - slope * a) ** 2)) / (len(a) - 2)
    return float(slope), float(np.sqrt(scatter / np.sum((a - a.mean()) ** 2)))


def richardson(values: ArrayLike) -> Limit:
    """Return the limit of values (n >= 3,) on meshes each half as fine as the next.

    The order is that of the last three values. The uncertainty is the distance to the limit
    that the three before those give, or with three values to the last one.

    Raises ValueError where the values do not approach a limit.
    """
    v = np.asarray(values, dtype=float)
    if len(v) < 3:
        raise ValueError(f"found {len(v)} values; a limit needs three")
    value, ratio = _extrapolated(v[-3:])
    before = v[-1] if len(v) == 3 else _extrapolated(v[-4:-1])[0]
    return Limit(value, abs(value - float(before)), float(np.log2(ratio)))


def _extrapolated(v: FloatArray) -> tuple[float, float]:
    ratio = float((v[0] - v[1]) / (v[1] - v[2]))
    if not ratio > 1:
        raise ValueError(f"differences shrink by {ratio:.3g}; a limit needs more than 1")
    return float(v[2] + (v[2] - v[1]) / (ratio - 1)), ratio


def pareto(seconds: ArrayLike, error: ArrayLike) -> BoolArray:
    """Return (n,): whether no point is as fast and more exact, or as exact and faster.

    seconds, error : (n,) float.
    """
    t, e = np.asarray(seconds, dtype=float), np.asarray(error, dtype=float)
    no_worse = (t[None] <= t[:, None]) & (e[None] <= e[:, None])
    better = (t[None] < t[:, None]) | (e[None] < e[:, None])
    beaten: BoolArray = np.any(no_worse & better, axis=1)
    return ~beaten


def seconds_to(seconds: ArrayLike, error: ArrayLike, wanted: float) -> float | None:
    """Return the time at which a tool's front reaches an error, None if it never does.

    Between points of the front error and time are interpolated in their logarithms; an
    error that the fastest point undercuts costs what that point costs.
    """
    t, e = np.asarray(seconds, dtype=float), np.asarray(error, dtype=float)
    front = pareto(t, e)
    # From the most exact to the fastest: errors ascend, as np.interp asks.
    order = np.argsort(e[front])
    t, e = t[front][order], e[front][order]
    if len(e) == 0 or wanted < e[0]:
        return None
    return float(np.exp(np.interp(np.log(wanted), np.log(e), np.log(t))))
