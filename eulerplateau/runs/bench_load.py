"""How line, loop and liquid set a film's load, where a run says them in place of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from eulerplateau.errors import SpecError
from eulerplateau.exact import Bench
from eulerplateau.film import FILM_LOADS, Load
from eulerplateau.runs.bench_spec import RodSettings
from eulerplateau.runs.film_spec import FilmSettings
from eulerplateau.runs.loop_spec import LoopSettings
from eulerplateau.runs.parameters import BENCH
from eulerplateau.runs.sweep_spec import SweepSettings

_KEYS = {"length": "loop.length", "surface_tension": "film.surface_tension"}
_RODS = "young_modulus and diameter, or bending_rigidity"


@dataclass(frozen=True)
class BenchLoad:
    """The load of a film by quantities in the SI.

    Attributes
    ----------
    rigidity : float, B of the line
    held : of "length" and "surface_tension" those that are not varied
    film : what the load is of this film
    """

    rigidity: float
    held: Mapping[str, float]
    film: Load

    def at(self, **varied: float) -> float:
        """Return the film's load at a value of what is varied, or of nothing."""
        bench = Bench(self.rigidity, **{**self.held, **varied})
        return bench.load / self.film.tension_per_load

    def value(self, varied: str, load: float) -> float:
        """Return the value of what is varied at which the film has a load."""
        bench = Bench(self.rigidity, **{**self.held, varied: 1.0})
        tension = self.film.tension(load)
        if varied == "length":
            return bench.length_at(tension)
        return bench.surface_tension_at(tension)


def bench_load(
    rod: RodSettings | None,
    loop: LoopSettings,
    film: FilmSettings,
    sweep: SweepSettings,
    explored: str,
) -> BenchLoad | None:
    """Return what sets the load of a run's film; None where the run says the load itself.

    Raises SpecError where it is said twice, or where a part of it is missing.
    """
    varied = next((name for name in (sweep.varied, explored) if name in BENCH), "")
    rigidity = None if rod is None else rod.rigidity
    if rigidity is not None and "alpha" in loop.model_fields_set:
        raise SpecError("loop.alpha", "is what [rod] says, half its rigidity: leave it out")
    if not varied and film.surface_tension is None:
        return None
    if rigidity is None:
        raise SpecError("rod", f"should say of which line the loop is: {_RODS}")
    if film.load is not None:
        raise SpecError("film.load", f"is set by {_said(varied)}: leave it out")
    if "load" in (sweep.varied, explored):
        problem = f"is a load, which {_said(varied)} set already; sweep.parameter may be "
        raise SpecError(
            "sweep.loads", f"{problem}'length', with sweep.values = [\"20 cm\"]"
        )
    if varied and explored != sweep.varied:
        raise SpecError("branches.parameter", f"should be absent, or {sweep.varied!r}")
    given = _given(loop, film)
    if varied in given:
        problem = f"is varied by sweep.parameter = {varied!r}: leave it out"
        raise SpecError(_KEYS[varied], problem)
    for name, key in _KEYS.items():
        if name != varied and name not in given:
            example = BENCH[name].measure.example
            raise SpecError(key, f'is missing, as "{example}": it sets the load')
    return BenchLoad(rigidity, given, FILM_LOADS[film.model])


def _given(loop: LoopSettings, film: FilmSettings) -> dict[str, Any]:
    """Return what a run says of its length and its liquid; a length of 1 is no length."""
    given: dict[str, Any] = {}
    if "length" in loop.model_fields_set:
        given["length"] = loop.length
    if film.surface_tension is not None:
        given["surface_tension"] = film.surface_tension
    return given


def _said(varied: str) -> str:
    """Return which keys set the load, with what is varied."""
    keys = [key for name, key in _KEYS.items() if name != varied]
    return f"{', '.join(['[rod]', *keys[:-1]])} and {keys[-1]}"
