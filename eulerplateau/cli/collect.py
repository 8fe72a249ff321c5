"""`eulerplateau collect`: one table of many run folders."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from eulerplateau.cli.options import writes_to


@click.command()
@click.argument(
    "folders", metavar="DIR...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@writes_to(
    "The table to write: .csv or .parquet.",
    default=Path("table.csv"),
    show_default=True,
)
@click.option("--quiet", is_flag=True, help="No summary: for batches.")
def collect(folders: tuple[Path, ...], out: Path, quiet: bool) -> None:
    """Join the rows of run folders in one table.

    DIR is a run folder, a folder of such, or one of an ensemble, shards of which may lie in
    several. Each row begins with its run, the seed, the mesh (the first digits of its
    SHA-256) and every key in which the runs differ.
    """
    from eulerplateau.errors import OutputError
    from eulerplateau.runs.ensembles import joined, read_runs_below

    if out.suffix.lower() not in (".csv", ".parquet"):
        raise click.BadParameter(f"{out}: should end in .csv or .parquet")
    table = joined(read_runs_below(folders))
    if not table.lines:
        raise OutputError(folders[0], "has no rows yet: there is nothing to join")
    table.write(out)
    _say(table.missing, "not computed")
    _say(table.unfinished, "not finished")
    _say(table.failed, "failed")
    if not quiet:
        click.echo(f"{out}: {len(table.lines)} lines of {table.runs} runs")


def _say(names: Sequence[str], what: str) -> None:
    if names:
        more = f" and {len(names) - 3} more" if len(names) > 3 else ""
        click.echo(f"eulerplateau: {what}: {', '.join(names[:3])}{more}", err=True)
