"""Carry out an exploration: branches, folds and bifurcations, into a folder."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
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
from eulerplateau.interruption import heed
from eulerplateau.mesh import Disk
from eulerplateau.runs.inputs import make_mesh
from eulerplateau.runs.kinds import film_kind
from eulerplateau.runs.recording import (
    Opening,
    Recorder,
    keep_point,
    recording,
)
from eulerplateau.runs.rows import BranchRow
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.start import make_problem, start_shape, stored_start
from eulerplateau.runs.table import special_of, write_special
from eulerplateau.solvers import Equilibrium, Problem

SPECIAL_COLUMNS = (
    "number", "kind", "kL3_alpha", "kL3_alpha_error", "sigma_hat", "sigma_hat_error",
    "branch", "step", "n_unstable", "eigenvalue", "multiplicity", "transverse", "breaks",
    "keeps",
)  # fmt: skip


@dataclass(frozen=True)
class Exploration:
    """What an exploration came to.

    `kept` rows are an earlier call's, which was `finished` if there was nothing left to
    do; `before` says in a line what is done with what it left.
    """

    folder: Path
    rows: tuple[BranchRow, ...]
    special: tuple[dict[str, Any], ...]
    seconds: float
    kept: int = 0
    finished: bool = False
    before: str = ""

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

    This very run, finished, is left as it is; unfinished, it goes on. Another run raises
    ConflictError, or is replaced if `overwrite` is true.

    Starts at the window's lowest load from the equilibrium a sweep would find there; with
    start.file from the equilibrium next to that shape, stable or not, at its own load.
    """
    started = time.perf_counter()
    disk = make_mesh(spec)
    if spec.film.plane:
        raise SpecError("film.plane", "should be false: branches leave the plane")
    problem = make_problem(spec, disk)
    window = _window(spec)
    column = FILM_LOADS[spec.film.model].column
    row_type = film_kind(spec.loop.twist_ratio, spec.loop.rest_curvature).branch_row
    opening = Opening("branches", row_type, column, overwrite)
    with recording(spec, problem, path, opening, started) as recorder:
        run = recorder.run
        special = special_of(run.rows, run.folder.path)
        if not run.finished:
            write_special(run.folder.path, SPECIAL_COLUMNS, special)
            new = run.progress is None
            points = explore(
                problem,
                window,
                _start(spec, disk, problem, window) if new else None,
                special_points=spec.branches.special_points,
                unstable_modes=spec.branches.unstable_modes,
                progress=run.progress,
            )
            for row in _recorded(points, recorder, special):
                on_row(row)
                heed()
    rows, kept = tuple(run.rows), (run.kept, run.finished, run.before)
    return Exploration(path, rows, tuple(special), run.seconds, *kept)


def _recorded(
    points: Iterator[FilmPoint],
    recorder: Recorder[BranchRow],
    special: list[dict[str, Any]],
) -> Iterator[BranchRow]:
    """Write points as they come, special ones twice; yield their rows."""
    run = recorder.run
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
        keep_point(run, point, SPECIAL_COLUMNS, special)
        yield row


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
