"""Tasks carried out by processes of this machine, of which any may die.

Each process has a pipe of its own and is given one task at a time, so that it is known
whose task a process took along, whenever it dies: that one is given out once more, and no
other is touched. Pools that share a queue do not know it at all times: the standard
library's gives up every task, Pebble's too where a process dies before it says what it has
taken.
"""

from __future__ import annotations

import logging
import signal
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import get_context, resource_tracker
from multiprocessing.connection import Connection, wait
from typing import Any, Generic, TypeVar

from eulerplateau.interruption import Interrupted, heed, listen

T = TypeVar("T")
R = TypeVar("R")

# Seconds in which a process that is told to end writes down how far it has come; fewer than
# `interruption` waits for this one.
_PATIENCE = 4.0

# Seconds between two looks whether this process is to end.
_LOOK = 0.2

# Those of a terminal reach every process of a call: it tells its workers itself.
_TERMINAL = [
    getattr(signal, name) for name in ("SIGINT", "SIGHUP") if hasattr(signal, name)
]


@dataclass(frozen=True)
class Died:
    """In place of a result: the process of a task died, twice; `how` the second time."""

    how: str


@dataclass
class _Task(Generic[T]):
    what: T
    given: int = 0


class _Worker(Generic[T, R]):
    """A process, and the task it has."""

    def __init__(self, function: Callable[[T], R]) -> None:
        """Start it."""
        # Not forked: a copy of a process with threads, of BLAS or of a bar, may hang.
        context = get_context("spawn")
        self.pipe, theirs = context.Pipe()
        self.task: _Task[T] | None = None
        self._process = context.Process(target=_serve, args=(theirs, function), daemon=True)
        with _deaf():
            self._process.start()
        # So that the pipe ends with the process.
        theirs.close()

    def give(self, task: _Task[T]) -> None:
        """Give it a task; if it has died that is found when its result is asked for."""
        task.given += 1
        self.task = task
        with suppress(OSError):
            self.pipe.send(task.what)

    def result(self) -> R | None:
        """Return the result of its task; None if it has died."""
        try:
            found: R = self.pipe.recv()
        except (EOFError, OSError):
            return None
        return found

    def how_it_died(self) -> str:
        """Return how it ended."""
        self._process.join()
        code = self._process.exitcode or 0
        with suppress(ValueError):
            return f"its process was killed by {signal.Signals(-code).name}"
        return f"its process ended with code {code}"

    def dismiss(self) -> None:
        """Let it end: it has nothing to do."""
        self.pipe.close()

    def stop(self) -> None:
        """Make it end, whatever it does."""
        self._process.terminate()

    def wait(self) -> None:
        """See to it that it has ended."""
        self._process.join(_PATIENCE)
        self._process.kill()
        self._process.join()


def in_workers(
    function: Callable[[T], R], tasks: Sequence[T], count: int
) -> Iterator[tuple[T, R | Died]]:
    """Yield each task with its result, as they come, of `count` processes.

    `function` and the tasks are pickled, and it raises nothing. Where iteration ends early
    the processes are told to end by SIGTERM, which they heed.
    """
    waiting = deque(_Task(task) for task in tasks)
    team: list[_Worker[T, R]] = []
    dismissed: list[_Worker[T, R]] = []
    try:
        while waiting or team:
            while waiting and len(team) < count:
                worker = _Worker[T, R](function)
                team.append(worker)
                worker.give(waiting.popleft())
            pipes = {worker.pipe: worker for worker in team}
            ready = wait(pipes, _LOOK)
            heed()
            for pipe in ready:
                worker = pipes[pipe]  # type: ignore[index]
                task, result = worker.task, worker.result()
                assert task is not None
                if result is not None and waiting:
                    worker.give(waiting.popleft())
                else:
                    team.remove(worker)
                    dismissed.append(worker)
                    worker.dismiss()
                if result is not None:
                    yield task.what, result
                elif task.given > 1:
                    yield task.what, Died(worker.how_it_died())
                else:
                    waiting.appendleft(task)
    finally:
        for worker in team:
            worker.stop()
        for worker in team + dismissed:
            worker.wait()


def _serve(pipe: Connection, function: Callable[[Any], Any]) -> None:
    """Carry out tasks until there are no more; what a worker does."""
    listen()
    logging.basicConfig(format="eulerplateau: %(message)s", level=logging.WARNING)
    try:
        with suppress(EOFError, OSError):
            while True:
                pipe.send(function(pipe.recv()))
                heed()
    except Interrupted as end:
        raise SystemExit(end.code) from None


@contextmanager
def _deaf() -> Iterator[None]:
    """Start what is deaf to the signals of a terminal; here they are kept for later."""
    # Whose first start would unblock them.
    resource_tracker.ensure_running()
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, _TERMINAL)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
