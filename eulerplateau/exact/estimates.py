"""A fitted number and its interval."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Estimate:
    """A fitted value and its interval; 0 and infinity where the data set no bound.

    The value itself is 0 or infinite where the fit is best in that limit.
    """

    value: float
    low: float
    high: float

    def __str__(self) -> str:
        return f"{self.value:.4g} ({self.low:.4g} to {self.high:.4g})"
