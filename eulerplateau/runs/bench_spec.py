"""What a run may say of its line and its liquid: in the SI, or with units, as "0.2 mm"."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, model_validator

from eulerplateau.errors import SpecError
from eulerplateau.exact import bending_rigidity, isotropic_twist_ratio
from eulerplateau.loop import MOST
from eulerplateau.runs.loads import Refinement, SignedRange
from eulerplateau.runs.parameters import BENCH
from eulerplateau.settings import Settings, validate
from eulerplateau.units import (
    DIAMETER,
    LENGTH,
    RIGIDITY,
    SURFACE_TENSION,
    YOUNG,
    Measure,
    Quantity,
)

# Keys of a range and of a refinement that are such quantities themselves.
_OF_RANGES = {"start", "stop", "step", "onset"}


def _read(measure: Measure) -> tuple[Any, ...]:
    """Return what makes a number of a quantity, with a unit or in the SI."""

    def in_si(given: Any) -> Any:
        return measure.read(given).value if isinstance(given, str) else given

    return BeforeValidator(in_si), Field(gt=0)


Young = Annotated[float, *_read(YOUNG)]
Diameter = Annotated[float, *_read(DIAMETER)]
Rigidity = Annotated[float, *_read(RIGIDITY)]
Length = Annotated[float, *_read(LENGTH)]
SurfaceTension = Annotated[float, *_read(SURFACE_TENSION)]


class RodSettings(Settings):
    """The line a loop is made of: with a length and a surface tension it sets the load.

    Its twist and its thickness act where the loop says so: loop.twist_ratio = "rod",
    loop.diameter = "rod".

    Attributes
    ----------
    young_modulus : float in Pa, or "2 GPa"; needs diameter
    diameter : float in m, or "0.2 mm"
        Of a round line, whose rigidity is then pi/64 young_modulus diameter^4.
    bending_rigidity : float in N m^2, or with a unit
        B = EI = 2 alpha, in place of young_modulus.
    poisson_ratio : float
        C / B = 1 / (1 + poisson_ratio).
    """

    young_modulus: Young | None = None
    diameter: Diameter | None = None
    bending_rigidity: Rigidity | None = None
    poisson_ratio: float | None = Field(default=None, gt=-1, le=0.5)

    @model_validator(mode="after")
    def _one_rigidity(self) -> RodSettings:
        if self.young_modulus is not None:
            if self.bending_rigidity is not None:
                problem = "says again what rod.bending_rigidity says: leave one out"
                raise SpecError("rod.young_modulus", problem)
            if self.diameter is None:
                problem = f'is missing, as "{DIAMETER.example}": young_modulus needs it'
                raise SpecError("rod.diameter", problem)
        return self

    @property
    def rigidity(self) -> float | None:
        """B in N m^2; None where nothing is said of it."""
        if self.young_modulus is None or self.diameter is None:
            return self.bending_rigidity
        return bending_rigidity(self.young_modulus, self.diameter)

    @property
    def twist_ratio(self) -> float:
        """C / B of an isotropic line; raises SpecError where it is not known."""
        if self.poisson_ratio is None:
            problem = 'is missing, as 0.4: loop.twist_ratio = "rod" needs it'
            raise SpecError("rod.poisson_ratio", problem)
        return isotropic_twist_ratio(self.poisson_ratio)

    def thickness(self, length: float) -> float:
        """Return the diameter over a loop's length in m; raises SpecError."""
        if self.diameter is None:
            problem = f'is missing, as "{DIAMETER.example}": loop.diameter = "rod" needs it'
            raise SpecError("rod.diameter", problem)
        if not self.diameter <= MOST["diameter"] * length:
            problem = f"is {self.diameter / length:g} of loop.length; should be at most"
            raise SpecError("rod.diameter", f"{problem} {MOST['diameter']:g} of it")
        return self.diameter / length


def values_in_si(key: str, varied: str, values: Sequence[Any]) -> tuple[list[Any], str]:
    """Return values, ranges expanded, in the SI, and the unit of the first with one.

    Rounded to what a double holds: ten steps of "1 cm" are 0.1, as "10 cm" is. Raises
    SpecError for what is no quantity of the kind that is `varied`.
    """
    measure, units = BENCH[varied].measure, []

    def number(given: Any) -> Any:
        if not isinstance(given, str):
            return given
        read = quantity(key, measure, given)
        units.append(read.unit)
        return read.value

    found: list[Any] = []
    for value in values:
        if isinstance(value, Mapping):
            ends = {k: number(v) if k in _OF_RANGES else v for k, v in value.items()}
            kind: Any = Refinement if "onset" in ends else SignedRange
            found += [float(f"{v:.15g}") for v in validate(ends, kind, key).values()]
        else:
            found.append(number(value))
    return found, units[0] if units else ""


def quantity(key: str, measure: Measure, text: str) -> Quantity:
    """Return the quantity that a key is given; raises SpecError."""
    try:
        return measure.read(text)
    except ValueError as error:
        raise SpecError(key, f"found {text!r}; {error}") from None


def in_si(key: str, ends: Mapping[str, Any]) -> dict[str, Any]:
    """Return a range whose ends and step may have units, in the SI; raises SpecError."""
    return {
        k: kind_of(key, v)[1].value if isinstance(v, str) else v for k, v in ends.items()
    }


def kind_of(key: str, text: str) -> tuple[str, Quantity]:
    """Return which quantity of the bench a text is, and the quantity; raises SpecError."""
    for name, parameter in BENCH.items():
        with suppress(ValueError):
            return name, parameter.measure.read(text)
    examples = " or ".join(repr(known.measure.example) for known in BENCH.values())
    raise SpecError(key, f"found {text!r}; should be a number, or as {examples}")
