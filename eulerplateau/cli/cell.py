"""`eulerplateau cell`: cells as contractile films; one file per command."""

from __future__ import annotations

from importlib import import_module
from typing import cast

import click

# The files of the commands, loaded when one of them is called or asked about.
_FILES = {
    "branches": "cell_runs",
    "fit": "cell_fit",
    "phase-diagram": "cell_phases",
    "shape": "cell_shape",
    "sweep": "cell_runs",
}


class _Commands(click.Group):
    """The commands of cells, of which a call that has no cell in it loads nothing."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return their names."""
        return sorted(_FILES)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return the command of a name, its file loaded now; None if there is none."""
        if cmd_name not in _FILES:
            return None
        module = import_module(f"eulerplateau.cli.{_FILES[cmd_name]}")
        return cast(click.Command, getattr(module, cmd_name.replace("-", "_")))


@click.group(cls=_Commands)
def cell() -> None:
    """Cells that adhere to soft substrates, as contractile films."""
