"""The run folder: what a sweep has computed so far, valid after every step.

It holds sweep.csv, one row per load; shapes/shape_0000.vtp and so on, one shape per row,
and of films loops/loop_0000.vtp; sweep.pvd, these as a series; run.json, what was run and
how it ended; and, drawn later by others, diagram.png and pictures/shape_0000.png and so on.
"""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any

from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import OutputError
from eulerplateau.mesh import Curvatures, Disk, sync
from eulerplateau.runs.checkpoint import (
    Arrays,
    remove_checkpoints,
    write_checkpoint,
)
from eulerplateau.runs.rows import LoadName, Record, Row
from eulerplateau.runs.run_files import (
    FOLDERS,
    NEW,
    TABLES,
    check_is_run,
    remove_run,
    write_summary,
)
from eulerplateau.runs.series_file import (
    SHAPES,
    SPECIAL,
    Listed,
    loop_name,
    shape_name,
    write_shapes,
)
from eulerplateau.runs.shape_files import write_loop, write_shape
from eulerplateau.runs.table import RowWriter, has_row

# At most so much of the work is lost with the power.
_SECOND = 1.0


class RunFolder:
    """The folder of one run; make it with `create`, use it in a `with` statement.

    Every file is replaced whole, and a row is written after its shape: an interrupted run
    leaves nothing half done, and a row in sweep.csv means its shape is there.
    """

    def __init__(
        self,
        path: Path,
        name: str,
        row_type: type[Any],
        kept: Sequence[Record] = (),
        replaces: Path | None = None,
    ) -> None:
        """Open a folder that `create` has made, or one whose first rows are kept.

        It takes the place of the run that it `replaces` with its first row.
        """
        self.path = path
        self.replaces = replaces
        self._name, self._row_type = name, row_type
        self._shapes = [Listed.of(path, row.step, row.load) for row in kept]
        self._load: LoadName | None = kept[-1].load_name if kept else None
        self._rows = RowWriter(path / f"{name}.csv", row_type, len(kept))
        self._closed, self._unlisted = False, bool(kept)
        self._unsynced: list[str] = []
        self._unwritten: tuple[int, Callable[[], Arrays]] | None = None
        self._checkpoints = 0
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

        A run with rows that lies there is replaced, which is to say its rows, shapes and
        pictures, once the new one has its first; a folder that holds anything but a run,
        or a path that cannot be made a folder, raises OutputError.
        """
        new = path / NEW
        try:
            if path.exists():
                check_is_run(path)
                shutil.rmtree(new, ignore_errors=True)
            lies = any(has_row(path / f"{table}.csv") for table in TABLES)
            replaces = path if lies else None
            if replaces is None and path.exists():
                remove_run(path)
            own = path if replaces is None else new
            own.mkdir(parents=True, exist_ok=True)
            # First of all, so that the folder is known for a run's whatever comes.
            write_summary(own, summary)
            (own / SHAPES).mkdir(exist_ok=True)
        except OSError as error:
            problem = f"cannot be made a run folder: {error.strerror}"
            raise OutputError(path, problem) from None
        return cls(own, name, row_type, replaces=replaces)

    def record(
        self,
        row: Row,
        mesh: Disk,
        x: FloatArray,
        modes: Mapping[str, FloatArray] | None = None,
        rest_mesh: str | None = None,
        state: Mapping[str, NDArray[Any]] | None = None,
        curvatures: Curvatures | None = None,
    ) -> None:
        """Add a film's shape `x` (n_v, 3), with its critical `modes`, and then its row.

        `rest_mesh` is the SHA-256 of the mesh at rest, by default that of `mesh`, `state`
        what the solver needs to go on from here, `curvatures` those of the shape, if they
        are known. Raises what `add` raises.
        """
        known = Curvatures.of(mesh, x) if curvatures is None else curvatures
        vectors = modes or {}

        def write(path: Path) -> None:
            loop = self.path / loop_name(row.step)
            loop.parent.mkdir(exist_ok=True)
            write_loop(loop, mesh, x, row, vectors, known)
            write_shape(path, mesh, x, row, vectors, rest_mesh, state, known)

        self.add(row, write)

    def add(self, row: Record, write: Callable[[Path], None]) -> None:
        """Add a shape, which `write` writes to the file it is given, and then its row.

        Raises OutputError if the disk is full or not writable; what was recorded before
        stays valid.
        """
        name = shape_name(row.step)
        write(self.path / name)
        self._shapes.append(Listed.of(self.path, row.step, row.load))
        self._load, self._unlisted = row.load_name, True
        now, spent = time.monotonic(), self._list_shapes_seconds
        # The list of all shapes is as long as the run: to write it costs ever more.
        if now - self._listed >= 20 * spent:
            self._list_shapes()
        self._rows.append(row)
        self._unsynced += self._shapes[-1].files
        if self.replaces is not None:
            self._take_place(self.replaces)
        # With checkpoints a row counts from the next one on.
        if not self._checkpoints and now - self._synced >= _SECOND:
            self._sync()

    def keep(self, arrays: Callable[[], Arrays]) -> None:
        """Remember how the run goes on after the rows so far: on disk once a second."""
        self._unwritten = len(self._shapes), arrays
        if not self._checkpoints or time.monotonic() - self._synced >= _SECOND:
            self._write_checkpoint()

    def _write_checkpoint(self) -> None:
        if self._unwritten is not None:
            (rows, arrays), self._unwritten = self._unwritten, None
            self._sync()
            sync(self.path / SPECIAL)
            write_checkpoint(self.path, self._checkpoints, rows, arrays())
            self._checkpoints += 1

    def _sync(self) -> None:
        """See to it that rows outlive a loss of power; first the shapes they promise."""
        sync(*(self.path / name for name in self._unsynced))
        self._unsynced.clear()
        self._rows.sync()
        self._synced = time.monotonic()

    def _take_place(self, old: Path) -> None:
        """Put what there is of this run in the place of another one.

        That has no rows from the first moment on, and this one none up to the last.
        """
        try:
            remove_run(old)
            self._rows.close()
            files = [file for file in self.path.rglob("*") if file.is_file()]
            for file in sorted(files, key=lambda file: file.suffix == ".csv"):
                there = old / file.relative_to(self.path)
                there.parent.mkdir(exist_ok=True)
                os.replace(file, there)
        except OSError as error:
            raise OutputError(old, f"cannot be replaced: {error.strerror}") from None
        shutil.rmtree(self.path, ignore_errors=True)
        self.path, self.replaces = old, None
        self._rows = RowWriter(old / f"{self._name}.csv", self._row_type, 1)

    def write_summary(self, summary: Mapping[str, object]) -> None:
        """Replace run.json by `summary`: plain data, all floats finite."""
        write_summary(self.path, summary)

    def _list_shapes(self) -> None:
        """Write the series of all shapes so far."""
        began = time.monotonic()
        if self._load is not None and self._unlisted:
            self._unlisted = False
            path = self.path / f"{self._name}.pvd"
            write_shapes(path, self._shapes, self._load.text)
        self._listed = time.monotonic()
        self._list_shapes_seconds = self._listed - began

    def close(self) -> None:
        """List all shapes, and close the table; what is needed to go on is on disk.

        A run without a row leaves the one that it was to replace.
        """
        if self._closed:
            return
        self._closed = True
        try:
            if self.replaces is not None:
                shutil.rmtree(self.path, ignore_errors=True)
                return
            self._sync()
            self._write_checkpoint()
            self._list_shapes()
        finally:
            self._rows.close()

    def finish(self, summary: Mapping[str, object]) -> None:
        """Close the folder of a run that is over, with `summary` as its run.json."""
        self._unwritten = None
        self.close()
        self.write_summary(summary)
        sync(self.path / "run.json")
        remove_checkpoints(self.path)

    def discard(self) -> None:
        """Remove what there is of a run without rows."""
        remove_run(self.path)
        for file in (self.path / "run.json", *(self.path / name for name in FOLDERS)):
            with suppress(OSError):
                file.rmdir() if file.is_dir() else file.unlink()

    def __enter__(self) -> RunFolder:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
