"""How far rounding and a residual can bend a flat film: less is drawn as nothing."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.runs.rows import Row
from eulerplateau.solvers import SOFTEST_BENDING


def bend_error(row: Row) -> float:
    """Return what a row's integral of |kappa_n| ds may be where the film is flat.

    The forces of a row balance but for a part of the largest, its residual, in which the
    rounding of positions shows too: left over is f = residual (sigma + 2 k^3) a length,
    with k^2 the mean of kappa^2. Across its plane a film gives way to that by a height w
    with |w| <= |f| / lambda (norms of L2), lambda the lowest eigenvalue. The loop's
    bending is what f and the loop's compression do on w, 2 |w''|^2 <= f |w| + t |w'|^2,
    the film's own part being positive; with |w'|^2 <= |w| |w''|, and t at most
    sigma / 4 + k^2, because no point of a loop is farther than L / 4 from its middle,

        |w''| <= t |w| / 2 + sqrt(|f| |w| / 2),

    and the integral of |kappa_n| over a loop of length 1 is at most |w''|. Where lambda is
    not known it is taken for that of a bare circle. Of an unstable film the lowest is
    negative and another may be nearer to zero: then the error is understated.
    """
    lowest = row.lowest_eigenvalue
    stiffness = SOFTEST_BENDING if lowest is None else abs(lowest)
    sigma, mean_square = abs(row.sigma_hat), abs(row.bending_energy)
    force = float(row.residual * (sigma + 2.0 * mean_square**1.5))
    if force == 0.0:
        return 0.0
    if stiffness == 0.0:
        return math.inf
    height = force / stiffness
    compression = sigma / 4.0 + mean_square
    return compression * height / 2.0 + math.sqrt(force * height / 2.0)


# By columns, what a flat film's may be. The Gauss curvature is of second order in the
# height, and the rounding of its angles less than what rounding leaves of the forces. The
# normal turns across the waist by what it turns along the loop, about: of a harmonic film
# the second derivatives across and along the loop are conjugates.
FLAT_ERRORS: Mapping[str, Callable[[Row], float]] = {
    "abs_kappa_n": bend_error,
    "total_gauss_curvature": bend_error,
    "waist_twist": lambda row: math.degrees(bend_error(row)),
}


def without_noise(
    rows: Sequence[Any], values: FloatArray, error: Callable[[Any], float]
) -> FloatArray:
    """Return a curve's values (n,) as they are drawn: zero if all lie within their errors.

    Rows that are not converged, and values that are NaN, say nothing about that. Values of
    such rows are zero too if they are no larger than the others' errors.
    """
    seen = np.array([row.converged for row in rows], dtype=bool) & np.isfinite(values)
    if not seen.any():
        return values
    errors = np.array([error(row) for row in rows])
    if (np.abs(values[seen]) <= errors[seen]).all():
        return np.where(seen | (np.abs(values) <= errors[seen].max()), 0.0, values)
    return values
