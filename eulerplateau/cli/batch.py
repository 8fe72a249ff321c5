"""Several runs in a call: what stands against them first, then one after the other."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TypeVar

import click

from eulerplateau.errors import ConflictError, EulerPlateauError
from eulerplateau.interruption import heed, working_on

S = TypeVar("S")

RESUME = click.option(
    "--resume",
    is_flag=True,
    help="Go on also from a run of the first of these loads. A run that was interrupted is "
    "continued without being asked.",
)
# Explorations have no loads to append: nothing is left to be asked for.
GOES_ON = click.option(
    "--resume",
    is_flag=True,
    expose_value=False,
    help="Go on from a run that was interrupted, as is done without being asked.",
)
QUIET = click.option("--quiet", is_flag=True, help="No progress, no summary: for batches.")
OVERWRITE = click.option(
    "--overwrite", is_flag=True, help="Replace another run that lies in the folder."
)


def carried_out(
    runs: Sequence[tuple[S, Path]],
    against: Callable[[S, Path], ConflictError | None],
    one: Callable[[S, Path], int],
    overwrite: bool,
) -> int:
    """Carry out runs, each by `one`, into their folders; return the worst exit code.

    Unless runs that lie there are to be overwritten, nothing is computed if anything stands
    `against` a run. What is wrong with one run does not cost the others.
    """
    found = [] if overwrite else [against(*run) for run in runs]
    conflicts = [error for error in found if error is not None]
    for error in conflicts:
        click.echo(f"eulerplateau: {error}", err=True)
    if conflicts:
        return max(error.exit_code for error in conflicts)
    code = 0
    for spec, folder in runs:
        begin(folder)
        try:
            code = max(code, one(spec, folder))
        except EulerPlateauError as error:
            click.echo(f"eulerplateau: {folder}: {error}", err=True)
            code = max(code, error.exit_code)
    return code


def begin(folder: Path | None) -> None:
    """Say from now on, should a signal come, that nothing is in a folder yet."""
    where = "" if folder is None else f"{folder}: "
    working_on(lambda: f"{where}nothing is there yet")
    heed()


def before(folder: Path, line: str) -> None:
    """Say what is done with what an earlier call has left in a folder, if it has."""
    if line:
        click.echo(f"{folder}: {line}", err=True)
