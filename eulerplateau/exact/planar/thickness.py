"""Which loops are bent too sharply for their diameter."""

from __future__ import annotations

from eulerplateau.errors import NotConvergedError


class TooThickError(NotConvergedError):
    """A loop would have to be bent more sharply than its diameter allows."""


def is_too_thick(kappa_max: float, kappa_min: float, diameter: float) -> bool:
    """Return whether a loop's curvature exceeds 2 / diameter, that of its own radius."""
    return max(kappa_max, -kappa_min) * diameter > 2
