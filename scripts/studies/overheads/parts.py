"""Carry out a command of the command line; write its seconds of CPU by part, as JSON.

In a process of its own, since what is loaded counts: python -m ...parts FILE COMMAND ...
"""

from __future__ import annotations

import json
import resource
import sys
import time
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from eulerplateau import pictures
from eulerplateau.__main__ import main
from eulerplateau.runs import folder, recording

# Of each command the module, what begins in it, and what solves.
RUNS = {
    "sweep": ("eulerplateau.runs.sweep", "run_sweep", "follow_steps"),
    "branches": ("eulerplateau.runs.exploration", "run_branches", "explore"),
}
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


def watched(command: str) -> None:
    """See to it that the time of a command's parts is counted."""
    name, run, solve = RUNS[command]
    module = import_module(name)
    setattr(module, run, begun(getattr(module, run)))
    setattr(module, solve, counted("solved", getattr(module, solve)))
    recording.tell = counted("measured", recording.tell)
    for write in ("record", "keep", "finish"):
        timed = counted("written", getattr(folder.RunFolder, write))
        setattr(folder.RunFolder, write, timed)
    for draw in ("draw_diagram", "draw_branches"):
        setattr(pictures, draw, counted("drawn", getattr(pictures, draw)))


def print_parts() -> None:
    """Carry the command out, and write its parts to the file named first."""
    out = Path(sys.argv.pop(1))
    watched(sys.argv[1])
    try:
        main()
    finally:
        whole = seconds()
        rest = whole - sum(SPENT.values())
        out.write_text(json.dumps({**SPENT, "the rest": rest, "all": whole}))


if __name__ == "__main__":
    print_parts()
