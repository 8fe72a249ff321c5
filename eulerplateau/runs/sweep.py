"""Carry out a sweep: from its specification to a folder of rows and shapes."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.mesh import Disk, Shape
from eulerplateau.runs.recording import make_mesh, not_converged, recording
from eulerplateau.runs.shape_files import StoredShape, read_shape
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.table import Row
from eulerplateau.solvers import Equilibrium, Problem, displaced, sweep


@dataclass(frozen=True)
class RunResult:
    """What a run came to.

    `neutral` numbers the rows with an eigenvalue that cannot be told from zero: whether
    they are stable is not known.
    """

    folder: Path
    rows: tuple[Row, ...]
    neutral: tuple[int, ...]
    seconds: float

    @property
    def failures(self) -> list[Row]:
        """The rows that are not equilibria."""
        return [row for row in self.rows if not row.converged]


def run_sweep(
    spec: RunSpec, path: Path, on_row: Callable[[Row], None] = lambda row: None
) -> RunResult:
    """Run `spec` into the folder `path`, calling `on_row` as each row is on disk.

    Interrupted (KeyboardInterrupt) or failing half-way it leaves a valid folder and says
    so in its run.json. Raises MeshError, SpecError, OutputError.
    """
    started = time.perf_counter()
    disk = make_mesh(spec)
    problem = Problem(disk, spec.film.model, in_plane=spec.film.plane)
    start, solver = start_shape(spec, disk), spec.solver
    neutral: list[int] = []
    with recording(spec, disk, path, "sweep", Row, started) as recorder:
        rows = recorder.rows
        try:
            for found in sweep(
                problem,
                spec.loads(),
                start,
                solver=solver.name,
                max_iterations=solver.max_iterations,
            ):
                row = recorder.record(found, _modes(spec, problem, found))
                neutral += [row.step] if found.n_neutral else []
                on_row(row)
        finally:
            recorder.totals |= {
                "loads": len(rows),
                "not_converged": not_converged(rows),
                "iterations": sum(row.iterations for row in rows),
                "solver_seconds": sum(row.seconds for row in rows),
                "neutral": neutral,
            }
    return RunResult(path, tuple(rows), tuple(neutral), recorder.seconds)


def start_shape(spec: RunSpec, disk: Disk) -> Shape:
    """Return the first shape of a run: the disk, or a stored shape, displaced.

    Raises SpecError if the stored shape belongs to another mesh at rest.
    """
    x = displaced(disk, spec.start.displacement, spec.start.seed)
    stored = stored_start(spec, disk)
    if stored is None:
        return disk.shape.moved(x)
    return stored.moved(stored.x + (x - disk.x))


def stored_start(spec: RunSpec, disk: Disk) -> StoredShape | None:
    """Return the shape that start.file names, None without one; raises SpecError."""
    if spec.start.file is None:
        return None
    stored = read_shape(spec.start.file)
    if stored.rest_mesh != disk.digest:
        found = stored.rest_mesh[:8] or "none: it was written before shapes said so"
        problem = f"{spec.start.file} belongs to another mesh at rest (SHA-256 {found}"
        raise SpecError("start.file", f"{problem}, here {disk.digest[:8]})")
    return stored


def _modes(spec: RunSpec, problem: Problem, found: Equilibrium) -> dict[str, FloatArray]:
    if spec.output.modes == 0:
        return {}
    # Loaded only where it is asked for: a sweep by cg has no use for newton's modules.
    from eulerplateau.solvers import lowest_modes

    return lowest_modes(problem, found, spec.output.modes)
