"""What lies in a run's folder: nothing, this very run, finished or not, or another one."""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import compress, takewhile
from pathlib import Path
from typing import Any, Generic, TextIO, TypeVar

from eulerplateau.errors import ConflictError, OutputError
from eulerplateau.mesh import TEMPORARY
from eulerplateau.runs.checkpoint import Arrays, last_checkpoint
from eulerplateau.runs.rows import Record
from eulerplateau.runs.run_files import TABLES, WRITER, check_is_run, read_summary
from eulerplateau.runs.series_file import LOOPS, SHAPES, shape_name
from eulerplateau.runs.shape_files import ends_as_shape, is_whole_shape
from eulerplateau.runs.table import has_row, read_rows

# Raised when the same specification gives other numbers than before; not the package's.
RESULTS = 4

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
    progress : how an exploration goes on after these rows
    lost : int, rows that are there but cannot be gone on from
    """

    rows: tuple[T, ...]
    finished: bool
    about: Mapping[str, Any]
    progress: Arrays | None = None
    lost: int = 0

    def told(self, versions: Mapping[str, Any]) -> str:
        """Return in a line what is done with what lies here; "" where nothing does.

        `versions` are what run.json says of machine and libraries, as they are now.
        """
        if self.finished:
            return f"finished before, {len(self.rows)} rows: nothing is computed"
        if self.rows:
            line = f"goes on after {len(self.rows)} rows of an earlier call"
            if any(self.about.get(key) != value for key, value in versions.items()):
                line += (
                    ", on another machine or with other versions: as one that "
                    "went through but for rounding"
                )
            return line
        if self.lost:
            return f"begins again: {self.lost} rows do not say how to go on from them"
        return ""


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
    *lines, cut = table.read_bytes().split(b"\n") if table.is_file() else [b""]
    rows = _whole_rows(path, table, len(lines), row_type, quantity)
    others = (path / f"{other}.csv" for other in TABLES if other != name)
    if not rows and not any(has_row(other) for other in others):
        return Lying((), False, {})
    different = differences(about, summary) or (
        [] if rows else ["what is computed: sweep, branches or catalogue"]
    )
    whole = len(rows) == len(lines) - 1 and not cut
    finished = about.get("status") == "finished" and whole
    first = loads is not None and [row.load for row in rows] == list(loads[: len(rows)])
    if first and set(different) == _FOLLOWED & set(different):
        finished, different = finished and len(rows) == len(loads or ()), []
    if different:
        raise ConflictError(path, different)
    return (
        Lying(tuple(rows), True, about)
        if finished
        else _unfinished(path, name, rows, about)
    )


def _unfinished(path: Path, name: str, rows: list[T], about: Mapping[str, Any]) -> Lying[T]:
    """Return the rows that a run goes on from: of a sweep all of them."""
    if name == "sweep":
        return Lying(tuple(rows), False, about)
    found = last_checkpoint(path, rows)
    if found is None:
        return Lying((), False, about, lost=len(rows))
    kept, progress = found
    return Lying(tuple(rows[:kept]), False, about, progress)


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


def _whole_rows(
    path: Path, table: Path, lines: int, row_type: type[T], quantity: str
) -> list[T]:
    """Return the rows up to the first that is not whole, or whose shape is not.

    What power failed in is cut off with what follows it. `lines` are those of the table.
    """
    rows: list[T] = []
    for count in range(lines, 1, -1):
        try:
            rows = read_rows(table, row_type, quantity, lines=count)
        except OutputError:
            continue
        break
    shapes = (path / shape_name(row.step) for row in rows)
    rows = list(compress(rows, takewhile(bool, map(ends_as_shape, shapes))))
    while rows and not is_whole_shape(path / shape_name(rows[-1].step)):
        rows.pop()
    return rows


@contextmanager
def only_writer(path: Path) -> Iterator[None]:
    """Hold a run folder, so that no other process writes to it; ConflictError if one does.

    The lock is the process's: however that ends, it is gone. Raises OutputError for a
    folder that holds something else than a run, and leaves it alone.
    """
    new = not path.exists()
    try:
        if not new:
            check_is_run(path)
        file = _locked(path / WRITER)
    except OSError as error:
        problem = f"cannot be made a run folder: {error.strerror}"
        raise OutputError(path, problem) from None
    with file:
        file.truncate(0)
        file.write(f"process {os.getpid()} on {platform.node()}\n")
        file.flush()
        _remove_halves(path)
        try:
            yield
        finally:
            with suppress(OSError):
                (path / WRITER).unlink()
                if new:
                    path.rmdir()  # where nothing came to be in it


def _remove_halves(path: Path) -> None:
    """Remove what a process that was killed has not finished writing."""
    for name in ("run.json", "*.csv", "*.pvd", ".checkpoint*", "*.vtp"):
        for folder in (path, path / SHAPES, path / LOOPS):
            for file in folder.glob(f"{TEMPORARY}*.{name.removeprefix('.')}"):
                file.unlink(missing_ok=True)


def _locked(path: Path) -> TextIO:
    """Return the file that says who writes, locked; ConflictError if another has it."""
    while True:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            file = path.open("a+", encoding="ascii")
        except FileNotFoundError:
            continue  # with the folder, by the one who had it before
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
