"""Which diameters a loop can have, and which loops are bent too sharply for theirs."""

from __future__ import annotations

from eulerplateau.errors import NOT_CONVERGED_EXIT_CODE, EulerPlateauError, SpecError
from eulerplateau.exact.checks import finite

_LARGEST = 0.1


class TooThickError(EulerPlateauError):
    """A loop would have to be bent more sharply than its diameter allows."""

    exit_code = NOT_CONVERGED_EXIT_CODE


def checked_diameter(value: float | None) -> float:
    """Return the diameter of a loop, 0 for None; SpecError for what is none."""
    if value is None:
        return 0.0
    found = finite("diameter", value)
    if not 0 < found <= _LARGEST:
        problem = f"found {found:g}; should be above 0 and at most {_LARGEST}"
        raise SpecError("diameter", problem)
    return found


def is_too_thick(kappa_max: float, kappa_min: float, diameter: float) -> bool:
    """Return whether a loop's curvature exceeds 2 / diameter, that of its own radius."""
    return max(kappa_max, -kappa_min) * diameter > 2
