"""Options that all commands spell alike, and what the shell offers as their values."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar

import click
from click.shell_completion import CompletionItem

F = TypeVar("F", bound=Callable[..., Any])
# What a figure's file may end in.
FIGURES = (".png", ".pdf", ".svg")
Offer = Callable[[click.Context, click.Parameter, str], list[CompletionItem]]


def writes_to(meaning: str, **more: Any) -> Callable[[F], F]:
    """Return the option of a command that says where it writes, with its `meaning`."""
    names = "-o", "--out", "--output", "out"
    return click.option(*names, type=click.Path(path_type=Path), help=meaning, **more)


def offered_settings(model: str) -> Offer:
    """Return what --set KEY=VALUE may be: keys of a model of `runs`, words they may be."""

    def offer(
        context: click.Context, parameter: click.Parameter, typed: str
    ) -> list[CompletionItem]:
        from eulerplateau import runs
        from eulerplateau.settings import choices

        words = choices(getattr(runs, model))
        key, equals, value = typed.partition("=")
        if equals:
            return [CompletionItem(f"{key}={word}") for word in _of(words.get(key), value)]
        return [CompletionItem(f"{name}=") for name in _of(words, key)]

    return offer


def offered(*words: str) -> Offer:
    """Return what an option offers whose values are mostly some words."""

    def offer(
        context: click.Context, parameter: click.Parameter, typed: str
    ) -> list[CompletionItem]:
        return [CompletionItem(word) for word in _of(words, typed)]

    return offer


def _of(words: Iterable[str] | None, typed: str) -> list[str]:
    return [word for word in words or () if word.startswith(typed)]
