"""`eulerplateau examples`: write the example runs and meshes, to begin with."""

from __future__ import annotations

import shlex
from pathlib import Path

import click


@click.command()
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@click.option("--quiet", is_flag=True, help="Print nothing but errors.")
def examples(folder: Path, quiet: bool) -> None:
    """Write the example runs and their meshes to DIR/runs and DIR/meshes.

    Files that are there already are kept; if one differs from the example nothing is
    written.
    """
    from eulerplateau.runs import write_examples

    written = write_examples(folder)
    if not quiet:
        first = shlex.quote(str(folder / "runs" / "elongated.toml"))
        click.echo(f"{folder}: {len(written)} files; next: eulerplateau sweep {first}")
