"""Carry out an exploration: branches, folds and bifurcations, into a folder."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import (
    FilmPoint,
    SpecialPoint,
    equilibrium_near,
    explore,
    first_equilibrium,
    where_from,
)
from eulerplateau.errors import SpecError
from eulerplateau.film import Load
from eulerplateau.interruption import heed
from eulerplateau.mesh import Disk
from eulerplateau.runs.inputs import make_mesh
from eulerplateau.runs.kinds import film_kind
from eulerplateau.runs.parameters import (
    LOOP_PARAMETERS,
    LoopParameter,
    in_problem,
    own_parameter,
)
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

_BEFORE = "number", "kind"
_LOADS = "kL3_alpha", "kL3_alpha_error", "sigma_hat", "sigma_hat_error"
_AFTER = (
    "branch", "step", "n_unstable", "eigenvalue", "multiplicity", "transverse", "breaks",
    "keeps",
)  # fmt: skip
_CONTACT = "contact"
SPECIAL_COLUMNS = (*_BEFORE, *_LOADS, *_AFTER)


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
    Another parameter than the load has the loop's own value for its start, if that is in
    the window.
    """
    started = time.perf_counter()
    if spec.film.plane:
        raise SpecError("film.plane", "should be false: branches leave the plane")
    disk = make_mesh(spec)
    problem = make_problem(spec, disk)
    window, held, quantity = spec.window(), spec.held, spec.column(spec.explored)
    varied, thickness = in_problem(spec.explored), spec.diameter
    rod = spec.twist_ratio, spec.loop.rest_curvature
    row_type = film_kind(*rod, quantity, thickness).branch_row
    opening = Opening("branches", row_type, quantity, overwrite)
    names = special_columns(opening.quantity, thickness)
    with recording(spec, problem, path, opening, started) as recorder:
        run = recorder.run
        special = special_of(run.rows, run.folder.path)
        if not run.finished:
            write_special(run.folder.path, names, special)
            start = None
            if run.progress is None:
                problem, start = _start(spec, disk, problem, window)
            points = explore(
                problem,
                window,
                start,
                parameter=varied,
                load=None if varied == "load" else held,
                special_points=spec.branches.special_points,
                unstable_modes=spec.branches.unstable_modes,
                progress=run.progress,
            )
            for row in _recorded(spec, points, recorder, names, special):
                on_row(row)
                heed()
    rows, kept = tuple(run.rows), (run.kept, run.finished, run.before)
    return Exploration(path, rows, tuple(special), run.seconds, *kept)


def _recorded(
    spec: RunSpec,
    points: Iterator[FilmPoint],
    recorder: Recorder[BranchRow],
    names: Sequence[str],
    special: list[dict[str, Any]],
) -> Iterator[BranchRow]:
    """Write points as they come, special ones twice; yield their rows."""
    run = recorder.run
    for point in points:
        row = recorder.record(
            point.problem,
            point.equilibrium,
            _modes(point),
            branch=point.branch,
            origin=point.origin,
            special=point.number,
            arclength=point.point.arclength,
            **spec.cells_at(point.equilibrium.load),
        )
        if point.special is not None and not point.known:
            told = _special(row, point.special, point.problem.film.load)
            if point.problem.loop.diameter is not None:
                told[_CONTACT] = point.special.contact
            special.append(told)
        keep_point(run, point, names, special)
        yield row


def special_columns(quantity: str, diameter: float | None = None) -> tuple[str, ...]:
    """Return the columns of the special points of a run, by the column of what it varies.

    Where that is no load, both loads are there too, which are held. Of a loop that has a
    diameter there is one for what happens to its strands.
    """
    after = _AFTER if diameter is None else (*_AFTER, _CONTACT)
    own = own_parameter(quantity)
    if own is None:
        return *_BEFORE, *_LOADS, *after
    varied = own.column, f"{own.column}_error"
    if own.column not in LOOP_PARAMETERS:
        return *_BEFORE, *varied, *_LOADS, *after
    return *_BEFORE, *varied, "kL3_alpha", "sigma_hat", *after


def _start(
    spec: RunSpec, disk: Disk, problem: Problem, window: tuple[float, float]
) -> tuple[Problem, Equilibrium]:
    """Return the equilibrium from which branches start, and of which problem it is one."""
    stored, shape = stored_start(spec, disk), start_shape(spec, disk)
    varied, held = in_problem(spec.explored), spec.held or 0.0
    if stored is None:
        there, load = where_from(problem, varied, window, held)
        return there, first_equilibrium(there, load, shape, varied)
    known = {"load": stored.load(problem.film.load), **stored.parameters}
    value = known.get(varied, problem.value(varied, held))
    if not window[0] <= value <= window[1]:
        ends = "load_min and load_max" if spec.explored == "load" else "low and high"
        raise SpecError(
            "start.file",
            f"{spec.start.file} has the {varied} {value:g}, outside the window "
            f"{window[0]:g} to {window[1]:g}: set branches.{ends}",
        )
    there, load = problem.at(varied, value, held)
    return there, equilibrium_near(there, shape, load, varied)


def _modes(point: FilmPoint) -> dict[str, FloatArray]:
    """Return the critical mode, continued into the film as the film follows the loop.

    It is zero where no mode is critical: ParaView knows the fields of the first shape only.
    """
    mode = point.critical_mode
    still = np.zeros_like(point.equilibrium.shape.x)
    return {"critical_mode": still if mode is None else mode}


def _special(row: BranchRow, special: SpecialPoint, load: Load) -> dict[str, Any]:
    return {
        "number": row.special,
        "kind": special.kind,
        **_place(row, special.error, load),
        "branch": row.branch,
        "step": row.step,
        "n_unstable": special.n_unstable,
        "eigenvalue": special.eigenvalue,
        "multiplicity": special.multiplicity,
        "transverse": special.symmetry.transverse,
        "breaks": "; ".join(special.symmetry.breaks),
        "keeps": "; ".join(special.symmetry.keeps),
    }


def _place(row: BranchRow, error: float, load: Load) -> dict[str, float]:
    """Return where a special point lies, and what rounding can have moved it by.

    `error` is that of what the problem varies, which may be this load.
    """
    place = {"kL3_alpha": row.kL3_alpha, "sigma_hat": row.sigma_hat}
    own = own_parameter(row.quantity)
    if isinstance(own, LoopParameter):
        return {**place, own.column: row.load, f"{own.column}_error": error}
    errors = load.springs(error), load.tension(error)
    place |= dict(zip(("kL3_alpha_error", "sigma_hat_error"), errors, strict=True))
    if own is None:
        return place
    held = {own.column: getattr(row, own.column)}
    return place | held | {f"{own.column}_error": own.error(row, errors[1])}
