"""What workers are given to do by tests, or this process for them; it loads little."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TypeVar

from eulerplateau.interruption import Interrupted, heed

Task = tuple[str, Path]
T, R = TypeVar("T"), TypeVar("R")


def in_turn(
    function: Callable[[T], R], tasks: Iterable[T], count: int
) -> Iterator[tuple[T, R]]:
    """Carry out tasks in this process, in place of workers."""
    return ((task, function(task)) for task in tasks)


def noted(task: Task) -> tuple[str, int]:
    """Do what a task's word says, having noted in its folder that it was begun."""
    word, folder = task
    with (folder / word).open("a") as file:
        file.write(f"{os.getpid()}\n")
    begun = len((folder / word).read_text().splitlines())
    if word.startswith("die") and (begun == 1 or word.endswith("again")):
        os.kill(os.getpid(), signal.SIGKILL)
    if word.startswith("leave"):
        os._exit(7)
    if word.startswith("wait"):
        try:
            while True:
                heed()
                time.sleep(0.01)
        except Interrupted as end:
            (folder / "ended").write_text(str(end.code))
            raise
    return word, os.getpid()
