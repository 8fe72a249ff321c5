"""`--set KEY=VALUE,...`: replace keys of a specification from the shell."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar

import click

from eulerplateau.errors import EulerPlateauError

S = TypeVar("S")

RESUME = click.option(
    "--resume",
    is_flag=True,
    help="Go on also from a run of the first of these loads. A run that was interrupted is "
    "continued without being asked.",
)
OVERWRITE = click.option(
    "--overwrite", is_flag=True, help="Replace another run that lies in the folder."
)


def refused(errors: Iterable[EulerPlateauError | None]) -> int:
    """Say what stands against runs before any of them computes; return the exit code."""
    found = [error for error in errors if error is not None]
    for error in found:
        click.echo(f"eulerplateau: {error}", err=True)
    return max((error.exit_code for error in found), default=0)


def before(folder: Path, kept: int, finished: bool) -> None:
    """Say what an earlier call has left in a folder, if it is to be kept."""
    if finished:
        click.echo(f"{folder}: finished before, {kept} rows: nothing is computed", err=True)
    elif kept:
        click.echo(f"{folder}: goes on after {kept} rows of an earlier call", err=True)


def parse_setting(text: str) -> tuple[str, list[Any]]:
    """Parse KEY=VALUE,VALUE: TOML values, or bare words."""
    key, equals, given = text.partition("=")
    if not equals or not key:
        raise click.BadParameter(f"{text!r} should be KEY=VALUE,...", param_hint="--set")
    try:
        values = tomllib.loads(f"values = [{given}]")["values"]
    except tomllib.TOMLDecodeError:
        values = given.split(",")
    if not values or "" in values:
        raise click.BadParameter(f"{text!r} should give a value", param_hint="--set")
    return key, values


def load_single(
    path: Path, settings: tuple[str, ...], read: Callable[[Path, dict[str, Any]], S]
) -> S:
    """Read a specification by `read`; each of `settings` is KEY=VALUE, a single value."""
    from eulerplateau.runs import load_with

    return load_with(path, single_values(settings), read)


def single_values(settings: tuple[str, ...]) -> dict[str, Any]:
    """Return the values {dotted key: value} of `settings`, each KEY=VALUE."""
    overrides = {}
    for text in settings:
        key, values = parse_setting(text)
        if len(values) != 1:
            raise click.BadParameter(f"{text!r} should give one value", param_hint="--set")
        overrides[key] = values[0]
    return overrides
