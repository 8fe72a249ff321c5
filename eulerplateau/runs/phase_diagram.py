"""The phase diagram of a regular cell: lines of located points, a shape in each region."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from scipy.ndimage import distance_transform_edt

from eulerplateau.cells import solve_cell
from eulerplateau.errors import SpecError
from eulerplateau.exact.cell import (
    SymmetryBreaking,
    Transition,
    fold_line,
    inflection_onset,
    inflection_stiffness,
    reconnection,
    rigid_fold,
    star,
    symmetry_breaking,
)
from eulerplateau.interruption import heed
from eulerplateau.mesh import write_whole
from eulerplateau.runs.cell_recording import describe, record_cell
from eulerplateau.runs.cell_spec import CellRunSpec, PhaseDiagramSettings
from eulerplateau.runs.cell_table import CellRow
from eulerplateau.runs.phases import REGIONS, Line, PhaseDiagram
from eulerplateau.runs.recording import Opening, opened
from eulerplateau.runs.table import table_content
from eulerplateau.threads import one_thread

# Points of the fold, and how often a line's beginning is halved.
_FOLD_POINTS, _HALVINGS = 160, 7
# The grid on which the middle of a region is found.
_GRID = 48
LINE_COLUMNS = (
    "line", "sigma_hat", "ks_hat", "wave", "kappa_mid", "extension", "perimeter", "energy"
)  # fmt: skip


def run_phase_diagram(
    spec: CellRunSpec, path: Path, on_point: Callable[[str], None] = lambda line: None
) -> PhaseDiagram:
    """Compute a phase diagram into the folder `path`, calling `on_point` for each point.

    It writes lines.csv, points.csv, and a row of sweep.csv with its shape for each region.
    Raises SpecError for a cell that is not regular or has line tension.
    """
    started = time.perf_counter()
    n = _regular(spec)
    window = spec.phase_diagram
    with one_thread():
        located = _located(n, window, on_point)
    points = {name: [p for p in found if p] for name, found in located.items()}
    lines = {name: _line(name, found) for name, found in points.items()}
    special = _special(n)
    opening = Opening("sweep", CellRow, "sigma_hat", overwrite=True)
    with opened(path, opening, describe(spec), started) as run:
        write_whole(run.folder.path / "lines.csv", _table(points))
        write_whole(run.folder.path / "points.csv", _special_table(n, special))
        diagram = PhaseDiagram(
            path, window.sigma_hat, window.ks_hat, lines, special, _sigma_p(n), {}, {}, 0.0
        )
        for region, (sigma, ks, room) in _middles(diagram).items():
            found = solve_cell(spec.cell.made(), sigma, ks)
            record_cell(run, CellRow, "sigma_hat", found)
            diagram.shapes[region], diagram.room[region] = found, room
        run.totals["regions"] = list(diagram.shapes)
        return PhaseDiagram(**{**vars(diagram), "seconds": run.seconds})


def _regular(spec: CellRunSpec) -> int:
    if spec.cell.adhesions is None:
        raise SpecError("cell.adhesions", "should be given: diagrams are of regular cells")
    if spec.cell.beta_hat:
        raise SpecError("cell.beta_hat", "should be 0: lines are known without tension")
    return spec.cell.adhesions


def _located(
    n: int, window: PhaseDiagramSettings, on_point: Callable[[str], None]
) -> dict[str, list[Transition | None]]:
    """Return the points of each line, by its name."""
    flat, folded = inflection_onset(n), rigid_fold(n)
    # Its shape is that of the softest inflected cell, at radius 2/3: rigid, it is at 1.
    straight = _loads((2 / 3) ** 3 * flat.sigma_hat, window)
    unlike = _loads(folded.sigma_hat, window)
    return {
        "inflection": [_counted(on_point, inflection_stiffness(n, s)) for s in straight],
        **_unlike(n, unlike, on_point),
        "fold": [_counted(on_point, point) for point in fold_line(n, _FOLD_POINTS)],
    }


def _loads(begin: float, window: PhaseDiagramSettings) -> list[float]:
    """Return contractilities of a window above 1, closer together above a beginning."""
    low, high = max(window.sigma_hat[0], 1 + 1e-6), max(window.sigma_hat[1], 1.1)
    even = np.geomspace(low, high, window.columns)
    near = begin * (1 + np.geomspace(1e-3, 0.3, window.columns // 2))
    inside = near[(near > low) & (near < high)]
    return sorted({float(load) for load in (*even, *inside)})


def _unlike(
    n: int, loads: list[float], on_point: Callable[[str], None]
) -> dict[str, list[Transition | None]]:
    """Return where symmetry is lost, and where all waves are stable again."""
    found = {}

    def locate(load: float) -> bool:
        found[load] = symmetry_breaking(n, load)
        _counted(on_point, found[load][0] if found[load] else None)
        return bool(found[load])

    known = [locate(load) for load in loads]
    for (low, high), (before, after) in zip(pairwise(loads), pairwise(known), strict=True):
        # Where the line begins, as closely as halving tells.
        for _ in range(_HALVINGS if before != after else 0):
            middle = float(np.sqrt(low * high))
            low, high = (low, middle) if locate(middle) == after else (middle, high)
    return {
        "symmetry lost": [points[0] if points else None for points in found.values()],
        "symmetry regained": [p[-1] if _again(p) else None for p in found.values()],
    }


def _again(points: Sequence[SymmetryBreaking]) -> bool:
    """Return whether waves have become unstable, and all of them stable again."""
    last = {point.q: point for point in points}
    return bool(points) and not any(point.lost for point in last.values())


def _counted(
    on_point: Callable[[str], None], point: Transition | None
) -> Transition | None:
    heed()
    on_point("" if point is None else f"{point.sigma_hat:.4g}, {point.ks_hat:.4g}")
    return point


def _line(name: str, points: Sequence[Transition]) -> Line:
    ordered = sorted(points, key=lambda point: point.sigma_hat)
    return Line(
        name,
        np.array([point.sigma_hat for point in ordered]),
        np.array([point.ks_hat for point in ordered]),
    )


def _special(n: int) -> dict[str, tuple[float, float]]:
    inflected, folded = inflection_onset(n), reconnection(n)
    return {
        "softest inflected": (inflected.sigma_hat, inflected.ks_hat),
        "softest fold": (folded.sigma_hat, folded.ks_hat),
    }


def _sigma_p(n: int) -> float | None:
    return star(n).sigma_p if n > 2 else None


def _middles(diagram: PhaseDiagram) -> dict[str, tuple[float, float, float]]:
    """Return the point of each region farthest from all others, and how far that is."""
    sigma = np.geomspace(*diagram.sigma_hat, _GRID)
    ks = np.geomspace(*diagram.ks_hat, _GRID)
    region = diagram.regions(*np.meshgrid(sigma, ks, indexing="ij"))
    middles = {}
    for number, name in enumerate(REGIONS):
        inside = np.pad(region == number, 1)
        if inside.any():
            depth = distance_transform_edt(inside)[1:-1, 1:-1]
            i, j = np.unravel_index(int(depth.argmax()), depth.shape)
            room = float(depth[i, j]) / _GRID
            middles[name] = float(sigma[i]), float(ks[j]), room
    return middles


def _table(points: dict[str, list[Transition]]) -> bytes:
    rows = [
        {
            "line": name,
            "sigma_hat": point.sigma_hat,
            "ks_hat": point.ks_hat,
            "wave": getattr(point, "q", ""),
            "kappa_mid": point.cell.kappa_mid,
            "extension": point.cell.extension,
            "perimeter": point.cell.perimeter,
            "energy": point.cell.energy,
        }
        for name, found in points.items()
        for point in found
    ]
    return table_content(LINE_COLUMNS, rows)


def _special_table(n: int, special: dict[str, tuple[float, float]]) -> bytes:
    rows: list[dict[str, Any]] = [
        {"point": name, "sigma_hat": sigma, "ks_hat": ks}
        for name, (sigma, ks) in special.items()
    ]
    if n > 2:
        rows.append({"point": "star without protrusion", "sigma_hat": _sigma_p(n)})
    return table_content(("point", "sigma_hat", "ks_hat"), rows)
