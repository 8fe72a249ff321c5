"""What is compiled when it is first used is said: a progress bar stands still meanwhile."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

_TOLD: list[Callable[[str], object]] = []


@contextmanager
def telling_of_compiling(say: Callable[[str], object]) -> Iterator[None]:
    """Say so, inside this context, when Numba compiles and does not only load."""
    _TOLD.append(say)
    try:
        yield
    finally:
        _TOLD.remove(say)


def tell() -> None:
    """Say to all who listen that something is compiled."""
    for say in _TOLD:
        say("compiling, once: it takes some seconds")
