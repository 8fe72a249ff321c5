"""What a film's run may vary and what that is called: its load, a number of its loop.

The load may be set by a length or a surface tension, in units: a quantity of the bench.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any, Literal

from eulerplateau.units import LENGTH, SURFACE_TENSION, Measure

Parameter = Literal[
    "load",
    "link",
    "twist_ratio",
    "rest_curvature",
    "diameter",
    "length",
    "surface_tension",
]
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
    tex: str
    meaning: str
    energy_rate: Callable[[Any], float]

    @property
    def word(self) -> str:
        """What it is in a word or two."""
        return self.column.replace("_", " ")

    @property
    def unit(self) -> str:
        """That in which it is shown: a pure number has none."""
        return ""

    def shown(self, value: float) -> float:
        """Return a value of the column as it is shown: itself."""
        return value

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
        r"\mathit{Lk}",
        "link",
        lambda row: 2 * math.pi * row.twist_moment,
    ),
    "twist_ratio": LoopParameter(
        "twist_ratio",
        "C/B",
        "rigidity to twist over that to bending",
        lambda row: row.twist_energy / row.twist_ratio,
    ),
    "rest_curvature": LoopParameter(
        "rest_curvature",
        "q",
        "natural curvature over 2 pi / L",
        _energy_by_curvature,
    ),
    "diameter": LoopParameter(
        "diameter",
        "d/L",
        "diameter",
        # Of one that nothing is known of, as no film was found: a row that failed.
        lambda row: math.nan if row.contact_force is None else row.contact_force,
    ),
}


@dataclass(frozen=True)
class BenchParameter:
    """A quantity that sets the load, shown in a unit; see rows.LoadName.

    Attributes
    ----------
    column : str, which holds it in the SI, and says so
    meaning : str
    letter : str, in TeX
    power : int, of which the load is proportional to it
    measure : Measure
    unit : str, in which it is shown: as it was written
    """

    column: str
    letter: str
    meaning: str
    power: int
    measure: Measure
    unit: str

    @property
    def quantity(self) -> str:
        """What Row.quantity is: the column, and the unit in which it is shown."""
        return f"{self.column}{_IN}{self.unit}"

    def shown(self, value: float) -> float:
        """Return a value of the column, in the SI, as it is shown."""
        return value / self.measure.factor(self.unit)

    def energy_rate(self, row: Any) -> float:
        """Return dE/dp of a row, E in units of alpha / L, p as it is shown."""
        return float(self.power * row.film_energy / row.load)

    def error(self, row: Any, error: float) -> float:
        """Return what an error of sigma_hat comes to, in the SI."""
        return float(getattr(row, self.column) * error / (self.power * row.sigma_hat))

    @property
    def word(self) -> str:
        """What it is in a word or two."""
        return self.meaning

    @property
    def text(self) -> str:
        """The name in words, with the unit."""
        return f"{self.meaning} ({self.unit})"

    @property
    def tex(self) -> str:
        """The name in TeX: over its unit, a number."""
        unit = self.unit.replace("*", r"\,")
        unit = rf"(\mathrm{{{unit}}})" if "/" in unit else rf"\mathrm{{{unit}}}"
        return f"{self.letter}/{unit}"

    @property
    def label(self) -> str:
        """The name as a label of an axis."""
        return f"{self.meaning} ${self.tex}$"


_IN = " in "
BENCH = {
    "length": BenchParameter("length_m", "L", "length", 3, LENGTH, LENGTH.unit),
    "surface_tension": BenchParameter(
        "surface_tension_N_per_m",
        r"\gamma",
        "surface tension",
        1,
        SURFACE_TENSION,
        SURFACE_TENSION.unit,
    ),
}


@cache
def own_parameter(quantity: str) -> LoopParameter | BenchParameter | None:
    """Return what a run varies by what its rows call it; None where it is a load."""
    column, _, unit = quantity.partition(_IN)
    for known in BENCH.values():
        if known.column == column:
            return replace(known, unit=unit or known.unit)
    return LOOP_PARAMETERS.get(quantity)


def in_problem(varied: str) -> str:
    """Return what varies of the problem where a run varies a quantity of the bench."""
    return "load" if varied in BENCH else varied
