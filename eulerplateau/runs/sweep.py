"""Carry out a run: from its specification to a folder of rows, shapes and pictures."""

from __future__ import annotations

import platform
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_info, threadpool_limits

from eulerplateau import __version__
from eulerplateau.arrays import FloatArray
from eulerplateau.film import FILM_LOADS, Load
from eulerplateau.mesh import DiskMesh, generate, load_mesh, measure, waist_path
from eulerplateau.runs.folder import RunFolder
from eulerplateau.runs.spec import RunSpec, StoredMesh
from eulerplateau.runs.table import Row
from eulerplateau.solvers import Equilibrium, Problem, displaced, make_problem

Solver = Callable[[Problem, FloatArray, FloatArray, float], Equilibrium]

SOLVER_MODULES = {"newton": "solvers.newton", "cg": "solvers.conjugate_gradient"}

# Matrices here are as large as the loop: a second thread waits more than it works.
BLAS_THREADS = 1


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
    mesh = make_mesh(spec)
    problem = make_problem(mesh, spec.film.model, plane=spec.film.plane)
    load = FILM_LOADS[spec.film.model]
    rows: list[Row] = []
    neutral: list[int] = []
    summary = describe(spec, mesh)
    with (
        threadpool_limits(BLAS_THREADS, user_api="blas"),
        RunFolder.create(path, {**summary, "status": "running"}) as folder,
    ):
        summary["blas_threads"] = blas_threads()
        path_across = waist_path(mesh)
        status = "interrupted"
        try:
            for step, found in enumerate(equilibria(spec, mesh, problem)):
                if found.triangles is not None:
                    mesh = mesh.with_triangles(found.triangles)
                    problem = problem.with_triangles(found.triangles)
                    path_across = waist_path(mesh)
                shape = measure(mesh, found.x, path_across)
                row = make_row(step, found, load, asdict(shape))
                folder.record(row, mesh, found.x, _modes(spec, problem, found))
                rows.append(row)
                neutral += [step] if found.n_neutral else []
                on_row(row)
            status = "finished"
        finally:
            seconds = time.perf_counter() - started
            totals = {**_totals(rows, seconds), "neutral": neutral}
            folder.write_summary({**summary, "status": status, "totals": totals})
    return RunResult(path, tuple(rows), tuple(neutral), seconds)


def blas_threads() -> list[int]:
    """Return the threads of each BLAS that is loaded, as they are now."""
    pools = threadpool_info()
    return [pool["num_threads"] for pool in pools if pool["user_api"] == "blas"]


def _modes(spec: RunSpec, problem: Problem, found: Equilibrium) -> dict[str, FloatArray]:
    if spec.output.modes == 0:
        return {}
    # Loaded only where it is asked for: a sweep by cg has no use for newton's modules.
    from eulerplateau.solvers import lowest_modes

    return lowest_modes(problem, found, spec.output.modes)


def make_mesh(spec: RunSpec) -> DiskMesh:
    """Read or generate the mesh of a run."""
    if isinstance(spec.mesh, StoredMesh):
        return load_mesh(Path(spec.mesh.file))
    return generate(spec.mesh)


def equilibria(spec: RunSpec, mesh: DiskMesh, problem: Problem) -> Iterator[Equilibrium]:
    """Yield one equilibrium per load, each started from the last shape."""
    return sweep(problem, start_shape(spec, mesh), spec.loads(), make_solver(spec))


def sweep(
    problem: Problem, x: FloatArray, loads: Sequence[float], solver: Solver
) -> Iterator[Equilibrium]:
    """Yield one equilibrium per load; x (n_v, 3) is where the first one starts.

    A shape that is not finite is recorded, and not started from. Where a soap film's mesh
    has been repaired, `triangles` says so, and what follows lies on those.
    """
    multipliers = np.zeros(len(problem.loop_vertices))
    for load in loads:
        found = solver(problem, x, multipliers, load)
        yield found
        if found.triangles is not None:
            problem = problem.with_triangles(found.triangles)
        if np.isfinite(found.x).all():
            x, multipliers = found.x, found.multipliers


def start_shape(spec: RunSpec, mesh: DiskMesh) -> FloatArray:
    """Return the first shape (n_v, 3) of a run."""
    return displaced(mesh, spec.start.displacement, spec.start.seed)


def make_solver(spec: RunSpec) -> Solver:
    """Return the solver a run asks for; only that one is imported."""
    solve = import_module(f"eulerplateau.{SOLVER_MODULES[spec.solver.name]}").solve
    limit = spec.solver.max_iterations
    chosen: Solver = solve if limit is None else partial(solve, max_iterations=limit)
    return chosen


def describe(spec: RunSpec, mesh: DiskMesh) -> dict[str, Any]:
    """Return what run.json says before anything is computed.

    B and E are the loop's and all edges, from which the paper's sigma = 4 sqrt(3) k /
    (2 - B/E) can be had; for springs sigma_hat in sweep.csv is 2 sqrt(3) k L^3 / alpha.
    """
    return {
        "spec": spec.model_dump(mode="json"),
        "mesh": {
            "sha256": mesh.digest,
            "vertices": mesh.n_v,
            "triangles": len(mesh.triangles),
            "loop_edges_B": mesh.n_b,
            "edges_E": len(mesh.edges),
            "length": mesh.length,
        },
        "seed": spec.start.seed,
        "versions": {
            "eulerplateau": __version__,
            "python": platform.python_version(),
            **{name: version(name) for name in ("numpy", "scipy", "numba", "vtk", "gmsh")},
        },
        "machine": platform.machine(),
    }


def _totals(rows: Sequence[Row], seconds: float) -> dict[str, Any]:
    return {
        "loads": len(rows),
        "not_converged": [row.step for row in rows if not row.converged],
        "iterations": sum(row.iterations for row in rows),
        "solver_seconds": sum(row.seconds for row in rows),
        "seconds": seconds,
    }


def make_row(step: int, found: Equilibrium, load: Load, shape: dict[str, Any]) -> Row:
    """Return the row of an equilibrium; `shape` holds the fields of its Measures.

    `load` says what found.load is. Of a film with a tension, kL3_alpha is the load at which
    springs on equilateral triangles carry the same.
    """
    return Row(
        step=step,
        quantity=load.column,
        kL3_alpha=load.springs(found.load),
        sigma_hat=load.tension(found.load),
        energy=found.energy,
        film_energy=found.film_energy,
        bending_energy=found.bending_energy,
        n_unstable=found.n_unstable,
        lowest_eigenvalue=found.lowest_eigenvalue,
        residual=found.residual,
        film_residual=found.film_residual,
        length_error=found.length_error,
        iterations=found.iterations,
        seconds=found.seconds,
        status=found.status,
        **shape,
    )
