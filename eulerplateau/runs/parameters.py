"""What a film's run may vary and what that is called: its load, a number of its loop."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

Parameter = Literal["load", "link", "twist_ratio", "rest_curvature", "diameter"]
# The key of the loop without which there is nothing to vary.
NEEDED = {
    "link": "twist_ratio",
    "twist_ratio": "twist_ratio",
    "rest_curvature": "rest_curvature",
    "diameter": "diameter",
}


@dataclass(frozen=True)
class LoopParameter:
    """A number of the loop that a run varies; see rows.LoadName.

    Attributes
    ----------
    energy_rate : of a row, the derivative of its energy by it
    meaning : str, what it is in words
    """

    column: str
    symbol: str
    tex: str
    meaning: str
    energy_rate: Callable[[Any], float]

    @property
    def text(self) -> str:
        """The name in ASCII."""
        return self.column

    @property
    def label(self) -> str:
        """The name as a label of an axis."""
        return f"{self.meaning} ${self.tex}$"


def _energy_by_curvature(row: Any) -> float:
    """Return dE/dq of a row: E has -2 k0 oint k1 ds + k0^2 besides, k0 = 2 pi q."""
    parts = row.film_energy + row.bending_energy + row.twist_energy
    besides, q = row.energy - parts, row.rest_curvature
    return float(besides / q + 4 * math.pi**2 * q)


LOOP_PARAMETERS = {
    "link": LoopParameter(
        "link",
        "Lk",
        r"\mathit{Lk}",
        "link",
        lambda row: 2 * math.pi * row.twist_moment,
    ),
    "twist_ratio": LoopParameter(
        "twist_ratio",
        "C/B",
        "C/B",
        "rigidity to twist over that to bending",
        lambda row: row.twist_energy / row.twist_ratio,
    ),
    "rest_curvature": LoopParameter(
        "rest_curvature",
        "q",
        "q",
        "natural curvature over 2 pi / L",
        _energy_by_curvature,
    ),
    "diameter": LoopParameter(
        "diameter",
        "d",
        "d/L",
        "diameter",
        # Of one that nothing is known of, as no film was found: a row that failed.
        lambda row: math.nan if row.contact_force is None else row.contact_force,
    ),
}
