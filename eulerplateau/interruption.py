"""SIGINT, SIGTERM and SIGHUP: noted when they come, looked at where that is safe.

A handler that raises does so anywhere: inside a library that takes it for an error of its
own, a compiler that loses it, a binding that crashes. The one here takes a note, and `heed`
raises between two iterations. A thread, which Python wakes whatever the program is busy
with, ends it after 5 s if nobody has looked, and at once with a second signal.

Nothing of this happens unless the command line has called `listen`.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from select import select

# Seconds after which a signal ends the program even if nobody looks.
_WAIT = 5.0
# What shells add to a signal's number.
_SIGNALLED = 128


class Interrupted(BaseException):
    """A signal has come; no Exception, so that nobody takes it for an error of his own.

    Attributes
    ----------
    code : int, what the shell is to see
    words : str, what there is of what the program was to do
    """

    def __init__(self, number: int, words: str) -> None:
        super().__init__(number, words)
        self.code, self.words = _SIGNALLED + number, words

    def __str__(self) -> str:
        return f"interrupted: {self.words}" if self.words else "interrupted"


@dataclass
class _Noted:
    """The first signal that has come, and what there is to say and to do for it."""

    number: int = 0
    heard: tuple[signal.Signals, ...] = ()
    words: Callable[[], str] = lambda: "nothing is there yet"
    last_act: Callable[[], None] = lambda: None


_noted = _Noted()


def heed() -> None:
    """Raise Interrupted if a signal has come."""
    if _noted.number:
        raise Interrupted(_noted.number, _noted.words())


def working_on(
    words: Callable[[], str], last_act: Callable[[], None] = lambda: None
) -> None:
    """Say from now on what there is when a signal comes, and what to do before the end.

    `last_act` is done, in another thread, only where nobody has heeded it in time.
    """
    _noted.words, _noted.last_act = words, last_act


def listen() -> None:
    """Note signals from now on, but for those that are ignored: these stay so."""
    names = (name for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
    known = (signal.Signals[name] for name in names)  # Windows has no SIGHUP
    _noted.heard = tuple(n for n in known if signal.getsignal(n) is not signal.SIG_IGN)
    if sys.platform != "win32":  # which cannot wait for a pipe: there somebody has to look
        reading, writing = os.pipe()
        os.set_blocking(writing, False)
        signal.set_wakeup_fd(writing, warn_on_full_buffer=False)
        threading.Thread(target=_watch, args=(reading,), daemon=True).start()
    for number in _noted.heard:
        signal.signal(number, _note)


def stop_listening() -> None:
    """Let signals end the program as they do others, and look whether one has come."""
    for number in _noted.heard:
        signal.signal(number, signal.SIG_DFL)
    heed()


def _note(number: int, _frame: object) -> None:
    _noted.number = _noted.number or number


def _watch(pipe: int) -> None:
    """Wait for a signal, then for a second one or until it is time, and end."""
    number = _next(pipe)
    while select([pipe], [], [], _WAIT)[0]:
        if os.read(pipe, 1)[0] in _noted.heard:
            break
    with suppress(Exception):
        _noted.last_act()
    with suppress(Exception):
        said = f"eulerplateau: {Interrupted(number, _noted.words())}\n"
        os.write(2, said.encode())
    os._exit(_SIGNALLED + number)


def _next(pipe: int) -> int:
    """Return the number of the next signal that is listened to."""
    while (number := os.read(pipe, 1)[0]) not in _noted.heard:
        pass
    return number
