"""The live film in a thread of its own, which carries out what pages ask for."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

from eulerplateau.errors import EulerPlateauError
from eulerplateau.interruption import Interrupted
from eulerplateau.runs import Visited

# Clicks that may wait; more are a page gone mad.
_WAITING = 8

Asker = tuple[int, int]


class Film(Protocol):
    """What a live film does (runs.LiveFilm)."""

    def follow(self, values: Mapping[str, float]) -> Visited:
        """Return the film at these values."""

    def kick(self) -> Visited:
        """Return where it goes from a push."""

    def other(self) -> Visited | None:
        """Return another stable state."""

    def begin(self) -> Visited:
        """Return the film from where the run starts."""


@dataclass(frozen=True)
class Done:
    """What the film has come to.

    Attributes
    ----------
    found : None if there is nothing new
    asker : the page that asked, and the number it gave to that
    said : str, a line for people; or empty
    """

    found: Visited | None
    asker: Asker
    said: str = ""


class Worker:
    """Carries out wishes one by one; `tell` is called, in its thread, after each.

    A value replaces one of the same quantity that still waits. What it fails of, if it is
    no error that a user can cause, is `failure`.
    """

    def __init__(self, film: Film, save: Callable[[], str]) -> None:
        self._film, self._save = film, save
        self._wishes = threading.Condition()
        self._values: dict[str, float] = {}
        self._last_asker: Asker = (0, 0)
        self._clicks: deque[tuple[str, Asker]] = deque()
        self._ended = False
        self.failure: BaseException | None = None
        self._thread = threading.Thread(target=self._run, name="live film", daemon=True)

    def start(self, tell: Callable[[Done], object]) -> None:
        """Begin to carry out wishes."""
        self._tell = tell
        self._thread.start()

    def follow(self, values: Mapping[str, float], asker: Asker) -> None:
        """Ask for the film at other values, in place of those that wait."""
        with self._wishes:
            self._values |= values
            self._last_asker = asker
            self._wishes.notify()

    def click(self, what: str, asker: Asker) -> None:
        """Ask for "kick", "other", "begin" or "save", after what was asked for before."""
        with self._wishes:
            if len(self._clicks) < _WAITING:
                self._clicks.append((what, asker))
                self._wishes.notify()

    def stop(self, patience: float) -> None:
        """End after what is being carried out, or be left to end with the program."""
        with self._wishes:
            self._ended = True
            self._wishes.notify()
        if self._thread.is_alive():
            self._thread.join(patience)

    def _run(self) -> None:
        try:
            while (wish := self._next()) is not None:
                self._tell(self._carried_out(*wish))
        except Interrupted:
            pass  # whoever started this heeds it too
        except BaseException as error:
            self.failure = error

    def _next(self) -> tuple[str, dict[str, float], Asker] | None:
        with self._wishes:
            self._wishes.wait_for(lambda: self._ended or self._values or self._clicks)
            if self._ended:
                return None
            if self._values:
                values, self._values = self._values, {}
                return "follow", values, self._last_asker
            what, asker = self._clicks.popleft()
            return what, {}, asker

    def _carried_out(self, what: str, values: dict[str, float], asker: Asker) -> Done:
        try:
            match what:
                case "follow":
                    return Done(self._film.follow(values), asker)
                case "kick":
                    return Done(self._film.kick(), asker)
                case "begin":
                    return Done(self._film.begin(), asker)
                case "save":
                    return Done(None, asker, self._save())
                case _:
                    found = self._film.other()
                    said = "" if found else "No other stable state was come to from here."
                    return Done(found, asker, said)
        except EulerPlateauError as error:
            return Done(None, asker, str(error))
