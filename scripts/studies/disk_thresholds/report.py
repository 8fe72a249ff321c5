"""Tables of the thresholds, in Markdown and CSV, with their orders of convergence."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from scripts.studies.common import markdown_table
from scripts.studies.disk_thresholds.thresholds import (
    ACROSS,
    CIRCLE,
    MESHES,
    PI3,
    WITHIN,
    Thresholds,
)

COLUMNS = (
    *("film", "polygon", "mesh", "vertices", "loop_edges"),
    *("across", "across_over_limit", "within", "within_over_limit"),
)


def order(found: Iterable[Thresholds], part: int) -> float:
    """Return the fitted order in the loop's edges of a part of `errors`."""
    known = [(1 / t.n_b, e) for t in found if (e := errors(t)[part]) is not None]
    size, error = np.log(np.abs(known)).T
    return float(np.polyfit(size, error, 1)[0])


def errors(found: Thresholds) -> tuple[float, float | None]:
    """Return the relative errors of the thresholds across the plane and within it."""
    within = None
    if found.within is not None:
        within = found.within / WITHIN[found.case.film] - 1
    return found.across / ACROSS - 1, within


def table(film: str, every: Iterable[Thresholds]) -> str:
    """Return the Markdown table of a film."""
    every = [found for found in every if found.case.film == film]
    rows = [["polygon", "mesh", "vertices", "loop edges"]]
    rows[0] += ["σ̂ across", "over 96π³"]  # noqa: RUF001
    planar = film in WITHIN
    if planar:
        rows[0] += ["σ̂ within", f"over {WITHIN[film] / PI3:.0f}π³"]  # noqa: RUF001
    for polygon, mesh in MESHES:
        here = [f for f in every if (f.case.polygon, f.case.mesh) == (polygon, mesh)]
        rows += [
            [polygon, mesh, str(f.n_v), str(f.n_b), *cells(f)[: 4 if planar else 2]]
            for f in here
        ]
        if planar and polygon == CIRCLE:
            across, within = (order(here, part) for part in (0, 1))
            rows.append(["", "order", "", "", "", f"{across:.2f}", "", f"{within:.2f}"])
    return f"\n### {film.capitalize()}\n\n{markdown_table(rows, words=2)}"


def cells(found: Thresholds) -> list[str]:
    """Return both thresholds, each with its ratio to the limit."""
    across, within = errors(found)
    text = [f"{found.across:.3f}", f"{1 + across:.6f}"]
    if found.within is None or within is None:
        return [*text, "", ""]
    return [*text, f"{found.within:.3f}", f"{1 + within:.6f}"]


def write_csv(path: Path, every: Iterable[Thresholds]) -> None:
    """Write one row for each film on each mesh."""
    with path.open("w", newline="", encoding="utf-8") as file:
        lines = csv.writer(file, lineterminator="\n")
        lines.writerow(COLUMNS)
        for f in every:
            mesh = [f.case.film, f.case.polygon, f.case.mesh, f.n_v, f.n_b]
            across, within = errors(f)
            planar = ["", ""] if within is None else [f.within, 1 + within]
            lines.writerow([*mesh, f.across, 1 + across, *planar])
