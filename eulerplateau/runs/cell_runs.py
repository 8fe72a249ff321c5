"""Carry out a cell's sweep or the exploration of its branches, into a folder."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from eulerplateau.branches import SpecialPoint
from eulerplateau.cells import ENDS, Cell, CellPoint, explore_cell, solve_cell, sweep_cell
from eulerplateau.errors import ConflictError
from eulerplateau.interruption import heed
from eulerplateau.runs.cell_recording import describe, record_cell
from eulerplateau.runs.cell_spec import CellRunSpec
from eulerplateau.runs.cell_table import CellBranchRow, CellRow
from eulerplateau.runs.continuing import look
from eulerplateau.runs.recording import (
    Opening,
    OpenRun,
    keep_point,
    not_converged,
    opened,
)
from eulerplateau.runs.shape_files import read_state
from eulerplateau.runs.table import special_of, write_special

SPECIAL_COLUMNS = (
    "number", "kind", "sigma_hat", "ks_hat", "error", "branch", "step", "n_unstable",
    "eigenvalue", "multiplicity", "breaks", "keeps",
)  # fmt: skip


@dataclass(frozen=True)
class CellRun:
    """What a run of a cell came to; `special` is empty for a sweep.

    `kept` rows are an earlier call's, which was `finished` if nothing was left to do;
    `before` says in a line what is done with what it left.
    """

    folder: Path
    rows: tuple[CellRow, ...]
    special: tuple[dict[str, Any], ...]
    seconds: float
    kept: int = 0
    finished: bool = False
    before: str = ""

    @property
    def failures(self) -> list[CellRow]:
        """The rows that are not equilibria."""
        return [row for row in self.rows if not row.converged]


def run_cell_sweep(
    spec: CellRunSpec,
    path: Path,
    on_row: Callable[[CellRow], None] = lambda row: None,
    *,
    overwrite: bool = False,
    resume: bool = False,
) -> CellRun:
    """Sweep a cell into the folder `path`, calling `on_row` as each new row is on disk.

    What an earlier call has left there of this very run is kept, and the run goes on from
    it; with `resume` a run of the first loads of this one is continued too. Another run
    raises ConflictError, or is replaced if `overwrite` is true. It ends early where the
    edge first touches itself. Interrupted or failing half-way it leaves a valid folder and
    says so in its run.json. Raises SpecError, OutputError.
    """
    started = time.perf_counter()
    cell, pairs = spec.cell.made(), spec.pairs()
    values = spec.swept.in_order() if resume else None
    varied = spec.swept.parameter
    opening = Opening("sweep", CellRow, varied, overwrite, loads=values)
    with opened(path, opening, describe(spec), started) as run:
        over = run.finished or any(row.status in ENDS for row in run.rows[-1:])
        left = [] if over else pairs[run.kept :]
        start = read_state(run.last_shape)[0].x[:, :2] if run.kept else None
        try:
            for found in sweep_cell(cell, left, start, max_iterations=spec.max_iterations):
                on_row(record_cell(run, CellRow, spec.swept.parameter, found))
                heed()
        finally:
            run.totals |= {
                "values": len(run.rows),
                "of": len(pairs),
                "not_converged": not_converged(run.rows),
            }
    return _result(run, ())


def cell_conflict(
    spec: CellRunSpec, path: Path, *, resume: bool = False
) -> ConflictError | None:
    """Return what stands against a cell's sweep in a folder; None if nothing does."""
    loads = spec.swept.in_order() if resume else None
    try:
        look(path, describe(spec), "sweep", CellRow, spec.swept.parameter, loads)
    except ConflictError as error:
        return error
    return None


def run_cell_branches(
    spec: CellRunSpec,
    path: Path,
    on_row: Callable[[CellBranchRow], None] = lambda row: None,
    *,
    overwrite: bool = False,
) -> CellRun:
    """Explore a cell's branches into the folder `path`; rows appear as they come.

    This very run, finished, is left as it is; unfinished, it goes on. Another run raises
    ConflictError, or is replaced if `overwrite` is true.

    Starts at the lowest value of the window, or at the cell's own where that lies inside,
    and goes both ways from there.
    """
    started = time.perf_counter()
    cell, window, varied = spec.cell.made(), spec.window(), spec.swept.parameter
    opening = Opening("branches", CellBranchRow, varied, overwrite)
    with opened(path, opening, describe(spec), started) as run:
        special = special_of(run.rows, run.folder.path)
        if not run.finished:
            write_special(run.folder.path, SPECIAL_COLUMNS, special)
            for row in _recorded(_points(spec, cell, window, run), varied, run, special):
                on_row(row)
                heed()
    return _result(run, tuple(special))


def _points(
    spec: CellRunSpec, cell: Cell, window: tuple[float, float], run: OpenRun[CellBranchRow]
) -> Iterator[CellPoint]:
    """Return the points that are not in the folder yet."""
    varied = spec.swept.parameter
    own = getattr(spec.cell, varied)
    inside = varied in spec.cell.model_fields_set and window[0] < own < window[1]
    sigma_hat, ks_hat = spec.pair(own if inside else window[0])
    return explore_cell(
        cell,
        "load" if varied == "sigma_hat" else "stiffness",
        window,
        ks_hat if varied == "sigma_hat" else sigma_hat,
        solve_cell(cell, sigma_hat, ks_hat) if run.progress is None else None,
        special_points=spec.branches.special_points,
        unstable_modes=spec.branches.unstable_modes,
        progress=run.progress,
    )


def _recorded(
    points: Iterator[CellPoint],
    varied: str,
    run: OpenRun[CellBranchRow],
    special: list[dict[str, Any]],
) -> Iterator[CellBranchRow]:
    """Write points as they come, special ones twice; yield their rows."""
    for point in points:
        still = np.zeros_like(point.equilibrium.x)
        mode = still if point.special is None else point.special.mode
        row: CellBranchRow = record_cell(
            run,
            CellBranchRow,
            varied,
            point.equilibrium,
            {"critical_mode": mode},
            branch=point.branch,
            origin=point.origin,
            special=point.number,
            arclength=point.point.arclength,
        )
        if point.special is not None and not point.known:
            special.append(_special(row, point.special))
        keep_point(run, point, SPECIAL_COLUMNS, special)
        yield row


def _result(run: OpenRun[Any], special: tuple[dict[str, Any], ...]) -> CellRun:
    rows, path = tuple(run.rows), run.folder.path
    return CellRun(path, rows, special, run.seconds, run.kept, run.finished, run.before)


def _special(row: CellBranchRow, special: SpecialPoint) -> dict[str, Any]:
    return {
        "number": row.special,
        "kind": special.kind,
        "sigma_hat": row.sigma_hat,
        "ks_hat": row.ks_hat,
        "error": special.error,
        "branch": row.branch,
        "step": row.step,
        "n_unstable": special.n_unstable,
        "eigenvalue": special.eigenvalue,
        "multiplicity": special.multiplicity,
        "breaks": "; ".join(special.symmetry.breaks),
        "keeps": "; ".join(special.symmetry.keeps),
    }
