"""Carry out an exploration: branches, folds and bifurcations, into a folder."""

from __future__ import annotations

import csv
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import (
    FilmPoint,
    SpecialPoint,
    equilibrium_near,
    explore,
    first_equilibrium,
)
from eulerplateau.errors import SpecError
from eulerplateau.film import FILM_LOADS
from eulerplateau.mesh import Disk, write_whole
from eulerplateau.runs.recording import Opening, OpenRun, make_mesh, recording
from eulerplateau.runs.rows import BranchRow
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.start import start_shape, stored_start
from eulerplateau.runs.table import table_content
from eulerplateau.solvers import Equilibrium, Problem

SPECIAL_COLUMNS = (
    "number", "kind", "kL3_alpha", "kL3_alpha_error", "sigma_hat", "sigma_hat_error",
    "branch", "step", "n_unstable", "eigenvalue", "multiplicity", "transverse", "breaks",
    "keeps",
)  # fmt: skip


@dataclass(frozen=True)
class Exploration:
    """What an exploration came to; `finished` if an earlier call had come to it."""

    folder: Path
    rows: tuple[BranchRow, ...]
    special: tuple[dict[str, Any], ...]
    seconds: float
    finished: bool = False

    @property
    def unresolved(self) -> int:
        """How many points lie where the loop turns too sharply for its mesh."""
        return sum(not row.converged for row in self.rows)


def run_branches(
    spec: RunSpec,
    path: Path,
    on_row: Callable[[BranchRow], None] = lambda row: None,
    *,
    overwrite: bool = False,
) -> Exploration:
    """Explore the branches of `spec` into the folder `path`; rows appear as they come.

    This very run, finished, is left as it is; unfinished, it starts again. Another run
    raises ConflictError, or is replaced if `overwrite` is true.

    Starts at the window's lowest load from the equilibrium a sweep would find there; with
    start.file from the equilibrium next to that shape, stable or not, at its own load.
    """
    started = time.perf_counter()
    disk = make_mesh(spec)
    if spec.film.plane:
        raise SpecError("film.plane", "should be false: branches leave the plane")
    problem = Problem(disk, spec.film.model)
    window = _window(spec)
    start = _start(spec, disk, problem, window)
    special: list[dict[str, Any]] = []
    column = FILM_LOADS[spec.film.model].column
    opening = Opening("branches", BranchRow, column, overwrite, resumable=False)
    with recording(spec, disk, path, opening, started) as recorder:
        if recorder.run.finished:
            return _as_it_is(recorder.run)
        _write_special(path, special)
        points = explore(
            problem,
            window,
            start,
            special_points=spec.branches.special_points,
            unstable_modes=spec.branches.unstable_modes,
        )
        rows = recorder.run.rows
        try:
            for point in points:
                row = recorder.record(
                    point.equilibrium,
                    _modes(point),
                    branch=point.branch,
                    origin=point.origin,
                    special=point.number,
                    arclength=point.point.arclength,
                )
                if point.special is not None and not point.known:
                    special.append(_special(row, point.special))
                    _write_special(path, special)
                on_row(row)
        finally:
            recorder.run.totals |= {"points": len(rows), "special": len(special)}
    return Exploration(path, tuple(rows), tuple(special), recorder.run.seconds)


def _as_it_is(run: OpenRun[BranchRow]) -> Exploration:
    """Return what a finished exploration has come to."""
    with (run.folder.path / "special_points.csv").open(
        newline="", encoding="utf-8"
    ) as file:
        special = tuple({**line} for line in csv.DictReader(file))
    return Exploration(run.folder.path, tuple(run.rows), special, run.seconds, True)


def _window(spec: RunSpec) -> tuple[float, float]:
    loads = [load for load in spec.loads() if load > 0] or [1.0]
    low = spec.branches.load_min or min(loads)
    high = spec.branches.load_max or max(loads)
    if low >= high:
        raise SpecError(
            "branches.load_min", f"found {low:g}; should be below load_max, {high:g}"
        )
    return low, high


def _start(
    spec: RunSpec, disk: Disk, problem: Problem, window: tuple[float, float]
) -> Equilibrium:
    stored, shape = stored_start(spec, disk), start_shape(spec, disk)
    if stored is None:
        return first_equilibrium(problem, window[0], shape)
    load = stored.load(problem.film.load)
    if not window[0] <= load <= window[1]:
        raise SpecError(
            "start.file",
            f"{spec.start.file} has the load {load:g}, outside the window "
            f"{window[0]:g} to {window[1]:g}: set branches.load_min and load_max",
        )
    return equilibrium_near(problem, shape, load)


def _modes(point: FilmPoint) -> dict[str, FloatArray]:
    """Return the critical mode, continued into the film as the film follows the loop."""
    mode = point.critical_mode
    return {} if mode is None else {"critical_mode": mode}


def _write_special(path: Path, special: list[dict[str, Any]]) -> None:
    content = table_content(SPECIAL_COLUMNS, special)
    write_whole(path / "special_points.csv", content)


def _special(row: BranchRow, special: SpecialPoint) -> dict[str, Any]:
    return {
        "number": row.special,
        "kind": special.kind,
        "kL3_alpha": row.kL3_alpha,
        "kL3_alpha_error": row.load_name.springs(special.error),
        "sigma_hat": row.sigma_hat,
        "sigma_hat_error": row.load_name.tension(special.error),
        "branch": row.branch,
        "step": row.step,
        "n_unstable": special.n_unstable,
        "eigenvalue": special.eigenvalue,
        "multiplicity": special.multiplicity,
        "transverse": special.symmetry.transverse,
        "breaks": "; ".join(special.symmetry.breaks),
        "keeps": "; ".join(special.symmetry.keeps),
    }
