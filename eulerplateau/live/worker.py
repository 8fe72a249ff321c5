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

# {page: the number it gave to the last that it asked for}.
Askers = Mapping[int, int]


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
    answered : pages, and of each the last wish that this answers
    said : str, a line for people; or empty
    """

    found: Visited | None
    answered: Askers
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
        self._askers: dict[int, int] = {}
        self._clicks: deque[tuple[str, Askers]] = deque()
        self._ended = False
        self.failure: BaseException | None = None
        self._thread = threading.Thread(target=self._run, name="live film", daemon=True)

    def start(self, tell: Callable[[Done], object]) -> None:
        """Begin to carry out wishes."""
        self._tell = tell
        self._thread.start()

    def follow(self, values: Mapping[str, float], page: int, asked: int) -> None:
        """Ask for the film at other values, in place of those that wait."""
        with self._wishes:
            self._values |= values
            self._askers[page] = asked
            self._wishes.notify()

    def click(self, what: str, page: int, asked: int) -> None:
        """Ask for "kick", "other", "begin" or "save", after what was asked for before."""
        with self._wishes:
            if len(self._clicks) < _WAITING:
                self._clicks.append((what, {page: asked}))
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

    def _next(self) -> tuple[str, dict[str, float], Askers] | None:
        with self._wishes:
            self._wishes.wait_for(lambda: self._ended or self._values or self._clicks)
            if self._ended:
                return None
            if self._values:
                values, self._values = self._values, {}
                askers, self._askers = self._askers, {}
                return "follow", values, askers
            what, clicker = self._clicks.popleft()
            return what, {}, clicker

    def _carried_out(self, what: str, values: dict[str, float], askers: Askers) -> Done:
        try:
            match what:
                case "follow":
                    return Done(self._film.follow(values), askers)
                case "kick":
                    return Done(self._film.kick(), askers)
                case "begin":
                    return Done(self._film.begin(), askers)
                case "save":
                    return Done(None, askers, self._save())
                case _:
                    found = self._film.other()
                    said = "" if found else "No other stable state was come to from here."
                    return Done(found, askers, said)
        except EulerPlateauError as error:
            return Done(None, askers, str(error))
