"""What a sweep and an exploration have in common: a folder that fills row by row."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import EulerPlateauError, OutputError
from eulerplateau.interruption import working_on
from eulerplateau.mesh import Curvatures, Disk, Measurer
from eulerplateau.runs.about import blas_threads, describe, surroundings
from eulerplateau.runs.checkpoint import Arrays
from eulerplateau.runs.continuing import RESULTS, Lying, look, only_writer
from eulerplateau.runs.folder import RunFolder
from eulerplateau.runs.rows import Record, Row, columns, make_row
from eulerplateau.runs.series_file import shape_name
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.table import write_special
from eulerplateau.solvers import Equilibrium, Problem
from eulerplateau.threads import threads

if TYPE_CHECKING:
    from eulerplateau.branches import DiagramPoint

# Matrices here are as large as the loop: a second thread waits more than it works.
BLAS_THREADS = 1

T = TypeVar("T", bound=Record)
R = TypeVar("R", bound=Row)


@dataclass
class OpenRun(Generic[T]):
    """A run folder that fills: rows, and the shapes before them.

    Attributes
    ----------
    rows : those that are on disk
    kept : int, how many of them an earlier call has left
    finished : bool, whether it had left all of them
    about : what run.json said of them
    progress : how an exploration goes on after them
    before : str, what is done with what an earlier call has left, in a line
    totals : what run.json says when all is over
    """

    folder: RunFolder
    started: float
    rows: list[T] = field(default_factory=list)
    kept: int = 0
    finished: bool = False
    about: Mapping[str, Any] = field(default_factory=dict)
    progress: Arrays | None = None
    before: str = ""
    totals: dict[str, Any] = field(default_factory=dict)

    @property
    def last_shape(self) -> Path:
        """The file of the last shape."""
        return self.folder.path / shape_name(self.rows[-1].step)

    @property
    def seconds(self) -> float:
        """Since the run began."""
        return time.perf_counter() - self.started


@dataclass(frozen=True)
class Opening(Generic[T]):
    """How a run folder is opened.

    Attributes
    ----------
    name : str, of its table, without .csv
    quantity : str, the column of what is varied
    overwrite : bool, whether another run that lies there is replaced
    loads : what the run follows, if a run of the first of them alone is to be continued
    """

    name: str
    row_type: type[T]
    quantity: str
    overwrite: bool = False
    loads: Sequence[float] | None = None


@contextmanager
def opened(
    path: Path, opening: Opening[T], summary: dict[str, Any], started: float
) -> Iterator[OpenRun[T]]:
    """Open the folder `path` for a run that `summary` describes, and close it.

    What lies there decides: nothing, and the run starts; this very run, and it goes on or
    is finished; another one, which raises ConflictError unless it is to be overwritten.
    Interrupted or failing half-way the run leaves a valid folder and says so in its
    run.json, which otherwise is `summary` with what the run has come to.
    """
    summary = {"results": RESULTS, **summary}
    with only_writer(path), threads(BLAS_THREADS):
        where = surroundings()
        lying: Lying[T] = Lying((), False, {})
        if not opening.overwrite:
            how = opening.name, opening.row_type, opening.quantity, opening.loads
            lying = look(path, summary, *how)
        summary |= where
        folder = _folder(path, opening, summary, lying)
        run = OpenRun(
            folder,
            started,
            [*lying.rows],
            len(lying.rows),
            lying.finished,
            lying.about,
            lying.progress,
            lying.told(where),
        )
        with folder:
            if run.finished:
                yield run
                return
            summary["blas_threads"] = blas_threads()
            yield from _carried_out(run, summary)


def _carried_out(run: OpenRun[T], summary: dict[str, Any]) -> Iterator[OpenRun[T]]:
    """Yield the run; then close its folder, with a run.json that says how it ended."""

    def ended(status: str) -> dict[str, Any]:
        totals = {**run.totals, "seconds": run.seconds}
        return {**summary, "status": status, "totals": totals}

    def words() -> str:
        held = run.folder.replaces
        if held is not None:
            return f"{held}: nothing of it is there yet, and what was there still is"
        rows = f"{len(run.rows)} rows are" if run.rows else "nothing is"
        return f"{run.folder.path}: {rows} there" + ("" if run.rows else " yet")

    working_on(words, lambda: run.folder.write_summary(ended("interrupted")))
    try:
        yield run
        run.folder.finish(ended("finished"))
    except BaseException as error:
        # Nothing that fails now hides what has failed.
        with suppress(OutputError):
            run.folder.close()
        if run.rows or not isinstance(error, EulerPlateauError):
            with suppress(OutputError):
                run.folder.write_summary(ended("interrupted"))
        else:
            run.folder.discard()
        raise
    finally:
        working_on(words)


def _folder(
    path: Path, opening: Opening[T], summary: dict[str, Any], lying: Lying[T]
) -> RunFolder:
    running = {**summary, "status": "running"}
    if not lying.rows:
        return RunFolder.create(path, running, opening.name, opening.row_type)
    folder = RunFolder(path, opening.name, opening.row_type, lying.rows)
    if not lying.finished:
        folder.write_summary(running)
    return folder


@dataclass(frozen=True)
class Told(Generic[R]):
    """What there is to say of an equilibrium: its row, and what its shape file holds.

    Attributes
    ----------
    disk : with the triangles of its shape
    fields : {name: (n_v, 3) or (n_v,)}, those of the loop's own terms and of contacts
    state : what a solver needs to go on from it
    """

    row: R
    disk: Disk
    fields: dict[str, FloatArray]
    state: dict[str, NDArray[Any]]
    curvatures: Curvatures


def tell(
    problem: Problem,
    found: Equilibrium,
    measurer: Measurer,
    step: int,
    row_type: type[R],
    **cells: Any,
) -> Told[R]:
    """Return what there is to say of an equilibrium of a problem.

    `cells` are those of the row type's own columns, and its quantity.
    """
    measures, curvatures = measurer.measured(found.shape)
    own, fields = problem.said_of_loop(found.shape)
    state = {"tensions": found.tensions, "n_neutral": np.array([found.n_neutral or 0])}
    if problem.loop.diameter is not None:
        from eulerplateau.runs import contact_record as told

        own |= told.contact_cells(found)
        fields["contact_force"] = told.contact_forces(problem, found)
        state |= told.contact_data(problem, found)
    parameters = problem.loop.parameters.items()
    own |= {name: v for name, v in parameters if name in columns(row_type)}
    row = make_row(
        step, found, problem.film.load, row_type, {**cells, **asdict(measures), **own}
    )
    return Told(row, measurer.disk_of(found.shape), fields, state, curvatures)


@dataclass(frozen=True)
class Recorder(Generic[R]):
    """Writes a film's equilibria into a run."""

    run: OpenRun[R]
    measurer: Measurer
    opening: Opening[R]

    def record(
        self,
        problem: Problem,
        found: Equilibrium,
        modes: Mapping[str, FloatArray],
        **cells: Any,
    ) -> R:
        """Write an equilibrium of a problem, modes as its fields.

        `cells` are those of the row type's own columns.
        """
        step, cells = len(self.run.rows), {**cells, "quantity": self.opening.quantity}
        told = tell(problem, found, self.measurer, step, self.opening.row_type, **cells)
        self.run.folder.record(
            told.row,
            told.disk,
            found.shape.x,
            {**modes, **told.fields},
            problem.disk.digest,
            told.state,
            told.curvatures,
        )
        self.run.rows.append(told.row)
        return told.row


@contextmanager
def recording(
    spec: RunSpec, problem: Problem, path: Path, opening: Opening[R], started: float
) -> Iterator[Recorder[R]]:
    """Open the folder `path` for a film's run, as `opened` does."""
    disk = problem.disk
    about = describe(spec, disk, opening.quantity)
    with opened(path, opening, about, started) as run:
        yield Recorder(run, Measurer(disk), opening)


def keep_point(
    run: OpenRun[Any],
    point: DiagramPoint,
    columns: Sequence[str],
    special: list[dict[str, Any]],
) -> None:
    """Write what there is of a point besides its row: its special line, and the way on."""
    if point.special is not None and not point.known:
        write_special(run.folder.path, columns, special)
    if point.then is not None:
        run.folder.keep(point.then.arrays)
    run.totals |= {"points": len(run.rows), "special": len(special)}


def not_converged(rows: Sequence[Record]) -> list[int]:
    """Return the steps of the rows that are not equilibria."""
    return [row.step for row in rows if not row.converged]
