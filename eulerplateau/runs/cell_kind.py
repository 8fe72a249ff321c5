"""How the runs of cells are read back: see kinds.py."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from eulerplateau.runs.cell_table import CELL_PARAMETERS, CellBranchRow, CellRow
from eulerplateau.runs.kinds import Kind
from eulerplateau.runs.protocols import LoadName


def _parameter(about: Mapping[str, Any]) -> LoadName:
    """Return what a cell's run varies."""
    try:
        return CELL_PARAMETERS[about["spec"]["sweep"]["parameter"]]
    except (KeyError, TypeError):
        return CELL_PARAMETERS["sigma_hat"]


def _notes(about: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the cell's adhesions, its edges, and its constants."""
    try:
        cell = about["spec"]["cell"]
        where = cell["points"] or f"{cell['adhesions']} adhesions"
        edges = f"{cell['edges_per_side']} edges a side"
        constants = (
            f"{name} {cell[name]:g}" for name in ("sigma_hat", "ks_hat", "beta_hat")
        )
        return where, edges, *constants
    except (KeyError, TypeError):
        return "", "", "", "", ""


CELL = Kind("cell", CellRow, CellBranchRow, _parameter, None, _notes)
