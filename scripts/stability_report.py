"""What becomes of stiff and extreme cases: docs/stability.md and docs/stability.csv."""

from __future__ import annotations

import csv
import logging
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import astuple, fields
from itertools import groupby
from pathlib import Path

import click
import extreme_cases as cases
import numpy as np
from stability_trials import Row, row, trials
from threadpoolctl import threadpool_limits

PAGE = Path(__file__).parents[1] / "docs" / "stability.md"
# The table stands below this line of the page, what it shows above.
MARK = "<!-- Below this line: printed by scripts/stability_report. -->"

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


@click.command()
@click.option(
    "--film", "films", multiple=True, default=cases.FILMS, help="Only these films."
)
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=False),
    default=PAGE.parent,
    help="Where stability.csv and the table of stability.md go; default: docs.",
)
def main(films: Sequence[str], out: Path) -> None:
    """Carry out every trial; write the table, and count what happened."""
    todo = [trial for film in films for trial in trials(film)]
    with ProcessPoolExecutor(initializer=_quiet) as pool:
        rows = list(pool.map(row, todo))
    out.mkdir(parents=True, exist_ok=True)
    write_csv(rows, out / "stability.csv")
    said = PAGE.read_text(encoding="utf-8").partition(MARK)[0]
    (out / PAGE.name).write_text(f"{said}{MARK}\n{tables(rows)}", encoding="utf-8")
    words = sorted(COLUMNS["what happened"](row) for row in rows)
    for word, alike in groupby(words):
        click.echo(f"{word}: {len(list(alike))}")


def _quiet() -> None:
    """One thread for each process; offsets are warned of, and here that is known."""
    threadpool_limits(1)
    logging.getLogger("eulerplateau").setLevel(logging.ERROR)


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
    lines = [list(COLUMNS), ["---"] * len(COLUMNS)]
    lines += [[show(row) for show in COLUMNS.values()] for row in rows]
    body = "\n".join("| " + " | ".join(line) + " |" for line in lines)
    return f"\n## {group[0].upper()}{group[1:]}\n\n{body}\n"


def _number(value: float) -> str:
    return "" if np.isnan(value) else "0" if value == 0 else f"{value:.0e}"


if __name__ == "__main__":
    main()
