"""What lies in a run's folder: nothing, this very run, finished or not, or another one."""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, TextIO, TypeVar

from eulerplateau.errors import ConflictError, OutputError
from eulerplateau.runs.folder import WRITER, check_is_run, read_summary, shape_name
from eulerplateau.runs.rows import Record
from eulerplateau.runs.shape_files import is_whole_shape
from eulerplateau.runs.table import read_rows

# Raised when the same specification gives other numbers than before; not the package's.
RESULTS = 1

# Keys that say which loads are followed.
_FOLLOWED = {"sweep.loads", "sweep.values"}

T = TypeVar("T", bound=Record)


@dataclass(frozen=True)
class Lying(Generic[T]):
    """What is in a folder of the run that is to be carried out there.

    Attributes
    ----------
    rows : those that can be kept; the shape of the last one is whole
    finished : bool
    about : what run.json says; empty where there is nothing yet
    """

    rows: tuple[T, ...]
    finished: bool
    about: Mapping[str, Any]


def look(
    path: Path,
    summary: Mapping[str, Any],
    name: str,
    row_type: type[T],
    quantity: str,
    loads: Sequence[float] | None = None,
) -> Lying[T]:
    """Return what lies in the folder of a run that `summary` describes.

    With `loads`, what the run is to follow, a run that differs in nothing but that it has
    only the first of them is this run, unfinished. Raises ConflictError, which names the
    keys that differ, if it is another run with rows.
    """
    about = read_summary(path)
    table = path / f"{name}.csv"
    rows = _whole_rows(path, table, row_type, quantity) if table.is_file() else []
    if not rows and not _other_table(path, name):
        return Lying((), False, {})
    different = differences(about, summary) or (
        [] if rows else ["what is followed: sweep or branches"]
    )
    first = loads is not None and [row.load for row in rows] == list(loads[: len(rows)])
    if first and set(different) == _FOLLOWED & set(different):
        whole = len(rows) == len(loads or ())
        return Lying(tuple(rows), whole and about.get("status") == "finished", about)
    if different:
        raise ConflictError(path, different)
    return Lying(tuple(rows), about.get("status") == "finished", about)


def differences(before: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    """Return the dotted keys in which two descriptions of runs differ."""
    old, new = _identity(before), _identity(now)
    return sorted(key for key in old.keys() | new.keys() if old.get(key) != new.get(key))


def _identity(summary: Mapping[str, Any]) -> dict[str, Any]:
    """Return what makes a run this run: specification, mesh, version of the results.

    A mesh or start file is known by its contents, wherever it lies.
    """
    flat = dict(_flattened("", summary.get("spec", {})))
    for key in ("mesh.file", "start.file", "cell.points"):
        flat.pop(key, None)
    flat["mesh"] = summary.get("mesh", {}).get("sha256")
    flat["start"] = summary.get("start_sha256")
    flat["results"] = summary.get("results", RESULTS)
    return flat


def _flattened(prefix: str, section: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(section, Mapping):
        for key, value in section.items():
            yield from _flattened(f"{prefix}.{key}" if prefix else key, value)
    else:
        yield prefix, section


def _other_table(path: Path, name: str) -> bool:
    """Whether the folder has rows of the other kind of run."""
    other = path / ("sweep.csv" if name == "branches" else "branches.csv")
    with suppress(OSError):
        return other.read_bytes().count(b"\n") > 1
    return False


def _whole_rows(path: Path, table: Path, row_type: type[T], quantity: str) -> list[T]:
    """Return the rows up to the last whose shape is whole.

    A row that power failed in is cut off with what follows it.
    """
    lines = table.read_bytes().split(b"\n")
    kept = lines[:-1]
    while len(kept) > 1:
        try:
            rows = read_rows(table, row_type, quantity, lines=len(kept))
        except OutputError:
            kept.pop()
            continue
        if is_whole_shape(path / shape_name(rows[-1].step)):
            return rows
        kept.pop()
    return []


@contextmanager
def only_writer(path: Path) -> Iterator[None]:
    """Hold a run folder, so that no other process writes to it; ConflictError if one does.

    The lock is the process's: however that ends, it is gone. Raises OutputError for a
    folder that holds something else than a run, and leaves it alone.
    """
    try:
        if path.exists() and any(path.iterdir()):
            check_is_run(path)
        path.mkdir(parents=True, exist_ok=True)
        file = _locked(path / WRITER)
    except OSError as error:
        problem = f"cannot be made a run folder: {error.strerror}"
        raise OutputError(path, problem) from None
    with file:
        file.truncate(0)
        file.write(f"process {os.getpid()} on {platform.node()}\n")
        file.flush()
        try:
            yield
        finally:
            with suppress(OSError):
                (path / WRITER).unlink()


def _locked(path: Path) -> TextIO:
    """Return the file that says who writes, locked; ConflictError if another has it."""
    while True:
        file = path.open("a+", encoding="ascii")
        try:
            _lock(file)
        except OSError:
            file.seek(0)
            who = file.read().strip() or "another process"
            file.close()
            raise ConflictError(path.parent, [], who) from None
        # The one who had it before may have removed it in the meantime.
        with suppress(FileNotFoundError):
            if os.path.samestat(os.fstat(file.fileno()), path.stat()):
                return file
        file.close()


def _lock(file: TextIO) -> None:
    """Lock a file until this process closes it; raises OSError if another has it.

    Windows has no such locks: there two writers are not told of each other.
    """
    if sys.platform != "win32":
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
