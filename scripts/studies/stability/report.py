"""Table of the trials, in Markdown and CSV."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Sequence
from dataclasses import astuple, fields
from pathlib import Path

import numpy as np

from scripts.studies.common import markdown_table
from scripts.studies.stability.trials import Row

# Head, and how a row is shown, for each column of the page.
COLUMNS: dict[str, Callable[[Row], str]] = {
    "case": lambda row: row.name,
    "film": lambda row: row.film,
    "solver": lambda row: row.solver,
    "what happened": lambda row: row.happened.split(":")[0],
    "iterations": lambda row: str(row.iterations),
    "against": lambda row: row.against,
    "energy": lambda row: _number(row.energy_error),
    "shape": lambda row: _number(row.shape_error),
    "eigenvalue": lambda row: _number(row.eigenvalue_error),
    "condition": lambda row: _number(row.condition),
}


def write_csv(rows: Iterable[Row], path: Path) -> None:
    """Write one line for each row."""
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow([field.name for field in fields(Row)])
        table.writerows(astuple(row) for row in rows)


def tables(rows: Sequence[Row]) -> str:
    """Return a Markdown table for each group of cases."""
    groups = dict.fromkeys(row.group for row in rows)
    return "".join(
        _table(group, [row for row in rows if row.group == group]) for group in groups
    )


def _table(group: str, rows: Sequence[Row]) -> str:
    lines = [[show(row) for show in COLUMNS.values()] for row in rows]
    table = markdown_table([list(COLUMNS), *lines], words=len(COLUMNS))
    return f"\n## {group[0].upper()}{group[1:]}\n\n{table}"


def _number(value: float) -> str:
    return "" if np.isnan(value) else "0" if value == 0 else f"{value:.0e}"
