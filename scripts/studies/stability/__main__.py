"""Carry out every trial, and write what became of it."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from itertools import groupby
from pathlib import Path

import click
from threadpoolctl import threadpool_limits

from scripts.studies.common import ROOT
from scripts.studies.stability import cases
from scripts.studies.stability.report import COLUMNS, tables, write_csv
from scripts.studies.stability.trials import row, trials

PAGE = ROOT / "docs" / "stability.md"
# The table stands below this line of the page, what it shows above.
MARK = "<!-- Below this line: printed by scripts/stability_report. -->"


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


if __name__ == "__main__":
    main()
