"""Print the thresholds of disks."""

from __future__ import annotations

from pathlib import Path

import click

from eulerplateau.film import FILM_LOADS
from scripts.studies.common import processes
from scripts.studies.disk_thresholds.report import table, write_csv
from scripts.studies.disk_thresholds.thresholds import MESHES, Case, thresholds


@click.command()
@click.option(
    "--film",
    "films",
    type=click.Choice(list(FILM_LOADS)),
    multiple=True,
    default=tuple(FILM_LOADS),
    help="May be repeated. Default: all.",
)
@click.option("--csv", "path", type=click.Path(path_type=Path), help="Also write a CSV.")
def main(films: tuple[str, ...], path: Path | None) -> None:
    """Print the thresholds of a disk, and their orders of convergence, as Markdown."""
    cases = [
        Case(film, polygon, mesh, number)
        for film in films
        for polygon, mesh in MESHES
        for number in range(len(MESHES[polygon, mesh]))
    ]
    with processes() as pool:
        found = list(pool.map(thresholds, cases))
    for film in films:
        click.echo(table(film, found))
    if path is not None:
        write_csv(path, found)


if __name__ == "__main__":
    main()
