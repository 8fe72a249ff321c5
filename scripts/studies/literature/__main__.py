"""Print the table of docs/literature.md."""

from __future__ import annotations

import click
from threadpoolctl import threadpool_limits

from scripts.studies.common import markdown_table
from scripts.studies.literature.statements import (
    Statement,
    disks,
    rackets,
    rings_under_pressure,
    twisted_rings,
    two_lobes,
)

HEAD = ("statement", "whose", "theirs", "σ̂ of theirs", "here", "agree")  # noqa: RUF001


@click.command()
def main() -> None:
    """Print what others have computed or proved beside what this program gives."""
    click.echo(table(), nl=False)


def table() -> str:
    """Return the table in Markdown."""
    with threadpool_limits(1):
        found = [
            *disks(),
            *two_lobes(),
            *rings_under_pressure(),
            *rackets(),
            *twisted_rings(),
        ]
    return markdown_table([HEAD, *map(cells, found)], words=len(HEAD))


def cells(said: Statement) -> tuple[str, ...]:
    """Return a row of the table."""
    return said.claim, said.whose, said.theirs, said.converted, said.here, said.agree


if __name__ == "__main__":
    main()
