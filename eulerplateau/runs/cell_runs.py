"""Carry out a cell's sweep or the exploration of its branches, into a folder."""

from __future__ import annotations

import csv
import io
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eulerplateau.branches import SpecialPoint
from eulerplateau.cells import explore_cell, solve_cell, sweep_cell
from eulerplateau.mesh import write_whole
from eulerplateau.runs.cell_recording import describe, record_cell
from eulerplateau.runs.cell_spec import CellRunSpec
from eulerplateau.runs.cell_table import CellBranchRow, CellRow
from eulerplateau.runs.recording import not_converged, opened

SPECIAL_COLUMNS = (
    "number", "kind", "sigma_hat", "ks_hat", "error", "branch", "step", "n_unstable",
    "eigenvalue", "multiplicity", "breaks", "keeps",
)  # fmt: skip


@dataclass(frozen=True)
class CellRun:
    """What a run of a cell came to; `special` is empty for a sweep."""

    folder: Path
    rows: tuple[CellRow, ...]
    special: tuple[dict[str, Any], ...]
    seconds: float

    @property
    def failures(self) -> list[CellRow]:
        """The rows that are not equilibria."""
        return [row for row in self.rows if not row.converged]


def run_cell_sweep(
    spec: CellRunSpec, path: Path, on_row: Callable[[CellRow], None] = lambda row: None
) -> CellRun:
    """Sweep a cell into the folder `path`, calling `on_row` as each row is on disk.

    It ends early where the edge first touches itself. Interrupted or failing half-way it
    leaves a valid folder and says so in its run.json. Raises SpecError, OutputError.
    """
    started = time.perf_counter()
    cell, pairs = spec.cell.made(), spec.pairs()
    with opened(path, "sweep", CellRow, describe(spec), started) as run:
        limit = spec.max_iterations
        for found in sweep_cell(cell, pairs, max_iterations=limit):
            on_row(record_cell(run, CellRow, spec.swept.parameter, found))
            run.totals |= {
                "values": len(run.rows),
                "of": len(pairs),
                "not_converged": not_converged(run.rows),
            }
    return CellRun(path, tuple(run.rows), (), run.seconds)


def run_cell_branches(
    spec: CellRunSpec,
    path: Path,
    on_row: Callable[[CellBranchRow], None] = lambda row: None,
) -> CellRun:
    """Explore a cell's branches into the folder `path`; rows appear as they come.

    Starts at the lowest value of the window, or at the cell's own where that lies inside,
    and goes both ways from there.
    """
    started = time.perf_counter()
    cell, window, varied = spec.cell.made(), spec.window(), spec.swept.parameter
    own = getattr(spec.cell, varied)
    inside = varied in spec.cell.model_fields_set and window[0] < own < window[1]
    start = solve_cell(cell, *spec.pair(own if inside else window[0]))
    special: list[dict[str, Any]] = []
    with opened(path, "branches", CellBranchRow, describe(spec), started) as run:
        write_whole(path / "special_points.csv", _table(special))
        points = explore_cell(
            cell,
            "load" if varied == "sigma_hat" else "stiffness",
            window,
            start.ks_hat if varied == "sigma_hat" else start.sigma_hat,
            start,
            special_points=spec.branches.special_points,
            unstable_modes=spec.branches.unstable_modes,
        )
        for point in points:
            mode = {} if point.special is None else {"critical_mode": point.special.mode}
            row = record_cell(
                run,
                CellBranchRow,
                varied,
                point.equilibrium,
                mode,
                branch=point.branch,
                origin=point.origin,
                special=point.number,
                arclength=point.point.arclength,
            )
            if point.special is not None and not point.known:
                special.append(_special(row, point.special))
                write_whole(path / "special_points.csv", _table(special))
            run.totals |= {"points": len(run.rows), "special": len(special)}
            on_row(row)
    return CellRun(path, tuple(run.rows), tuple(special), run.seconds)


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


def _table(special: list[dict[str, Any]]) -> bytes:
    text = io.StringIO()
    writer = csv.DictWriter(text, SPECIAL_COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(special)
    return text.getvalue().encode()
