"""Carry out an exploration: branches, folds and bifurcations, into a folder."""

from __future__ import annotations

import csv
import io
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import (
    BranchPoint,
    Limits,
    Settings,
    SpecialPoint,
    Visit,
    explore,
    first_point,
)
from eulerplateau.errors import SpecError
from eulerplateau.film import FILM_LOADS, AreaFilm, Load
from eulerplateau.mesh import DiskMesh, Measures, measure, waist_path
from eulerplateau.runs.files import write_whole
from eulerplateau.runs.folder import RunFolder
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.sweep import (
    BLAS_THREADS,
    blas_threads,
    describe,
    make_mesh,
    make_row,
    start_shape,
)
from eulerplateau.runs.table import BranchRow
from eulerplateau.solvers import Problem, Status, make_problem, solve

SPECIAL_COLUMNS = (
    "number", "kind", "kL3_alpha", "kL3_alpha_error", "sigma_hat", "sigma_hat_error",
    "branch", "step", "n_unstable", "eigenvalue", "multiplicity", "transverse", "breaks",
    "keeps",
)  # fmt: skip


@dataclass(frozen=True)
class Exploration:
    """What an exploration came to."""

    folder: Path
    rows: tuple[BranchRow, ...]
    special: tuple[dict[str, Any], ...]
    seconds: float

    @property
    def unresolved(self) -> int:
        """How many points lie where the loop turns too sharply for its mesh."""
        return sum(not row.converged for row in self.rows)


def run_branches(
    spec: RunSpec, path: Path, on_row: Callable[[BranchRow], None] = lambda row: None
) -> Exploration:
    """Explore the branches of `spec` into the folder `path`; rows appear as they come.

    Starts at the window's lowest load from the equilibrium a sweep would find there.
    """
    started = time.perf_counter()
    mesh = make_mesh(spec)
    if spec.film.plane:
        raise SpecError("film.plane", "should be false: branches leave the plane")
    problem = make_problem(mesh, spec.film.model)
    load = FILM_LOADS[spec.film.model]
    settings = _settings(spec)
    limits = Limits(spec.branches.special_points, spec.branches.unstable_modes)
    summary = describe(spec, mesh)
    rows: list[BranchRow] = []
    special: list[dict[str, Any]] = []
    with (
        threadpool_limits(BLAS_THREADS, user_api="blas"),
        RunFolder.create(
            path, {**summary, "status": "running"}, "branches", BranchRow
        ) as folder,
    ):
        summary["blas_threads"] = blas_threads()
        across = waist_path(mesh)
        start = _start(spec, mesh, problem, settings)
        status = "interrupted"
        write_whole(path / "special_points.csv", _table(special))
        try:
            for step, visit in enumerate(explore(start, settings, limits)):
                x, tiled = visit.point.film, visit.point.problem.film
                if isinstance(tiled, AreaFilm) and tiled.triangles is not mesh.triangles:
                    mesh = mesh.with_triangles(tiled.triangles)
                    across = waist_path(mesh)
                row = _row(step, visit, load, measure(mesh, x, across), x)
                folder.record(row, mesh, x, _modes(visit.special))
                rows.append(row)
                if visit.special is not None and not visit.known:
                    special.append(_special(row, visit.special))
                    write_whole(path / "special_points.csv", _table(special))
                on_row(row)
            status = "finished"
        finally:
            seconds = time.perf_counter() - started
            totals = {"points": len(rows), "special": len(special), "seconds": seconds}
            folder.write_summary({**summary, "status": status, "totals": totals})
    return Exploration(path, tuple(rows), tuple(special), seconds)


def _settings(spec: RunSpec) -> Settings:
    loads = [load for load in spec.loads() if load > 0] or [1.0]
    low = spec.branches.load_min or min(loads)
    high = spec.branches.load_max or max(loads)
    if low >= high:
        raise SpecError(
            "branches.load_min", f"found {low:g}; should be below load_max, {high:g}"
        )
    return Settings(load_range=(low, high), load_unit=high)


def _start(
    spec: RunSpec, mesh: DiskMesh, problem: Problem, settings: Settings
) -> BranchPoint:
    load = settings.load_range[0]
    nobody = np.zeros(mesh.n_b)
    found = solve(problem, start_shape(spec, mesh), nobody, load)
    # Unresolved is no obstacle: the rows say so, and the command's exit code.
    if found.status not in (Status.CONVERGED, Status.UNRESOLVED):
        raise SpecError(
            "branches.load_min",
            f"no equilibrium found at {load:g} ({found.status.value}): start elsewhere",
        )
    # Upwards from just inside the window, so that the first point does not leave it.
    return first_point(problem.near(found.x), found.x[mesh.loop], load, settings)


def _row(step: int, visit: Visit, load: Load, shape: Measures, x: FloatArray) -> BranchRow:
    point, problem = visit.point, visit.point.problem
    spectrum = point.stability
    found = problem.equilibrium(x, point.model.multipliers, point.load, Status.CONVERGED)
    found = replace(
        problem.judged(found),
        iterations=point.corrections,
        n_unstable=spectrum.n_unstable,
        lowest_eigenvalue=spectrum.lowest,
    )
    return BranchRow(
        **asdict(make_row(step, found, load, asdict(shape))),
        branch=visit.branch,
        origin=visit.origin,
        special=visit.number,
        arclength=point.arclength,
    )


def _modes(special: SpecialPoint | None) -> dict[str, FloatArray]:
    """Return the critical mode, continued into the film as the film follows the loop."""
    if special is None:
        return {}
    return {"critical_mode": special.point.displacement(special.mode)}


def _special(row: BranchRow, special: SpecialPoint) -> dict[str, Any]:
    return {
        "number": row.special,
        "kind": special.kind,
        "kL3_alpha": row.kL3_alpha,
        "kL3_alpha_error": row.load_name.springs(special.load_error),
        "sigma_hat": row.sigma_hat,
        "sigma_hat_error": row.load_name.tension(special.load_error),
        "branch": row.branch,
        "step": row.step,
        "n_unstable": special.n_unstable,
        "eigenvalue": special.eigenvalue,
        "multiplicity": special.multiplicity,
        "transverse": special.symmetry.transverse,
        "breaks": "; ".join(special.symmetry.breaks),
        "keeps": "; ".join(special.symmetry.keeps),
    }


def _table(special: list[dict[str, Any]]) -> bytes:
    text = io.StringIO()
    writer = csv.DictWriter(text, SPECIAL_COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(special)
    return text.getvalue().encode()
