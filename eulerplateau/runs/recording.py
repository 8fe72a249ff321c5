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
from eulerplateau.runs.table import Row
from eulerplateau.solvers import Equilibrium

# Matrices here are as large as the loop: a second thread waits more than it works.
BLAS_THREADS = 1

R = TypeVar("R", bound=Row)


@dataclass
class Recorder(Generic[R]):
    """Writes equilibria into a run folder: the row, and the shape before it.

    Attributes
    ----------
    rows : those that are on disk
    totals : what run.json says when all is over
    """

    folder: RunFolder
    measurer: Measurer
    load: Load
    row_type: type[R]
    started: float
    rest_mesh: str
    rows: list[R] = field(default_factory=list)
    totals: dict[str, Any] = field(default_factory=dict)

    @property
    def seconds(self) -> float:
        """Since the run began."""
        return time.perf_counter() - self.started

    def record(
        self, found: Equilibrium, modes: Mapping[str, FloatArray], **columns: Any
    ) -> R:
        """Write an equilibrium, modes as its fields; `columns` are the row type's own."""
        measured = asdict(self.measurer.measure(found.shape))
        row = make_row(len(self.rows), found, self.load, self.row_type, measured | columns)
        disk = self.measurer.disk_of(found.shape)
        self.folder.record(row, disk, found.shape.x, modes, self.rest_mesh)
        self.rows.append(row)
        return row


@contextmanager
def recording(
    spec: RunSpec, disk: Disk, path: Path, name: str, row_type: type[R], started: float
) -> Iterator[Recorder[R]]:
    """Open the folder `path` for a run whose table is `name`.csv, and close it.

    Interrupted or failing half-way it leaves a valid folder and says so in its run.json.
    """
    summary = describe(spec, disk)
    with (
        threadpool_limits(BLAS_THREADS, user_api="blas"),
        RunFolder.create(path, {**summary, "status": "running"}, name, row_type) as folder,
    ):
        summary["blas_threads"] = blas_threads()
        load = FILM_LOADS[spec.film.model]
        recorder = Recorder(folder, Measurer(disk), load, row_type, started, disk.digest)
        status = "interrupted"
        try:
            yield recorder
            status = "finished"
        finally:
            totals = {**recorder.totals, "seconds": recorder.seconds}
            folder.write_summary({**summary, "status": status, "totals": totals})


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
        "versions": {
            "eulerplateau": __version__,
            "python": platform.python_version(),
            **{name: version(name) for name in ("numpy", "scipy", "numba", "vtk", "gmsh")},
        },
        "machine": platform.machine(),
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


def not_converged(rows: Sequence[Row]) -> list[int]:
    """Return the steps of the rows that are not equilibria."""
    return [row.step for row in rows if not row.converged]
