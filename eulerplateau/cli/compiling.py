"""What is compiled when it is first used is said: a progress bar stands still meanwhile."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def telling_of_compiling(say: Callable[[str], object]) -> Iterator[None]:
    """Say so, inside this context, when Numba compiles and does not only load."""
    from numba.core.event import Event, Listener, install_listener

    class Told(Listener):
        def on_start(self, event: Event) -> None:
            say("compiling, once: it takes some seconds")

        def on_end(self, event: Event) -> None:
            pass

    with install_listener("numba:compile", Told()):
        yield
