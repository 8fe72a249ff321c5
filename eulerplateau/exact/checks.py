"""What is asked of the arguments of exact films, and what is said where they are wrong."""

from __future__ import annotations

from math import isfinite
from operator import index

import numpy as np
from numpy.typing import ArrayLike

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError

# The largest diameter of a loop, in units of its length.
THICKEST = 0.1


def whole_number(name: str, value: object, least: int, most: int | None = None) -> int:
    """Return a whole number within limits; SpecError, under its name, for anything else."""
    try:
        found = index(value)  # type: ignore[arg-type]
    except TypeError:
        found = least - 1
    if found < least or (most is not None and found > most):
        limits = f"{least} or more" if most is None else f"from {least} to {most}"
        raise SpecError(name, f"found {value!r}; should be a whole number, {limits}")
    return found


def finite(name: str, value: object) -> float:
    """Return a number that is finite and not negative; SpecError for anything else."""
    found = _number(value)
    if not (isfinite(found) and found >= 0):
        raise SpecError(name, f"found {_shown(value)}; should be finite and not negative")
    return found


def checked_diameter(value: object) -> float:
    """Return a loop's diameter in units of its length; SpecError for anything else."""
    found = _number(value)
    if not 0 < found <= THICKEST:
        problem = f"found {_shown(value)}; should be above 0 and at most {THICKEST:g}"
        raise SpecError("diameter", problem)
    return found


def _number(value: object) -> float:
    """Return a number; NaN, which is in no range, of what is none."""
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return float("nan")


def _shown(value: object) -> str:
    is_plain = isinstance(value, (float, int))
    return str(value) if is_plain else repr(value).splitlines()[0]


def points(name: str, value: ArrayLike, dimensions: tuple[int, ...]) -> FloatArray:
    """Return points (n, d), contiguous, d one of `dimensions`, every coordinate finite.

    Lists are taken too. Raises SpecError for anything else.
    """
    wanted = f"(points, {' or '.join(map(str, dimensions))})"
    try:
        given = np.asarray(value)
    except ValueError:  # rows of different lengths
        given = np.asarray(None)
    if given.dtype.kind not in "fiu":
        raise SpecError(name, f"is no array of real numbers; should be one {wanted}")
    x = np.ascontiguousarray(given, dtype=np.float64)
    if x.ndim != 2 or x.shape[1] not in dimensions:
        raise SpecError(name, f"found shape {x.shape}; should be {wanted}")
    if not np.isfinite(x).all():
        raise SpecError(name, "has coordinates that are not finite; all should be")
    return x
