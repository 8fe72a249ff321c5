"""Which runs a call asks for, and the folder of each: files and keys that are replaced."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from eulerplateau.errors import SpecError
from eulerplateau.runs.spec import FILE_KEYS

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
    which holds those of many; by default they lie beside their specifications. `read`
    reads a specification, as `load_run` does a film's.
    """
    keys = [key for key, _ in settings]
    varied = {key for key, values in settings if len(values) > 1}
    combinations = list(itertools.product(*(values for _, values in settings)))
    many = len(specs) * len(combinations) > 1
    runs = []
    for path in specs:
        for combination in combinations:
            overrides = dict(zip(keys, combination, strict=True))
            name = path.stem + "".join(
                f"-{key.rpartition('.')[2]}={_word(value)}"
                for key, value in zip(keys, combination, strict=True)
                if key in varied
            )
            folder = path.parent / name if out is None else out / name if many else out
            runs.append((load_with(path, overrides, read), folder))
    folders = [folder for _, folder in runs]
    if len(set(folders)) < len(folders):
        raise SpecError("RUN.toml", "two runs would share a folder: rename a file")
    return runs


def load_with(path: Path, overrides: Mapping[str, Any], read: Read[S]) -> S:
    """Read a specification, by `read`, with keys {dotted key: value} replaced.

    A file that is given so is relative to where the call was made.
    """
    found = dict(overrides)
    for key in FILE_KEYS:
        if key in found:
            found[key] = str(Path(found[key]).absolute())
    return read(path, found)


def _word(value: Any) -> str:
    """Return a value as a part of a folder's name."""
    return "".join(c if c.isalnum() or c in "._+-" else "_" for c in Path(str(value)).stem)
