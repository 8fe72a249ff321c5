"""Carry out a sweep: from its specification to a folder of rows and shapes."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import ConflictError, EulerPlateauError
from eulerplateau.interruption import heed
from eulerplateau.mesh import Disk, Shape
from eulerplateau.runs.about import describe
from eulerplateau.runs.continuing import look
from eulerplateau.runs.inputs import make_mesh
from eulerplateau.runs.kinds import film_kind
from eulerplateau.runs.parameters import in_problem
from eulerplateau.runs.recording import (
    Opening,
    OpenRun,
    not_converged,
    recording,
)
from eulerplateau.runs.rows import Row
from eulerplateau.runs.series_file import shape_name
from eulerplateau.runs.shape_files import read_state
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.start import make_problem, start_shape
from eulerplateau.solvers import Equilibrium, Problem, follow_steps


@dataclass(frozen=True)
class RunResult:
    """What a run came to.

    `neutral` numbers the rows with an eigenvalue that cannot be told from zero: whether
    they are stable is not known. `kept` rows are an earlier call's, which was `finished` if
    there was nothing left to do; `before` says in a line what is done with what it left.
    """

    folder: Path
    rows: tuple[Row, ...]
    neutral: tuple[int, ...]
    seconds: float
    kept: int = 0
    finished: bool = False
    before: str = ""

    @property
    def failures(self) -> list[Row]:
        """The rows that are not equilibria."""
        return [row for row in self.rows if not row.converged]


def run_sweep(
    spec: RunSpec,
    path: Path,
    on_row: Callable[[Row], None] = lambda row: None,
    *,
    overwrite: bool = False,
    resume: bool = False,
) -> RunResult:
    """Run `spec` into the folder `path`, calling `on_row` as each new row is on disk.

    What an earlier call has left there of this very run is kept, and the run goes on from
    it; with `resume` a run of the first loads of this one is continued too. Another run
    raises ConflictError, or is replaced if `overwrite` is true. Interrupted
    (KeyboardInterrupt) or failing half-way it leaves a valid folder and says so in its
    run.json. Raises MeshError, SpecError, OutputError.
    """
    started = time.perf_counter()
    disk = make_mesh(spec)
    problem = make_problem(spec, disk, refine=spec.film.refine)
    start, tensions, solver = start_shape(spec, disk), None, spec.solver
    opening = _opening(spec, overwrite, resume)
    held, varied = spec.held or 0.0, in_problem(spec.sweep.varied)
    steps = [(*problem.at(varied, value, held), own) for value, own in spec.steps()]
    with recording(spec, problem, path, opening, started) as recorder:
        run = recorder.run
        neutral = _neutral(run)
        if run.kept and not run.finished:
            start, tensions = _state(run, disk, start)
            recorder.measurer.measure(start)
        try:
            left = steps[run.kept :]
            swept = follow_steps(
                problem,
                [(there, load) for there, load, _ in left],
                start,
                tensions=tensions,
                solver=solver.name,
                max_iterations=solver.max_iterations,
            )
            for found, (there, _, own) in zip(swept, left, strict=True):
                row = recorder.record(there, found, _modes(spec, there, found), **own)
                neutral += [row.step] if found.n_neutral else []
                on_row(row)
                heed()
        finally:
            run.totals |= {
                "loads": len(run.rows),
                "not_converged": not_converged(run.rows),
                "iterations": sum(row.iterations for row in run.rows),
                "solver_seconds": sum(row.seconds for row in run.rows),
                "neutral": neutral,
            }
    rows, kept = tuple(run.rows), (run.kept, run.finished, run.before)
    return RunResult(path, rows, tuple(neutral), run.seconds, *kept)


def conflict(spec: RunSpec, path: Path, *, resume: bool = False) -> ConflictError | None:
    """Return what stands against carrying out a run in a folder; None if nothing does."""
    if not (path / "run.json").is_file():
        return None
    opening = _opening(spec, False, resume)
    column = opening.quantity
    try:
        about = describe(spec, make_mesh(spec), column)
        look(path, about, "sweep", opening.row_type, column, opening.loads)
    except ConflictError as error:
        return error
    except EulerPlateauError:
        pass  # whatever it is, the run says it when its turn comes
    return None


def _opening(spec: RunSpec, overwrite: bool, resume: bool) -> Opening[Row]:
    """Return how the folder of a sweep is opened."""
    quantity, loads = spec.column(spec.sweep.varied), spec.values() if resume else None
    loop = spec.loop
    row_type = film_kind(loop.twist_ratio, loop.rest_curvature, quantity, loop.diameter).row
    return Opening("sweep", row_type, quantity, overwrite, loads=loads)


def _neutral(run: OpenRun[Row]) -> list[int]:
    """Return the numbers of the rows kept that are neutral."""
    told = run.about.get("totals", {}).get("neutral")
    if run.finished and isinstance(told, list):
        return [step for step in told if isinstance(step, int)]
    states = (read_state(run.folder.path / shape_name(row.step))[1] for row in run.rows)
    flags = [bool(state.get("n_neutral", np.zeros(1))[0]) for state in states]
    return [row.step for row, flag in zip(run.rows, flags, strict=True) if flag]


def _state(run: OpenRun[Row], disk: Disk, start: Shape) -> tuple[Shape, FloatArray | None]:
    """Return the last finite shape of the rows kept and its tensions, or the start."""
    for row in reversed(run.rows):
        shape, state = read_state(run.folder.path / shape_name(row.step))
        if np.isfinite(shape.x).all():
            if np.array_equal(shape.triangles, disk.triangles):
                shape = disk.shape.moved(shape.x)  # on the disk's own triangles
            return shape, state["tensions"].astype(np.float64)
    return start, None


def _modes(spec: RunSpec, problem: Problem, found: Equilibrium) -> dict[str, FloatArray]:
    if spec.output.modes == 0:
        return {}
    # Loaded only where it is asked for: a sweep by cg has no use for newton's modules.
    from eulerplateau.solvers import lowest_modes

    return lowest_modes(problem, found, spec.output.modes)
