"""Scaling laws at an onset: value = A eps^n (1 + b eps), eps = load / onset - 1.

At a pitchfork n = 1/2 for what is odd in the amplitude of the mode that breaks the
symmetry (kappa_n of a film that leaves its plane) and n = 1 for what is even (<K>).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from eulerplateau.arrays import FloatArray

# Shares of the points that a window leaves out at either end: nine windows.
_LEFT_OUT = (0.0, 0.125, 0.25)
# Points that a window must have beyond the parameters of its fit.
_SPARE_POINTS = 2
# The onset is looked for below the lowest load, at a distance between these multiples of
# the range of loads; the search begins at the best of so many such distances.
_LEAST_GAP, _WIDEST_GAP = 1e-7, 10.0
_STARTS = 24
# Bound on the exponent, so that no power overflows on the way.
_STEEPEST = 5.0


@dataclass(frozen=True)
class WindowFit:
    """The fit to the points of one window, first_load <= load <= last_load.

    `amplitude` is A and `correction` b. `exponent_error` and `onset_error` are standard
    errors (one sigma) from the scatter about this fit alone; infinite where the points
    leave the parameter open.
    """

    first_load: float
    last_load: float
    exponent: float
    exponent_error: float
    onset: float
    onset_error: float
    amplitude: float
    correction: float


@dataclass(frozen=True)
class PowerLaw:
    """value = amplitude * eps^exponent * (1 + correction * eps), eps = load / onset - 1.

    The numbers are those of the window whose exponent is the median over `windows`. An
    error is twice this window's standard error (95 % of the scatter) plus the largest
    departure of any window from it (what the law leaves out). `onset_error` is 0 if the
    onset was given.
    """

    exponent: float
    exponent_error: float
    onset: float
    onset_error: float
    amplitude: float
    correction: float
    windows: tuple[WindowFit, ...]


def fit_power(load: ArrayLike, value: ArrayLike, *, onset: float | None = None) -> PowerLaw:
    """Fit the law to values (n,) of one sign at loads (n,) above the onset.

    Least squares of relative deviations; the onset is fitted too unless it is given. Each
    of nine windows leaves out no, 1/8 or 1/4 of the points at the end nearest the onset,
    and as many at the far end. Space the loads geometrically in eps: then the windows
    differ by the same factors wherever they lie.

    Raises ValueError if there are fewer than 12 loads (10 with a given onset) or two are
    equal, if a load is not above the onset, or if values are zero, not finite or of both
    signs.
    """
    loads, values = _checked(load, value, onset)
    n = len(loads)
    cuts = [int(share * n) for share in _LEFT_OUT]
    windows = tuple(
        _fit_window(loads[low : n - high], values[low : n - high], onset)
        for low, high in product(cuts, cuts)
    )
    middle = sorted(windows, key=lambda w: w.exponent)[len(windows) // 2]
    exponent_spread = max(abs(w.exponent - middle.exponent) for w in windows)
    onset_spread = max(abs(w.onset - middle.onset) for w in windows)
    return PowerLaw(
        exponent=middle.exponent,
        exponent_error=2 * middle.exponent_error + exponent_spread,
        onset=middle.onset,
        onset_error=2 * middle.onset_error + onset_spread,
        amplitude=middle.amplitude,
        correction=middle.correction,
        windows=windows,
    )


def _checked(
    load: ArrayLike, value: ArrayLike, onset: float | None
) -> tuple[FloatArray, FloatArray]:
    """Return loads and values (n,), ascending in the load."""
    loads = np.asarray(load, dtype=np.float64)
    values = np.asarray(value, dtype=np.float64)
    if loads.ndim != 1 or loads.shape != values.shape:
        raise ValueError(f"load {loads.shape}, value {values.shape}: both should be (n,)")
    if not (np.isfinite(loads).all() and np.isfinite(values).all()):
        raise ValueError("a load or a value is not finite")
    needed = 2 * ((4 if onset is None else 3) + _SPARE_POINTS)
    if len(loads) < needed or len(np.unique(loads)) < len(loads):
        raise ValueError(f"at least {needed} loads are needed, all different")
    floor = 0.0 if onset is None else onset
    if not loads.min() > floor >= 0.0:
        raise ValueError(f"loads from {loads.min():g} are not all above {floor:g}")
    if not (values > 0).all() and not (values < 0).all():
        raise ValueError("values should be of one sign, and none of them zero")
    order = np.argsort(loads)
    return loads[order], values[order]


def _fit_window(loads: FloatArray, values: FloatArray, onset: float | None) -> WindowFit:
    """Fit the law to points (n,) ascending in the load, by variable projection.

    Only the exponent and, unless it is given, the onset are searched for (as the logarithm
    of its gap, its distance below the first load over the range of loads): for any choice
    of these the best A and A b solve a linear problem.
    """
    span = float(np.ptp(loads))

    def onset_at(parameters: FloatArray) -> float:
        if onset is not None:
            return onset
        return float(loads[0]) - span * float(np.exp(parameters[1]))

    # Slow to load, and whoever draws a run can do without.
    from scipy.optimize import least_squares

    def misfit(parameters: FloatArray) -> tuple[FloatArray, FloatArray]:
        at = onset_at(parameters)
        _, left, slopes = _project(loads, values, parameters[0], at)
        slopes[1] *= at - float(loads[0])
        return left, slopes[: len(parameters)]

    # A wide gap must not push the onset below zero.
    widest = min(_WIDEST_GAP, 0.99 * float(loads[0]) / span)
    bounds = np.array([[-_STEEPEST, np.log(_LEAST_GAP)], [_STEEPEST, np.log(widest)]])
    start = _start(loads, values, np.geomspace(_LEAST_GAP, widest, _STARTS + 2)[1:-1])
    if onset is not None:
        bounds, start = bounds[:, :1], start[:1]
    found = least_squares(
        lambda parameters: misfit(parameters)[0],
        start,
        lambda parameters: misfit(parameters)[1].T,
        (bounds[0], bounds[1]),
        xtol=1e-12,
        ftol=1e-12,
        gtol=1e-12,
    ).x
    exponent, at = float(found[0]), onset_at(found)
    left, slopes = misfit(found)
    errors = _standard_errors(slopes.T, left, len(loads) - 2 - len(start))
    a, c = _project(loads, values, exponent, at)[0]
    farthest = float(loads[-1]) / at - 1
    return WindowFit(
        first_load=float(loads[0]),
        last_load=float(loads[-1]),
        exponent=exponent,
        exponent_error=float(errors[0]),
        onset=at,
        onset_error=float(errors[1]) * (float(loads[0]) - at) if onset is None else 0.0,
        amplitude=float(a / farthest**exponent),
        correction=float(c / a / farthest),
    )


def _start(loads: FloatArray, values: FloatArray, gaps: FloatArray) -> FloatArray:
    """Return (exponent, log gap) to start from: the best of a row of gaps.

    To first order in b u the law is log value = log A + n log u + b u: a linear fit.
    """
    u = _scaled_distance(loads, loads[0] - gaps[:, None] * np.ptp(loads))
    q, r = np.linalg.qr(np.stack([np.log(u), np.ones_like(u), u], axis=-1))
    logs = np.log(values / values[-1])
    part = logs @ q
    misfits = np.linalg.norm((q @ part[..., None])[..., 0] - logs, axis=1)
    best = int(misfits.argmin())
    exponent = float(np.linalg.solve(r[best], part[best])[0])
    within = np.clip(exponent, -0.9 * _STEEPEST, 0.9 * _STEEPEST)
    return np.array([within, np.log(gaps[best])])


def _project(
    loads: FloatArray, values: FloatArray, exponent: float, onset: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return a, c (2,) that fit (a + c u) u^n best, and law / value - 1 (n,).

    And this misfit's derivatives (2, n) by the exponent and the onset. With C = Q R the
    columns that a and c multiply and r the misfit they leave, dr = (1 - Q Q^T) dC (a, c)
    - Q R^-T dC^T r (Golub and Pereyra 1973). Of two columns Gram and Schmidt's Q will do.
    """
    u = _scaled_distance(loads, onset)
    first = u**exponent / values
    second = first * u
    r11 = np.sqrt(first @ first)
    q1 = first / r11
    r12 = q1 @ second
    q2 = second - r12 * q1
    r22 = np.sqrt(q2 @ q2)
    q2 /= r22
    c = q2.sum() / r22
    a = (q1.sum() - r12 * c) / r11
    misfit = a * first + c * second - 1

    def slope(by_first: FloatArray, by_second: FloatArray) -> FloatArray:
        moved = a * by_first + c * by_second
        w1 = misfit @ by_first / r11
        w2 = (misfit @ by_second - r12 * w1) / r22
        left: FloatArray = moved - (q1 @ moved + w1) * q1 - (q2 @ moved + w2) * q2
        return left

    log, rate = np.log(u), (u - 1) / ((loads[-1] - onset) * u)
    slopes = [
        slope(first * log, second * log),
        slope(exponent * first * rate, (exponent + 1) * second * rate),
    ]
    return np.array([a, c]), misfit, np.array(slopes)


def _scaled_distance(loads: FloatArray, onset: float | FloatArray) -> FloatArray:
    """Return u (n,), eps over its largest value; of onsets (k, 1) a row (k, n) for each."""
    u: FloatArray = (loads - onset) / (loads[-1] - onset)
    return u


def _standard_errors(
    jacobian: FloatArray, misfit: FloatArray, degrees_of_freedom: int
) -> FloatArray:
    """Return one sigma of each parameter (m,) from the Jacobian (n, m) of the misfit (n,).

    Since A and b are projected out, their uncertainty is in it.
    """
    scatter = float(misfit @ misfit) / degrees_of_freedom
    _, sizes, directions = np.linalg.svd(jacobian, full_matrices=False)
    if sizes[-1] <= np.finfo(np.float64).eps * sizes[0]:
        return np.full(len(directions), np.inf)
    errors: FloatArray = np.sqrt(scatter * ((directions / sizes[:, None]) ** 2).sum(axis=0))
    return errors
