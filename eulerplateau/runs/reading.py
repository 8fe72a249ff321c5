"""Read the rows of run folders, of sweeps or of branches, each with its film's load."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from eulerplateau.errors import OutputError
from eulerplateau.film import FILM_LOADS, SPRING_LOAD, TENSION
from eulerplateau.runs.table import BranchRow, Row, read_rows


def read_tables(folders: Sequence[Path]) -> list[list[Row]]:
    """Return the rows of each folder, of branches.csv (BranchRow) or of sweep.csv.

    Their load is the film's own, or sigma_hat if films of both kinds are to be compared.
    Raises OutputError naming the folder that is no run or has no rows yet, or the table
    that cannot be read.
    """
    tables = [read_table(folder) for folder in folders]
    if len({rows[0].quantity for rows in tables}) < 2:
        return tables
    return [[replace(row, quantity=TENSION.column) for row in rows] for rows in tables]


def read_table(folder: Path) -> list[Row]:
    """Return the rows of one folder, at least one; raises what `read_tables` raises."""
    quantity = _quantity(folder)
    rows: list[Row]
    if (folder / "branches.csv").is_file():
        rows = list(read_rows(folder / "branches.csv", BranchRow, quantity))
    elif (folder / "sweep.csv").is_file():
        rows = read_rows(folder / "sweep.csv", quantity=quantity)
    else:
        problem = "is no run folder: it has neither a sweep.csv nor a branches.csv"
        raise OutputError(folder, problem)
    if not rows:
        raise OutputError(folder, "has no rows yet: there is nothing to show")
    return rows


def _quantity(folder: Path) -> str:
    """Return the column of the load of the film that run.json names.

    A table on its own is shown over kL3_alpha, which is right for any film.
    """
    try:
        about = json.loads((folder / "run.json").read_bytes())
        return FILM_LOADS[about["spec"]["film"]["model"]].column
    except (OSError, ValueError, KeyError, TypeError):
        return SPRING_LOAD.column
