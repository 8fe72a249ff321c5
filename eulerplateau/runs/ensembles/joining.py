"""One table of many runs: their rows, and the keys in which the runs differ as columns."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eulerplateau.errors import (
    NOT_CONVERGED_EXIT_CODE,
    MissingLibraryError,
    OutputError,
)
from eulerplateau.mesh import write_whole
from eulerplateau.runs.ensembles.folder import Place
from eulerplateau.runs.kinds import Kind
from eulerplateau.runs.record import kind_of
from eulerplateau.runs.rows import Record, columns
from eulerplateau.runs.run_files import read_summary
from eulerplateau.runs.spec_files import FILE_KEYS, leaves
from eulerplateau.runs.table import read_rows, table_content

FAILED = "failed"
_SEED = "start.seed"
_FIRST = ("run", "seed", "mesh")

# Digits of a mesh's SHA-256, which tell meshes apart.
_DIGITS = 12


@dataclass(frozen=True)
class Table:
    """Rows of runs of one kind.

    Attributes
    ----------
    columns : of these the first are run, seed, mesh, and the keys that differ
    lines : each {column: value}; of a run that failed the last one says why
    runs : int, how many there is something of
    not_converged : int, how many rows are no equilibria
    missing, unfinished, failed : names of the runs of which there is nothing, or not all
    exit_code : the worst of the runs'
    """

    columns: tuple[str, ...]
    lines: tuple[Mapping[str, Any], ...]
    runs: int
    not_converged: int
    missing: tuple[str, ...]
    unfinished: tuple[str, ...]
    failed: tuple[str, ...]
    exit_code: int

    def write(self, path: Path) -> None:
        """Write the table as .parquet, or as CSV by any other extension.

        Raises OutputError, and MissingLibraryError for Parquet without PyArrow.
        """
        if path.suffix.lower() == ".parquet":
            write_whole(path, self._parquet())
            return
        lines = [{key: _cell(value) for key, value in line.items()} for line in self.lines]
        write_whole(path, table_content(self.columns, lines))

    def _parquet(self) -> bytes:
        check_parquet()
        import pyarrow
        from pyarrow import parquet

        held = {
            name: _alike([line.get(name) for line in self.lines]) for name in self.columns
        }
        content = io.BytesIO()
        parquet.write_table(pyarrow.table(held), content)
        return content.getvalue()


def check_parquet() -> None:
    """Raise MissingLibraryError, which says what to install, without PyArrow."""
    try:
        import pyarrow  # noqa: F401
    except ImportError:
        problem = "Parquet needs PyArrow: pip install 'eulerplateau[parquet]'"
        raise MissingLibraryError(problem) from None


@dataclass(frozen=True)
class _Found:
    """What there is of a run: what it says of itself, and its rows."""

    place: Place
    about: Mapping[str, Any]
    kind: Kind
    rows: Sequence[Record]
    keys: Mapping[str, Any]


def joined(places: Sequence[Place]) -> Table:
    """Return the rows of runs in one table.

    Raises OutputError naming the run that is of another kind than the first, or the table
    that cannot be read.
    """
    found = [_found(place) for place in places if place.is_there]
    for run in found:
        if run.kind.name != found[0].kind.name:
            problem = f"is the run of a {run.kind.name}: join one kind at a time"
            raise OutputError(run.place.folder, problem)
    keys = _differing(found)
    lines = [line for run in found for line in _lines(run, keys)]
    first = [name for name in _FIRST if any(name in line for line in lines)]
    own = columns(_row_type(found)) if found else ()
    codes = [_exit_code(run) for run in found]
    return Table(
        (*first, *keys, *own, "reason"),
        tuple(lines),
        len(found),
        sum(not row.converged for run in found for row in run.rows),
        tuple(place.name for place in places if not place.is_there),
        tuple(run.place.name for run in found if _is_unfinished(run)),
        tuple(run.place.name for run in found if run.place.failure),
        max(codes, default=0),
    )


def _found(place: Place) -> _Found:
    about = read_summary(place.folder) or place.failure
    kind = kind_of(about)
    rows: Sequence[Record] = ()
    for name, row_type in (("sweep", kind.row), ("branches", kind.branch_row)):
        table = place.folder / f"{name}.csv"
        if table.is_file():
            rows = read_rows(table, row_type, kind.quantity(about))
    return _Found(place, about, kind, rows, dict(leaves(about.get("spec", {}))))


def _row_type(found: Sequence[_Found]) -> type[Any]:
    """Return the type of row that has the columns of all rows."""
    kind = max((run.kind for run in found), key=lambda kind: len(kind.columns))
    explored = any((run.place.folder / "branches.csv").is_file() for run in found)
    return kind.branch_row if explored else kind.row


def _differing(found: Sequence[_Found]) -> list[str]:
    """Return the keys in which runs differ, in the order of their specifications."""
    names = dict.fromkeys(key for run in found for key in run.keys if key != _SEED)
    return [key for key in names if len(set(_identities(found, key))) > 1]


def _identities(found: Sequence[_Found], key: str) -> list[str]:
    """Return, for a key of each run, what is the same where two are alike in it.

    Of a file that is its contents, wherever it lies. A run that failed may not know them:
    another one of the same file does, or else it is known by its path.
    """
    values = [json.dumps(run.keys.get(key)) for run in found]
    if key not in FILE_KEYS:
        return values
    own = [_contents(run, key) if run.keys.get(key) else None for run in found]
    known = {value: text for value, text in zip(values, own, strict=True) if text}
    return [
        text or known.get(value, value) for value, text in zip(values, own, strict=True)
    ]


def _contents(run: _Found, key: str) -> str | None:
    """Return the SHA-256 of what a run has read of the file that a key names."""
    mesh: str | None = run.about.get("mesh", {}).get("sha256")
    start: str | None = run.about.get("start_sha256")
    return start if key == "start.file" else mesh


def _lines(run: _Found, keys: Sequence[str]) -> Iterator[dict[str, Any]]:
    mesh = run.about.get("mesh", {}).get("sha256")
    common = {
        "run": run.place.name,
        # Cells have none.
        **({"seed": run.keys[_SEED]} if _SEED in run.keys else {}),
        "mesh": mesh and mesh[:_DIGITS],
        **{key: run.keys.get(key) for key in keys},
    }
    for row in run.rows:
        own = {name: getattr(row, name) for name in columns(type(row))}
        yield {**common, **own, "status": row.status.value}
    if run.place.failure:
        yield {**common, "status": FAILED, "reason": run.place.failure["problem"]}


def _is_unfinished(run: _Found) -> bool:
    return not run.place.failure and run.about.get("status") != "finished"


def _exit_code(run: _Found) -> int:
    lost = 0 if all(row.converged for row in run.rows) else NOT_CONVERGED_EXIT_CODE
    return max(lost, int(run.place.failure.get("exit_code", 0)))


def _cell(value: Any) -> Any:
    """Return a value as CSV holds it; what is no number and no word as JSON."""
    return json.dumps(value) if isinstance(value, bool | list | dict) else value


def _alike(values: list[Any]) -> list[Any]:
    """Return the values of a column, as text if they are of several types."""
    types = {float if isinstance(v, int) and not isinstance(v, bool) else type(v)
             for v in values if v is not None}  # fmt: skip
    if len(types) <= 1 and not types & {list, dict}:
        return values
    return [v if v is None or isinstance(v, str) else json.dumps(v) for v in values]
