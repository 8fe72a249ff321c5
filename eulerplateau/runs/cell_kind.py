"""How the runs of cells are read back: see kinds.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from eulerplateau.runs.cell_table import CELL_PARAMETERS, CellBranchRow, CellRow
from eulerplateau.runs.kinds import Kind
from eulerplateau.runs.rows import LoadName
from eulerplateau.runs.states import States
from eulerplateau.solvers import Status

CONVEX, INFLECTED, TOUCHING = "convex", "inflected", "touching itself"


def _parameter(about: Mapping[str, Any]) -> LoadName:
    """Return what a cell's run varies."""
    try:
        return CELL_PARAMETERS[about["spec"]["sweep"]["parameter"]]
    except (KeyError, TypeError):
        return CELL_PARAMETERS["sigma_hat"]


def _notes(about: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the cell's adhesions, its edges, and its constants; not what is varied."""
    try:
        cell = about["spec"]["cell"]
        where = str(cell["points"] or f"{cell['adhesions']} adhesions")
        edges = f"{cell['edges_per_side']} edges a side"
        constants = (
            "" if name == _parameter(about).column else f"{name} {cell[name]:g}"
            for name in ("sigma_hat", "ks_hat", "beta_hat")
        )
        return where, edges, *constants
    except (KeyError, TypeError, ValueError):
        return "", "", "", "", ""


def cell_state(row: CellRow) -> str | None:
    """Return a cell's state: CONVEX, INFLECTED or TOUCHING; None if it is no state.

    A cell is inflected where the middle of a side curves inwards. One whose edge meets
    itself is no equilibrium: it shows what a run ends with.
    """
    if row.status is Status.TOUCHING:
        return TOUCHING
    if not row.converged:
        return None
    return CONVEX if row.kappa_mid >= 0 else INFLECTED


def _shown(state: list[CellRow]) -> Sequence[CellRow]:
    """Return what shows a state of a cell.

    That is the roundest of convex cells; of inflected ones the most inflected and, on the
    way there, one half as much; of cells that touch themselves the first.
    """
    if cell_state(state[0]) == TOUCHING:
        return state[:1]
    if cell_state(state[0]) == CONVEX:
        return [max(state, key=lambda row: row.kappa_mid)]
    least = min(range(len(state)), key=lambda place: state[place].kappa_mid)
    half = 0.5 * state[least].kappa_mid
    way = state[: least + 1] if least else state
    middle = min(way, key=lambda row: abs(row.kappa_mid - half))
    return sorted({middle, state[least]}, key=lambda row: row.step)


_STATES = States(
    cell_state, _shown, measure=lambda row: float(row.kappa_mid), between=lambda rows: None
)
CELL = Kind("cell", CellRow, CellBranchRow, _parameter, None, _notes, _STATES)
