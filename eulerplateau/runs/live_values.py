"""What a live film varies: its load and numbers of its loop, each in a range."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from eulerplateau.film import FILM_LOADS
from eulerplateau.loop import MOST
from eulerplateau.runs.parameters import BENCH, LOOP_PARAMETERS, own_parameter
from eulerplateau.runs.rows import LoadName
from eulerplateau.runs.spec import RunSpec


@dataclass(frozen=True)
class Varied:
    """One quantity that a live film varies, in the unit in which it is shown.

    Attributes
    ----------
    parameter : str, of the problem: "load", or one of the loop's own
    name : what the quantity is called
    low, high, value : float, its range, and where it begins
    in_problem : of a value as it is shown, that of the parameter
    """

    parameter: str
    name: LoadName
    low: float
    high: float
    value: float
    in_problem: Callable[[float], float] = float

    @property
    def key(self) -> str:
        """The column of tables that holds it."""
        return self.name.column

    def within(self, value: float) -> float:
        """Return the nearest value in the range."""
        return min(max(value, self.low), self.high)


def varied_by(spec: RunSpec) -> tuple[Varied, ...]:
    """Return what a run's film varies live: first what the run sweeps, over its values.

    Then its load, up to twice the run's, and link and diameter of a loop that has them: the
    one from that of the mirror image to three turns beyond, the other from a quarter to
    twice the run's.
    """
    found, swept, load = [_swept(spec)], spec.sweep.varied, spec.held
    if found[0].parameter != "load" and load is not None:
        name, high = FILM_LOADS[spec.film.model], 2 * load or 1.0
        found.append(Varied("load", name, 0.0, high, load))
    if spec.twist_ratio is not None and swept != "link":
        link = spec.loop.link or 0.0
        ends = -abs(link), abs(link) + 3
        found.append(Varied("link", LOOP_PARAMETERS["link"], *ends, link))
    if spec.diameter is not None and swept != "diameter":
        d = spec.diameter
        ends = d / 4, min(2 * d, MOST["diameter"])
        found.append(Varied("diameter", LOOP_PARAMETERS["diameter"], *ends, d))
    return tuple(found)


def _swept(spec: RunSpec) -> Varied:
    """Return what a run sweeps; of a single value up to twice it."""
    swept, values, bench = spec.sweep.varied, spec.values(), spec.bench
    low, high = min(values), max(values)
    if low == high:
        low, high = min(0.0, 2 * low), max(0.0, 2 * low) or 1.0
    own = own_parameter(spec.column(swept))
    if own is None:
        return Varied("load", FILM_LOADS[spec.film.model], low, high, values[0])
    if bench is None or swept not in BENCH:
        return Varied(swept, own, low, high, values[0])
    one = own.shown(1.0)

    def load(shown: float) -> float:
        return bench.at(**{swept: shown / one})

    return Varied("load", own, low, high, values[0], load)
