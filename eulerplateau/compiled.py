"""Numba, which takes long to load: by who has something to compile, and by nobody else."""

from __future__ import annotations

from numba import njit as njit
from numba.core.event import Event, Listener, register

from eulerplateau.compiling import tell


class _Told(Listener):
    def on_start(self, event: Event) -> None:
        tell()

    def on_end(self, event: Event) -> None:
        pass


register("numba:compile", _Told())  # type: ignore[no-untyped-call]
