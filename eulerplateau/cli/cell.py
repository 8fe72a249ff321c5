"""`eulerplateau cell`: cells as contractile films; one file per command."""

from __future__ import annotations

import click

from eulerplateau.cli.cell_fit import fit


@click.group()
def cell() -> None:
    """Cells that adhere to soft substrates, as contractile films."""


cell.add_command(fit)
