"""Carry out a sweep: from its specification to a folder of rows and shapes."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from eulerplateau.arrays import FloatArray
from eulerplateau.runs.recording import make_mesh, not_converged, recording
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.start import start_shape
from eulerplateau.runs.table import Row
from eulerplateau.solvers import Equilibrium, Problem, sweep


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
        rows = recorder.run.rows
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
            recorder.run.totals |= {
                "loads": len(rows),
                "not_converged": not_converged(rows),
                "iterations": sum(row.iterations for row in rows),
                "solver_seconds": sum(row.seconds for row in rows),
                "neutral": neutral,
            }
    return RunResult(path, tuple(rows), tuple(neutral), recorder.run.seconds)


def _modes(spec: RunSpec, problem: Problem, found: Equilibrium) -> dict[str, FloatArray]:
    if spec.output.modes == 0:
        return {}
    # Loaded only where it is asked for: a sweep by cg has no use for newton's modules.
    from eulerplateau.solvers import lowest_modes

    return lowest_modes(problem, found, spec.output.modes)
