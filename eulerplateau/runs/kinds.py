"""What runs follow, films or cells: how the tables of each are read, and what they show."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from eulerplateau.film import FILM_LOADS, SPRING_LOAD
from eulerplateau.runs.parameters import BENCH, own_parameter
from eulerplateau.runs.rows import (
    BranchRow,
    CurvedRodBranchRow,
    CurvedRodRow,
    LoadName,
    OfLength,
    OfRatio,
    OfSurfaceTension,
    Row,
    TwistBranchRow,
    TwistRow,
    columns,
    with_own,
)
from eulerplateau.runs.states import FILM_STATES, States


@dataclass(frozen=True)
class Kind:
    """A kind of run, by the name in its run.json.

    Attributes
    ----------
    row, branch_row : the rows of sweep.csv and of branches.csv
    load : what a run varies, by its run.json
    common_load : the column to show runs over that vary different things; None if none
    notes : what a run.json says that tells runs of one name apart
    states : how the states of a run are told apart
    """

    name: str
    row: type[Any]
    branch_row: type[Any]
    load: Callable[[Mapping[str, Any]], LoadName]
    common_load: str | None
    notes: Callable[[Mapping[str, Any]], tuple[str, ...]]
    states: States

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns of its sweep.csv; branches.csv has more."""
        return columns(self.row)

    def quantity(self, about: Mapping[str, Any]) -> str:
        """Return what the rows of a run call what it varies, by its run.json."""
        return str(about.get("varied", self.load(about).column))


def _load(about: Mapping[str, Any]) -> LoadName:
    """Return the load of the film that run.json names.

    A table on its own is shown over kL3_alpha, which is right for any film.
    """
    try:
        return FILM_LOADS[about["spec"]["film"]["model"]]
    except (KeyError, TypeError):
        return SPRING_LOAD


def _notes(about: Mapping[str, Any]) -> tuple[str, ...]:
    """Return what run.json says of the film, of the mesh's size and of the solver."""
    try:
        film, solver = about["spec"]["film"]["model"], about["spec"]["solver"]["name"]
        return str(film), f"{about['mesh']['vertices']} vertices", str(solver)
    except (KeyError, TypeError):
        return "", "", ""


FILM = Kind("film", Row, BranchRow, _load, "sigma_hat", _notes, FILM_STATES)
WITH_TWIST = replace(FILM, row=TwistRow, branch_row=TwistBranchRow)
CURVED = replace(FILM, row=CurvedRodRow, branch_row=CurvedRodBranchRow)
# Columns for what is varied, where a loop's rows have none.
_OWN: dict[str, Any] = {
    "twist_ratio": OfRatio,
    BENCH["length"].column: OfLength,
    BENCH["surface_tension"].column: OfSurfaceTension,
}

# With each of these the load varies too.
_OF_BENCH = {own.column for own in BENCH.values()}


def film_kind(twist_ratio: Any, rest_curvature: Any, varied: Any = "load") -> Kind:
    """Return the kind of a film's run, by the rod of its loop and what its rows vary.

    What varies a number of the loop is not to be shown over the load; what varies a length
    or a surface tension may be.
    """
    kind = FILM
    if twist_ratio is not None:
        kind = CURVED if rest_curvature else WITH_TWIST
    own = own_parameter(str(varied))
    if own is None:
        return kind
    if own.column in _OWN:
        rows: tuple[Any, Any] = kind.row, kind.branch_row
        row, branch_row = (with_own(_OWN[own.column], plain) for plain in rows)
        kind = replace(kind, row=row, branch_row=branch_row)
    common = kind.common_load if own.column in _OF_BENCH else None
    return replace(kind, load=lambda about: own, common_load=common)
