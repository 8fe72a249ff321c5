"""The run folder: what a sweep has computed so far, valid after every step.

It holds sweep.csv, one row per load; shapes/shape_0000.vtp and so on, one shape per row;
sweep.pvd, the shapes as a series; run.json, what was run and how it ended; and, drawn
later by others, diagram.png and pictures/shape_0000.png and so on.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import OutputError
from eulerplateau.mesh import Disk, sync, write_whole
from eulerplateau.runs.rows import LoadName, Record, Row
from eulerplateau.runs.shape_files import write_series, write_shape
from eulerplateau.runs.table import RowWriter

# At most so much of the work is lost with the power.
_SECOND = 1.0
# So many shapes are listed in next to no time.
_FEW = 200

# In run.json: without it a folder is not ours, and nothing in it is ever removed.
_MARK = {"program": "eulerplateau"}
WRITER = ".writer"
_OUR_FILES = (
    "sweep.csv",
    "sweep.pvd",
    "branches.csv",
    "branches.pvd",
    "branches.png",
    "special_points.csv",
    "diagram.png",
    "shapes/shape_*.vtp",
    "pictures/shape_*.png",
    "pictures/sheet*.png",
    "pictures/turn_*.gif",
    "pictures/sweep*.gif",
)


def shape_name(step: int) -> str:
    """Return the path of a step's shape inside the run folder."""
    return f"shapes/shape_{step:04d}.vtp"


class RunFolder:
    """The folder of one run; make it with `create`, use it in a `with` statement.

    Every file is replaced whole, and a row is written after its shape: an interrupted run
    leaves nothing half done, and a row in sweep.csv means its shape is there.
    """

    def __init__(
        self, path: Path, name: str, row_type: type[Any], kept: Sequence[Record] = ()
    ) -> None:
        """Open a folder that `create` has made, or one whose first rows are kept."""
        self.path = path
        self._shapes = [(row.step, row.load, shape_name(row.step)) for row in kept]
        self._load: LoadName | None = None
        self._series = path / f"{name}.pvd"
        self._rows = RowWriter(path / f"{name}.csv", row_type, len(kept))
        self._unlisted = False
        self._synced = self._listed = self._list_shapes_seconds = 0.0

    @classmethod
    def create(
        cls,
        path: Path,
        summary: Mapping[str, object],
        name: str = "sweep",
        row_type: type[Any] = Row,
    ) -> RunFolder:
        """Start a run in `path` with `summary` as its run.json; its table is `name`.csv.

        An earlier run there is removed, which is to say its rows, shapes and pictures; a
        folder that holds anything but a run, or a path that cannot be made a folder,
        raises OutputError.
        """
        try:
            if path.exists() and any(file.name != WRITER for file in path.iterdir()):
                _remove_run(path)
            (path / "shapes").mkdir(parents=True, exist_ok=True)
        except OSError as error:
            problem = f"cannot be made a run folder: {error.strerror}"
            raise OutputError(path, problem) from None
        _write_summary(path, summary)
        return cls(path, name, row_type)

    def record(
        self,
        row: Row,
        mesh: Disk,
        x: FloatArray,
        modes: Mapping[str, FloatArray] | None = None,
        rest_mesh: str | None = None,
        state: Mapping[str, NDArray[Any]] | None = None,
    ) -> None:
        """Add a film's shape `x` (n_v, 3), with its critical `modes`, and then its row.

        `rest_mesh` is the SHA-256 of the mesh at rest, by default that of `mesh`, `state`
        what the solver needs to go on from here. Raises what `add` raises.
        """
        self.add(row, lambda path: write_shape(path, mesh, x, row, modes, rest_mesh, state))

    def add(self, row: Record, write: Callable[[Path], None]) -> None:
        """Add a shape, which `write` writes to the file it is given, and then its row.

        Raises OutputError if the disk is full or not writable; what was recorded before
        stays valid.
        """
        name = shape_name(row.step)
        write(self.path / name)
        self._shapes.append((row.step, row.load, name))
        self._load, self._unlisted = row.load_name, True
        now, spent = time.monotonic(), self._list_shapes_seconds
        # The list of all shapes is as long as the run: to write it costs ever more.
        if len(self._shapes) <= _FEW or now - self._listed >= 20 * spent:
            self._list_shapes()
        self._rows.append(row)
        if now - self._synced >= _SECOND:
            # A shape is synced before the row that promises it.
            sync(self.path / name)
            self._rows.sync()
            self._synced = now

    def write_summary(self, summary: Mapping[str, object]) -> None:
        """Replace run.json by `summary`: plain data, all floats finite."""
        _write_summary(self.path, summary)

    def _list_shapes(self) -> None:
        """Write the series of all shapes so far."""
        began = time.monotonic()
        if self._load is not None and self._unlisted:
            self._unlisted = False
            write_series(self._series, self._shapes, self._load)
        self._listed = time.monotonic()
        self._list_shapes_seconds = self._listed - began

    def close(self) -> None:
        """Close the table, and list all shapes; everything else is already on disk."""
        self._rows.sync()
        self._rows.close()
        self._list_shapes()

    def __enter__(self) -> RunFolder:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def _write_summary(path: Path, summary: Mapping[str, object]) -> None:
    text = json.dumps({**_MARK, **summary}, indent=2, allow_nan=False)
    write_whole(path / "run.json", f"{text}\n".encode())


def check_is_run(path: Path) -> None:
    """Raise OutputError for a folder with files that is no run."""
    files = [file for file in path.iterdir() if file.name != WRITER]
    if files and not _is_run(path):
        problem = "holds something else than a run: name an empty or a new folder"
        raise OutputError(path, problem)


def _remove_run(path: Path) -> None:
    check_is_run(path)
    for pattern in _OUR_FILES:
        for file in path.glob(pattern):
            file.unlink()


def _is_run(path: Path) -> bool:
    return read_summary(path).items() >= _MARK.items()


def read_summary(path: Path) -> Mapping[str, Any]:
    """Return what the run.json of a folder says; empty if there is none or a broken one."""
    try:
        summary = json.loads((path / "run.json").read_bytes())
    except (OSError, ValueError):
        return {}
    return summary if isinstance(summary, dict) else {}
