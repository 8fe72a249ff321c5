"""Which runs a call asks for, and the folder of each: files and keys that are replaced."""

from __future__ import annotations

import hashlib
import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from eulerplateau.errors import SpecError
from eulerplateau.runs.spec_files import FILE_KEYS, at_home

# Of one call; their specifications are all read before the first begins.
_MOST_RUNS = 10_000

_LONGEST_WORD = 40

S = TypeVar("S")
Read = Callable[[Path, dict[str, Any]], S]


def planned(
    specs: Sequence[Path],
    settings: Sequence[tuple[str, list[Any]]],
    out: Path | None,
    read: Read[S],
) -> list[tuple[S, Path]]:
    """Return every run and its folder; all specifications are checked before any run.

    `settings` are dotted keys, each with the values it takes; several values make several
    runs, several keys all their combinations. `out` is the folder of a single run, or that
    which holds those of many; by default they lie beside their specifications. A folder's
    name says what is replaced in its specification. `read` reads one, as `load_run` does a
    film's.
    """
    keys = [key for key, _ in settings]
    count = len(specs) * math.prod(len(values) for _, values in settings)
    if count > _MOST_RUNS:
        raise SpecError("--set", f"asks for {count} runs; should be at most {_MOST_RUNS}")
    combinations = list(itertools.product(*(values for _, values in settings)))
    runs = []
    for path in specs:
        for combination in combinations:
            overrides = dict(zip(keys, combination, strict=True))
            # First: a folder is named by values that are right.
            spec = load_with(path, overrides, read)
            name = run_name(path, overrides)
            folder = path.parent / name if out is None else out / name if count > 1 else out
            runs.append((spec, folder))
    taken: set[Path] = set()
    for _, folder in runs:
        if folder in taken:
            problem = f"two runs would share the folder {folder}: rename a file, or give "
            raise SpecError("RUN.toml", f"{problem}each value of --set once")
        taken.add(folder)
    return runs


def run_name(path: Path, overrides: Mapping[str, Any]) -> str:
    """Return the name of the folder of a run: its file's, and what is replaced in it."""
    words = (f"-{key.rpartition('.')[2]}={_word(key, v)}" for key, v in overrides.items())
    return path.stem + "".join(words)


def load_with(path: Path, overrides: Mapping[str, Any], read: Read[S]) -> S:
    """Read a specification, by `read`, with keys {dotted key: value} replaced.

    A file that is given so is relative to where the call was made.
    """
    found = dict(overrides)
    for key in FILE_KEYS:
        if isinstance(found.get(key), str):
            found[key] = str(at_home(key, found[key]).absolute())
    return read(path, found)


def _word(key: str, value: Any) -> str:
    """Return a value as a part of a folder's name."""
    text = Path(value).stem if key in FILE_KEYS and isinstance(value, str) else str(value)
    text = text.lower() if isinstance(value, bool) else text
    word = "".join(c if c.isalnum() or c in "._+-" else "_" for c in text).strip("_")
    if len(word) <= _LONGEST_WORD:
        return word
    # Long values that begin alike are told apart.
    return f"{word[:_LONGEST_WORD]}-{hashlib.sha256(text.encode()).hexdigest()[:8]}"
