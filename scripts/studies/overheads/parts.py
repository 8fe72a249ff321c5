"""Carry out a command of the command line, and print its seconds of CPU by part, as JSON.

In a process of its own, since what is loaded counts: python -m ...parts FILE COMMAND ...
"""

from __future__ import annotations

import json
import resource
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import eulerplateau.pictures as pictures
from eulerplateau.cli import main
from eulerplateau.runs import exploration, folder, recording, sweep

SPENT = dict.fromkeys(("before", "solved", "measured", "written", "drawn"), 0.0)


def seconds() -> float:
    """Return the seconds of CPU so far, those of children that have ended included."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def counted(part: str, done: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function whose time, or that of each item it yields, counts for a part."""

    def timed(*words: Any, **named: Any) -> Any:
        began = seconds()
        try:
            found = done(*words, **named)
            return each(part, found) if isinstance(found, Iterator) else found
        finally:
            SPENT[part] += seconds() - began

    return timed


def each(part: str, items: Iterator[Any]) -> Iterator[Any]:
    """Yield items, the time of each counted for a part."""
    following = counted(part, lambda: next(items, None))
    while (item := following()) is not None:
        yield item


def begun(run: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function before which everything counts as before."""

    def timed(*words: Any, **named: Any) -> Any:
        SPENT["before"] = seconds()
        return run(*words, **named)

    return timed


def _print() -> None:
    # Modules are loaded before they are needed here, but all of them would be.
    sweep.run_sweep = begun(sweep.run_sweep)
    exploration.run_branches = begun(exploration.run_branches)
    sweep.follow_steps = counted("solved", sweep.follow_steps)
    exploration.explore = counted("solved", exploration.explore)
    recording.tell = counted("measured", recording.tell)
    for name in ("record", "keep", "finish"):
        write = counted("written", getattr(folder.RunFolder, name))
        setattr(folder.RunFolder, name, write)
    for name in ("draw_diagram", "draw_branches"):
        setattr(pictures, name, counted("drawn", getattr(pictures, name)))
    out = Path(sys.argv.pop(1))
    try:
        main()
    finally:
        whole = seconds()
        SPENT["the rest"] = whole - sum(SPENT.values())
        out.write_text(json.dumps({**SPENT, "all": whole}))


if __name__ == "__main__":
    _print()
