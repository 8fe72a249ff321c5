"""Print the tables of docs/fishing-line.md and draw its pictures."""

from __future__ import annotations

from pathlib import Path

import click

from eulerplateau.branches.conformal import opening_load
from eulerplateau.threads import one_thread
from scripts.studies.common import ROOT, machine, markdown_table
from scripts.studies.fishing_line.cycle import Cycle
from scripts.studies.fishing_line.figures import draw_loop
from scripts.studies.fishing_line.loads import coefficients, openings
from scripts.studies.fishing_line.pictures import draw_run
from scripts.studies.fishing_line.racket import racket_table
from scripts.studies.fishing_line.welded import disk_yields, welded_table


@click.command()
@click.option("--coefficients", "print_series", is_flag=True, help="Print those only.")
@click.option(
    "--run",
    "runs",
    multiple=True,
    type=click.Path(path_type=Path),
    help="A run up and down, beside the films without a mesh; the first is drawn.",
)
@click.option(
    "--welded",
    multiple=True,
    type=click.Path(path_type=Path),
    help="A run up and down of a line that resists twist.",
)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    default=ROOT / "docs/pictures/fishing-line",
    help="Folder of the pictures. Default: docs/pictures/fishing-line.",
)
def main(
    print_series: bool, runs: tuple[Path, ...], welded: tuple[Path, ...], out: Path
) -> None:
    """Print where eights open, and runs beside the films without a mesh."""
    with one_thread():
        if print_series:
            click.echo(", ".join(f"{each:.6f}" for each in coefficients()))
            return
        click.echo(machine())
        click.echo(markdown_table(openings(), 0))
        cycles = [Cycle.of_run(folder) for folder in runs]
        for cycle in cycles:
            click.echo(f"d = {cycle.diameter:g}")
            click.echo(markdown_table(cycle.table(), 0))
        for folder in runs:
            click.echo(f"{folder.name}: where it touches at several places")
            click.echo(markdown_table(racket_table(folder), 0))
        for link in (0.5, 1.0):
            yields, opens = disk_yields(2 / 3, link), opening_load(0.01, 2 / 3, link)
            click.echo(f"Lk = {link:g}: the disk yields at {yields:.2f}, strands of a")
            click.echo(f"line of d = 0.01 touch without force at {opens:.2f}")
        if welded:
            click.echo(markdown_table(welded_table(welded), 0))
        out.mkdir(parents=True, exist_ok=True)
        draw_loop(out / "loop.png", cycles)
        if runs:
            draw_run(runs[0], out)


if __name__ == "__main__":
    main()
