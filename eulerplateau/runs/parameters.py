"""What a film's run may vary and what that is called: its load, a number of its loop."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

Parameter = Literal["load", "link", "twist_ratio"]


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
}
