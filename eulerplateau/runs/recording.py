"""What a sweep and an exploration have in common: a folder that fills row by row."""

from __future__ import annotations

import platform
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import Any, Generic, TypeVar

from threadpoolctl import threadpool_info, threadpool_limits

from eulerplateau import __version__
from eulerplateau.arrays import FloatArray
from eulerplateau.film import FILM_LOADS, Load
from eulerplateau.mesh import Disk, Measurer, generate, read_disk
from eulerplateau.runs.folder import RunFolder
from eulerplateau.runs.spec import RunSpec, StoredMesh
from eulerplateau.runs.table import Record, Row
from eulerplateau.solvers import Equilibrium

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
    totals : what run.json says when all is over
    """

    folder: RunFolder
    started: float
    rows: list[T] = field(default_factory=list)
    totals: dict[str, Any] = field(default_factory=dict)

    @property
    def seconds(self) -> float:
        """Since the run began."""
        return time.perf_counter() - self.started


@contextmanager
def opened(
    path: Path, name: str, row_type: type[T], summary: dict[str, Any], started: float
) -> Iterator[OpenRun[T]]:
    """Open the folder `path` for a run whose table is `name`.csv, and close it.

    Interrupted or failing half-way it leaves a valid folder and says so in its run.json,
    which otherwise is `summary` with what the run has come to.
    """
    summary = {**summary, "versions": _versions(), "machine": platform.machine()}
    with (
        threadpool_limits(BLAS_THREADS, user_api="blas"),
        RunFolder.create(path, {**summary, "status": "running"}, name, row_type) as folder,
    ):
        summary["blas_threads"] = blas_threads()
        run: OpenRun[T] = OpenRun(folder, started)
        status = "interrupted"
        try:
            yield run
            status = "finished"
        finally:
            totals = {**run.totals, "seconds": run.seconds}
            folder.write_summary({**summary, "status": status, "totals": totals})


@dataclass(frozen=True)
class Recorder(Generic[R]):
    """Writes a film's equilibria into a run."""

    run: OpenRun[R]
    measurer: Measurer
    load: Load
    row_type: type[R]
    rest_mesh: str

    def record(
        self, found: Equilibrium, modes: Mapping[str, FloatArray], **columns: Any
    ) -> R:
        """Write an equilibrium, modes as its fields; `columns` are the row type's own."""
        measured = asdict(self.measurer.measure(found.shape))
        step = len(self.run.rows)
        row = make_row(step, found, self.load, self.row_type, measured | columns)
        disk = self.measurer.disk_of(found.shape)
        self.run.folder.record(row, disk, found.shape.x, modes, self.rest_mesh)
        self.run.rows.append(row)
        return row


@contextmanager
def recording(
    spec: RunSpec, disk: Disk, path: Path, name: str, row_type: type[R], started: float
) -> Iterator[Recorder[R]]:
    """Open the folder `path` for a film's run, as `opened` does."""
    with opened(path, name, row_type, describe(spec, disk), started) as run:
        load = FILM_LOADS[spec.film.model]
        yield Recorder(run, Measurer(disk), load, row_type, disk.digest)


def blas_threads() -> list[int]:
    """Return the threads of each BLAS that is loaded, as they are now."""
    pools = threadpool_info()
    return [pool["num_threads"] for pool in pools if pool["user_api"] == "blas"]


def make_mesh(spec: RunSpec) -> Disk:
    """Read or generate the mesh of a run."""
    if isinstance(spec.mesh, StoredMesh):
        return read_disk(Path(spec.mesh.file))
    return generate(spec.mesh)


def describe(spec: RunSpec, mesh: Disk) -> dict[str, Any]:
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
    }


def _versions() -> dict[str, str]:
    return {
        "eulerplateau": __version__,
        "python": platform.python_version(),
        **{name: version(name) for name in ("numpy", "scipy", "numba", "vtk", "gmsh")},
    }


def make_row(
    step: int, found: Equilibrium, load: Load, row_type: type[R], columns: dict[str, Any]
) -> R:
    """Return the row of an equilibrium; `columns` holds the fields of its Measures.

    `load` says what found.load is. Of a film with a tension, kL3_alpha is the load at which
    springs on equilateral triangles carry the same.
    """
    return row_type(
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
        **columns,
    )


def not_converged(rows: Sequence[Record]) -> list[int]:
    """Return the steps of the rows that are not equilibria."""
    return [row.step for row in rows if not row.converged]
