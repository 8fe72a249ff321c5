"""Quantities with units, as one writes them at a bench: "0.2 mm", "2 GPa", "25 mN/m"."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from math import isfinite
from typing import Any

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?![\d.,])\s*(.*)")
# The library would also compute powers of powers, without end.
_FACTOR = r"[^\W\d_]+(?:[²³⁴]|(?:\^|\*\*)-?\d)?"
_UNIT = re.compile(rf"{_FACTOR}(?:(?:\s*[*/·]\s*|\s+){_FACTOR})*")


@dataclass(frozen=True)
class Measure:
    """What kind of quantity is meant.

    Attributes
    ----------
    name : str, what it is in words
    unit : str, its unit in the SI
    example : str, how one is written
    """

    name: str
    unit: str
    example: str

    def read(self, text: str) -> Quantity:
        """Return a positive quantity written with its unit.

        Raises ValueError, in one line that shows an example, where it is none of this kind.
        """
        found = _NUMBER.fullmatch(text)
        if found is None:
            raise ValueError(f"should be {self._written}")
        number, unit = float(found[1]), found[2].strip()
        if not unit:
            raise ValueError(f"has no unit; should be {self._written}")
        value = number * self.factor(unit)
        if not (isfinite(value) and value > 0):
            raise ValueError(f"should be positive and finite, as {self.example!r}")
        return Quantity(value, unit)

    def factor(self, unit: str) -> float:
        """Return a unit in the SI's; ValueError where it is one of something else."""
        if unit == self.unit:
            return 1.0
        try:
            if not _UNIT.fullmatch(unit):
                raise ValueError(unit)
            registry = _registry()
            one = registry.Quantity(1.0, registry.parse_units(unit))
            same = one.is_compatible_with(self.unit)
            found = float(one.to(self.unit).magnitude) if same else None
        except Exception:  # whatever the library makes of a word that is no unit
            raise ValueError(f"{unit!r} is no unit; should be {self._written}") from None
        if found is None:
            raise ValueError(f"{unit!r} is no unit of {self.name}; write {self.example!r}")
        return found

    @property
    def _written(self) -> str:
        return f"a number with a unit of {self.name}, as {self.example!r}"


@dataclass(frozen=True)
class Quantity:
    """A quantity: its value in the SI, and the unit in which it was written."""

    value: float
    unit: str


LENGTH = Measure("length", "m", "20 cm")
DIAMETER = Measure("length", "m", "0.2 mm")
YOUNG = Measure("pressure", "Pa", "2 GPa")
RIGIDITY = Measure("bending rigidity", "N*m^2", "1.6e-7 N m^2")
SURFACE_TENSION = Measure("surface tension", "N/m", "25 mN/m")


@cache
def _registry() -> Any:
    """Return the library's table of units, which takes a second to be read."""
    import pint

    return pint.UnitRegistry()
