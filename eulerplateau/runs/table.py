"""Tables of rows that are on disk as soon as they are computed: sweep.csv and others."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, TypeVar

from eulerplateau.errors import OutputError
from eulerplateau.film import SPRING_LOAD
from eulerplateau.mesh import write_whole
from eulerplateau.runs.rows import Record, Row, columns
from eulerplateau.runs.series_file import SPECIAL, SPECIAL_SHAPES, Listed, write_series
from eulerplateau.solvers import Status

_INTEGERS = {
    "step", "n_unstable", "iterations", "self_intersections", "branch", "origin", "special",
    "number", "by_starts", "by_deflation", "first_start", "first_guess", "contacts",
    "film_vertices",
}  # fmt: skip
_MAY_BE_EMPTY = {
    "n_unstable", "lowest_eigenvalue", "self_intersections", "origin", "special",
    "first_start", "first_guess", "contacts", "contact_force", "smallest_gap",
    "crossing_angle",
}  # fmt: skip
_WORDS = {"symmetry"}

RowType = TypeVar("RowType", bound=Record)


class RowWriter:
    """Appends rows to a CSV file, each whole and on disk when `append` returns.

    Creating it starts the file anew with the header. Raises OutputError if the file
    cannot be written; a row that did not fit (disk full) is taken back.
    """

    def __init__(self, path: Path, row_type: type[Any] = Row, kept: int = 0) -> None:
        """Start a table, or go on after the first `kept` rows of the one that is there."""
        self._path = path
        self._columns = columns(row_type)
        try:
            # Unbuffered: a row reaches the file in one write, and Ctrl-C finds no half.
            self._file = path.open("r+b" if kept else "wb", buffering=0)
        except OSError as error:
            raise OutputError(path, f"cannot be written: {error.strerror}") from None
        if kept:
            lines = path.read_bytes().split(b"\n")[: kept + 1]
            self._file.truncate(self._file.seek(sum(len(line) + 1 for line in lines)))
            return
        try:
            self._write_line(",".join(self._columns))
        except OutputError:
            self.close()
            raise

    def append(self, row: Record) -> None:
        """Write `row`; floats by repr, so that they read back bit for bit."""
        self._write_line(
            ",".join(_cell(name, getattr(row, name)) for name in self._columns)
        )

    def sync(self) -> None:
        """See to it that the rows outlive a loss of power."""
        with suppress(OSError):
            os.fsync(self._file.fileno())

    def close(self) -> None:
        """Close the file; the rows are already on disk."""
        self._file.close()

    def __enter__(self) -> RowWriter:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _write_line(self, text: str) -> None:
        line = f"{text}\n".encode("ascii")
        start = self._file.tell()
        try:
            # A nearly full disk takes a part of the line without an error.
            written = self._file.write(line)
            if written < len(line):
                self._file.write(line[written:])
                if self._file.tell() < start + len(line):
                    raise OSError(None, "no space left")
        except OSError as error:
            with suppress(OSError):
                self._file.truncate(start)
            problem = f"row cannot be written: {error.strerror}"
            raise OutputError(self._path, problem) from None


def has_row(table: Path) -> bool:
    """Return whether a table has a row."""
    with suppress(OSError):
        return table.read_bytes().count(b"\n") > 1
    return False


def table_content(names: Sequence[str], lines: Sequence[Mapping[str, Any]]) -> bytes:
    """Return a table of lines {column: cell} as a CSV file holds it."""
    text = io.StringIO()
    writer = csv.DictWriter(text, names, lineterminator="\n", restval="")
    writer.writeheader()
    writer.writerows(lines)
    return text.getvalue().encode()


def write_special(
    folder: Path, names: Sequence[str], points: Sequence[Mapping[str, Any]]
) -> None:
    """Write the special points of an exploration, and the series of their shapes.

    Raises OutputError.
    """
    write_whole(folder / SPECIAL, table_content(names, points))
    met = [(int(at["number"]), Listed.of(folder, int(at["step"]), 0.0)) for at in points]
    timed = [(number, shape.files) for number, shape in met]
    write_series(folder / SPECIAL_SHAPES, timed, "number of the special point")


def read_special(path: Path) -> dict[int, dict[str, str]]:
    """Return what a table of special points says of each, by number.

    An exploration that has met none may not have it. Raises OutputError.
    """
    try:
        with path.open(newline="", encoding="utf-8") as file:
            return {int(line["number"]): dict(line) for line in csv.DictReader(file)}
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None
    except (KeyError, ValueError):
        problem = "is no table of special points: no column of whole numbers `number`"
        raise OutputError(path, problem) from None


def special_of(rows: Iterable[Any], folder: Path) -> list[dict[str, Any]]:
    """Return what the table of special points says of those among the rows."""
    met = {row.special for row in rows} - {None}
    table = read_special(folder / SPECIAL) if met else {}
    return [{**told} for number, told in table.items() if number in met]


def read_rows(
    path: Path,
    row_type: type[RowType] = Row,  # type: ignore[assignment]
    quantity: str = SPRING_LOAD.column,
    lines: int | None = None,
) -> list[RowType]:
    """Read a table of rows back, bit for bit, with `quantity` for their load.

    `lines` limits what is read of it, its first line included.

    Raises OutputError naming the line and column that is not as RowWriter wrote it, or if
    the file cannot be read.
    """
    try:
        header, *rows = path.read_text(encoding="utf-8").splitlines()[:lines] or [""]
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise OutputError(path, "is not a text file; expected a sweep.csv") from None
    names = columns(row_type)
    if header != ",".join(names):
        raise OutputError(path, f"the first line should be {','.join(names)}")
    made: Callable[..., RowType] = row_type
    return [
        made(**_values(path, names, number, line), quantity=quantity)
        for number, line in enumerate(rows, start=2)
    ]


def _values(path: Path, names: tuple[str, ...], number: int, line: str) -> dict[str, Any]:
    cells = line.split(",")
    if len(cells) != len(names):
        problem = f"line {number} has {len(cells)} cells, not {len(names)}"
        raise OutputError(path, problem)
    values = {}
    for name, text in zip(names, cells, strict=True):
        try:
            values[name] = _value(name, text)
        except ValueError as error:
            raise OutputError(path, f"line {number}, {name}: {error}") from None
    return values


def _cell(name: str, value: Any) -> str:
    if value is None:
        return ""
    if name == "status":
        return str(value.value)
    if name in _WORDS:
        return str(value)
    return str(int(value)) if name in _INTEGERS else repr(float(value))


def _value(name: str, text: str) -> Any:
    if name in _WORDS:
        return text
    if text == "" and name in _MAY_BE_EMPTY:
        return None
    if name == "status":
        return Status(text)
    return int(text) if name in _INTEGERS else float(text)
