"""What a run specification may say of what is varied: along a sweep, and along branches."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from pydantic import (
    Field,
    ModelWrapValidatorHandler,
    PrivateAttr,
    field_validator,
    model_validator,
)

from eulerplateau.errors import SpecError
from eulerplateau.loop import LEAST, MOST
from eulerplateau.runs.bench_spec import kind_of, values_in_si
from eulerplateau.runs.loads import Loads, Values, in_order
from eulerplateau.runs.parameters import BENCH, Parameter, in_problem
from eulerplateau.settings import Settings

_MISSING = "is missing and has no default"


class SweepSettings(Settings):
    """Which loads, or values of another parameter, in which order.

    Attributes
    ----------
    loads : list of numbers, ranges {start, stop, step} and refinements
        {onset, nearest, farthest, count}; sorted, each value once.
    parameter : "load", "link", "twist_ratio", "rest_curvature", "diameter"; "length",
        "surface_tension"
        What is varied; by default the load. A length or a surface tension sets the load
        with [rod] and the other of the two; another parameter is varied at the load
        film.load, or at that which [rod] and both of them set.
    values : as loads, of that other parameter; lengths and surface tensions in the SI or
        with units, as "20 cm"
    quantity : "kL3_alpha" or "k" for springs, "sigma_hat" or "sigma" for other films
        What `loads` are: k L^3 / alpha or spring constants k, sigma L^3 / alpha or tensions
        sigma. By default the load, not the constant.
    direction : "up", "down" or "up-down"
    """

    loads: Loads | None = None
    parameter: Parameter | None = None
    values: Values | None = None
    quantity: Literal["kL3_alpha", "k", "sigma_hat", "sigma"] | None = None
    direction: Literal["up", "down", "up-down"] = "up"

    _unit: str = PrivateAttr("")

    @model_validator(mode="wrap")
    @classmethod
    def _in_si(cls, given: Any, made: ModelWrapValidatorHandler[Any]) -> Any:
        """Keep the unit of values that have one, in which they are shown."""
        unit, varied = "", given.get("parameter") if isinstance(given, dict) else None
        if varied in BENCH and isinstance(given.get("values"), list):
            values, unit = values_in_si("sweep.values", varied, given["values"])
            given = {**given, "values": values}
        found = made(given)
        found._unit = unit
        return found

    @field_validator("loads")
    @classmethod
    def _not_negative(cls, loads: tuple[Any, ...] | None) -> tuple[Any, ...] | None:
        for load in loads or ():
            if isinstance(load, float) and load < 0:
                raise ValueError(f"should hold no negative number such as {load}")
        return loads

    @model_validator(mode="after")
    def _loads_or_values(self) -> SweepSettings:
        if self.varied == "load":
            if self.values is not None:
                problem = "needs sweep.parameter, as 'link': loads are sweep.loads"
                raise SpecError("sweep.values", problem)
            if self.loads is None:
                raise SpecError("sweep.loads", _MISSING)
            return self
        for key in ("loads", "quantity"):
            if getattr(self, key) is not None:
                problem = f"should be absent where sweep.parameter is {self.varied!r}"
                load = "the load is film.load, or what [rod] says"
                if self.varied in BENCH:
                    load = f"[rod] and the {self.varied.replace('_', ' ')} set the load"
                raise SpecError(f"sweep.{key}", f"{problem}: {load}")
        if self.values is None:
            raise SpecError("sweep.values", _MISSING)
        check_positive("sweep.values", self.varied, self.in_order())
        return self

    @property
    def varied(self) -> str:
        """What is varied."""
        return self.parameter or "load"

    @property
    def unit(self) -> str:
        """The unit of the values, as it was written; empty where it is that of the SI."""
        return self._unit

    def in_order(self) -> list[float]:
        """Return the values in the order in which they are swept."""
        return in_order(self.loads or self.values or (), self.direction)


class BranchSettings(Settings):
    """Where `eulerplateau branches` ends; a sweep does not use it.

    Attributes
    ----------
    parameter : as that of a sweep
        What is varied, by default what the sweep varies.
    load_min, load_max : float
        The window of loads, k L^3 / alpha of springs and sigma_hat of other films; by
        default that of sweep.loads.
    low, high : float, or a length or a surface tension as in sweep.values
        That of another parameter; by default that of sweep.values.
    special_points : int
        New branches are followed from the first so many folds and bifurcations.
    unstable_modes : int
        A branch is left where more modes than this are unstable.
    """

    parameter: Parameter | None = None
    load_min: float | None = Field(default=None, gt=0)
    load_max: float | None = Field(default=None, gt=0)
    low: float | None = None
    high: float | None = None
    special_points: int = Field(default=8, ge=0)
    unstable_modes: int = Field(default=3, ge=0)

    _units: dict[str, str] = PrivateAttr(default_factory=dict)

    @model_validator(mode="wrap")
    @classmethod
    def _in_si(cls, given: Any, made: ModelWrapValidatorHandler[Any]) -> Any:
        """Keep the units of the window's ends, by what they are."""
        units: dict[str, str] = {}
        ends = given if isinstance(given, dict) else {}
        for key in ("low", "high"):
            if isinstance(ends.get(key), str):
                kind, read = kind_of(f"branches.{key}", ends[key])
                units.setdefault(kind, read.unit)
                given = {**given, key: read.value}
        found = made(given)
        found._units = units
        return found

    @property
    def unit(self) -> str:
        """The unit of the window's ends, as it was written; empty where it has none."""
        return next(iter(self._units.values()), "")

    def window(self, varied: str, values: list[float]) -> tuple[float, float]:
        """Return the window of a parameter, by default that of `values`; SpecError."""
        low_key, high_key = _ENDS[varied == "load"]
        ends = getattr(self, low_key), getattr(self, high_key)
        if not values and None in ends:
            problem = f"and {high_key} should say in which window {varied} is varied"
            raise SpecError(f"branches.{low_key}", problem)
        low, high = (
            choose(values) if end is None else end
            for choose, end in zip((min, max), ends, strict=True)
        )
        if low >= high:
            problem = f"found {low:g}; should be below {high_key}, {high:g}"
            raise SpecError(f"branches.{low_key}", problem)
        check_positive(f"branches.{low_key}", varied, [low])
        return low, high

    def check_window(self, varied: str) -> None:
        """Raise SpecError for a window of something else than what is varied."""
        wrong = self._units.keys() - {varied}
        if wrong:
            problem = f"are of a {wrong.pop()}, where {varied} is varied"
            raise SpecError("branches.low, branches.high", problem)
        own, others = _ENDS[varied == "load"], _ENDS[varied != "load"]
        for key in others:
            if getattr(self, key) is not None:
                problem = f"should be absent where {varied} is varied: the window is"
                raise SpecError(f"branches.{key}", f"{problem} {own[0]} to {own[1]}")


# Whether it is that of loads.
_ENDS = {True: ("load_min", "load_max"), False: ("low", "high")}


def check_positive(key: str, varied: str, values: list[float]) -> None:
    """Raise SpecError for values of a parameter that do not exist."""
    name = in_problem(varied)
    least, most = LEAST[name], MOST.get(name, np.inf)
    for value in values:
        if not least < value <= most:
            bound = f"above {least:g}" if value <= least else f"at most {most:g}"
            problem = f"found {value:g}; {varied} should be {bound}"
            raise SpecError(key, problem)
