"""Lists of loads: numbers, ranges and refinements, in the order in which they are swept."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
from pydantic import (
    AfterValidator,
    BeforeValidator,
    Discriminator,
    Field,
    Tag,
    ValidationInfo,
    field_validator,
    model_validator,
)

from eulerplateau.settings import Settings

# Of one run: a slip of the pen in a step is told before it takes all memory.
_MOST_LOADS = 100_000


class Range(Settings):
    """Equally spaced values, both ends included (the last may fall short of `stop`)."""

    start: float = Field(ge=0)
    stop: float = Field(ge=0)
    step: float = Field(gt=0)

    @field_validator("stop")
    @classmethod
    def _upwards(cls, stop: float, info: Any) -> float:
        if stop < info.data.get("start", 0):
            raise ValueError(
                "should not be below start: sweep.direction turns a sweep round"
            )
        return stop

    @model_validator(mode="after")
    def _not_endless(self) -> Range:
        if not self._steps() < _MOST_LOADS:
            raise ValueError(f"step = {self.step:g} gives more than {_MOST_LOADS} values")
        return self

    def values(self) -> list[float]:
        """Return the values, ascending."""
        return [float(self.start + i * self.step) for i in range(self.size)]

    @property
    def size(self) -> int:
        """How many values there are."""
        return int(self._steps()) + 1

    def _steps(self) -> float:
        # Half an ulp-sized step of slack: 0.1 * 3 must not lose the end of the range.
        with np.errstate(over="ignore"):
            steps = np.divide(self.stop - self.start, self.step) * (1 + 1e-12)
        return float(np.floor(steps))


class Refinement(Settings):
    """Values onset * (1 + eps), eps geometrically spaced: for scaling laws at an onset."""

    onset: float = Field(gt=0)
    nearest: float = Field(gt=0)
    farthest: float = Field(gt=0)
    count: int = Field(ge=2, le=_MOST_LOADS)

    @property
    def size(self) -> int:
        """How many values there are."""
        return self.count

    def values(self) -> list[float]:
        """Return the values, ascending."""
        distances = np.geomspace(self.nearest, self.farthest, self.count)
        return sorted(float(v) for v in self.onset * (1 + distances))


class SignedRange(Range):
    """The same of a parameter that may be negative."""

    start: float
    stop: float


def _kind_of_load(given: Any) -> str:
    """Tell loads apart, as read from TOML and as the models that are written out."""
    if isinstance(given, Refinement) or (isinstance(given, dict) and "onset" in given):
        return "refinement"
    return "range" if isinstance(given, Range | dict) else "number"


# Told apart beforehand, so that a mistake in one is not reported as one in another.
Load = Annotated[
    Annotated[float, Tag("number")]
    | Annotated[Range, Tag("range")]
    | Annotated[Refinement, Tag("refinement")],
    Discriminator(_kind_of_load),
]


def _a_list(given: Any, info: ValidationInfo) -> Any:
    """Return what may be a list of loads; ValueError that says how one is written."""
    if isinstance(given, int | float) and not isinstance(given, bool):
        raise ValueError(f"should be a list: write {info.field_name} = [{given}]")
    # Behind a check of ours a strict tuple takes no list.
    return tuple(given) if isinstance(given, list) else given


def _not_endless(loads: tuple[Any, ...]) -> tuple[Any, ...]:
    """Return loads; ValueError where there are more than any run gets through."""
    found = sum(1 if isinstance(load, float) else load.size for load in loads)
    if found > _MOST_LOADS:
        raise ValueError(f"should be at most {_MOST_LOADS} values in all, not {found}")
    return loads


# The same of a parameter that may be negative.
Value = Annotated[
    Annotated[float, Tag("number")]
    | Annotated[SignedRange, Tag("range")]
    | Annotated[Refinement, Tag("refinement")],
    Discriminator(_kind_of_load),
]

# A list of them, of which there is one at least.
_LIST = Field(min_length=1), BeforeValidator(_a_list), AfterValidator(_not_endless)
Loads = Annotated[tuple[Load, ...], *_LIST]
Values = Annotated[tuple[Value, ...], *_LIST]


def in_order(loads: Sequence[float | Range | Refinement], direction: str) -> list[float]:
    """Return all that `loads` list, each value once, rising, falling, or both in turn."""
    listed = [[load] if isinstance(load, float) else load.values() for load in loads]
    rising = sorted({value for values in listed for value in values})
    if direction == "up":
        return rising
    falling = rising[::-1]
    return falling if direction == "down" else rising + falling[1:]
