"""`--set KEY=VALUE,...`: replace keys of a specification from the shell."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from eulerplateau.cli.options import offered_settings

S = TypeVar("S")
F = TypeVar("F", bound=Callable[..., Any])


def parse_setting(text: str) -> tuple[str, list[Any]]:
    """Parse KEY=VALUE,VALUE: TOML values, or bare words."""
    key, equals, given = text.partition("=")
    if not equals or not key:
        raise click.BadParameter(f"{text!r} should be KEY=VALUE,...", param_hint="--set")
    try:
        values = tomllib.loads(f"values = [{given}]")["values"]
    except (ValueError, RecursionError):  # no TOML, or more of it than can be read
        values = given.split(",")
    if not values or "" in values:
        raise click.BadParameter(f"{text!r} should give a value", param_hint="--set")
    return key, values


def setting(example: str, model: str = "RunSpec") -> Callable[[F], F]:
    """Return the option --set of a command that carries out one run, a `model` of runs."""
    return click.option(
        "--set",
        "settings",
        metavar="KEY=VALUE",
        multiple=True,
        shell_complete=offered_settings(model),
        help=f"Replace a key of the specification, as in {example}.",
    )


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
