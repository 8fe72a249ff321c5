"""Numba, loaded by who has something to compile; and who is told when it does.

What is compiled when it is first used is said: a progress bar stands still meanwhile.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numba import njit as njit

_TOLD: list[Callable[[str], object]] = []


@contextmanager
def telling_of_compiling(say: Callable[[str], object]) -> Iterator[None]:
    """Say so, inside this context, when Numba compiles and does not only load."""
    _TOLD.append(say)
    try:
        yield
    finally:
        _TOLD.remove(say)


def __getattr__(name: str) -> Any:
    """Return Numba's `njit`, which takes long to load: small films of springs need none."""
    if name != "njit":
        raise AttributeError(name)
    from numba import njit
    from numba.core.event import Event, Listener, register

    class Teller(Listener):
        def on_start(self, event: Event) -> None:
            for say in _TOLD:
                say("compiling, once: it takes some seconds")

        def on_end(self, event: Event) -> None:
            pass

    register("numba:compile", Teller())  # type: ignore[no-untyped-call]
    globals()["njit"] = njit  # from now on it is found
    return njit
