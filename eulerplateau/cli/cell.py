"""`eulerplateau cell`: cells as contractile films; one file per command."""

from __future__ import annotations

import click

from eulerplateau.cli.cell_fit import fit
from eulerplateau.cli.cell_phases import phase_diagram
from eulerplateau.cli.cell_runs import branches, sweep
from eulerplateau.cli.cell_shape import shape


@click.group()
def cell() -> None:
    """Cells that adhere to soft substrates, as contractile films."""


cell.add_command(branches)
cell.add_command(fit)
cell.add_command(phase_diagram)
cell.add_command(shape)
cell.add_command(sweep)
