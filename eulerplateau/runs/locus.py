"""Carry out a locus: a curve of special points in two parameters, into a folder."""

from __future__ import annotations

import csv
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from eulerplateau.branches import (
    BIFURCATION,
    FOLD,
    Known,
    LocusPoint,
    energy_at,
    locus_of_film,
)
from eulerplateau.errors import ConflictError, OutputError, SpecError
from eulerplateau.film import FILM_LOADS
from eulerplateau.interruption import heed, working_on
from eulerplateau.loop import LEAST
from eulerplateau.runs.inputs import make_mesh
from eulerplateau.runs.locus_record import Asked, Locus
from eulerplateau.runs.parameters import BENCH, LOOP_PARAMETERS, NEEDED
from eulerplateau.runs.record import read_run
from eulerplateau.runs.rows import LoadName
from eulerplateau.runs.shape_files import read_shape
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.start import make_problem
from eulerplateau.solvers import Problem

LOCUS = "locus.csv"
COLUMNS = (
    "arclength", "energy", "n_unstable", "coefficient", "kind", "special", "end", "residual"
)  # fmt: skip


def run_locus(
    spec: RunSpec,
    asked: Asked,
    path: Path,
    on_row: Callable[[dict[str, Any]], None] = lambda row: None,
    *,
    overwrite: bool = False,
) -> Locus:
    """Follow a curve of special points into the folder `path`; rows appear as they come.

    Raises SpecError where there is no such point, or where it does not persist;
    ConflictError if another curve lies there.
    """
    started = time.perf_counter()
    spec.loop.refuse_thickness("curves of special points")
    problem, known, load = _start(spec, asked)
    varied = spec.explored, asked.second
    names = _name(spec, varied[0]), _name(spec, varied[1])
    windows = spec.window(), _window(problem.value(asked.second, load), asked)
    points = locus_of_film(problem, known, load, varied, windows)
    path.mkdir(parents=True, exist_ok=True)
    rows: list[dict[str, Any]] = []
    breaks: tuple[str, ...] = ()
    working_on(lambda: f"{path}: {len(rows)} points")
    if (path / LOCUS).exists() and not overwrite:
        raise ConflictError(path, ["points"])
    with (path / LOCUS).open("w", newline="", encoding="utf-8") as file:
        columns = names[0].column, names[1].column, *COLUMNS
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        writer.writeheader()
        for point in points:
            breaks = point.course.breaks
            rows.append(_row(point, columns))
            writer.writerow(rows[-1])
            file.flush()
            on_row(rows[-1])
            heed()
    return Locus(path, names, tuple(rows), time.perf_counter() - started, breaks)


def _start(spec: RunSpec, asked: Asked) -> tuple[Problem, Known, float]:
    """Return the special point, of which problem it is and at which load."""
    if spec.explored in BENCH:
        what = f"found {spec.explored!r}; curves are followed in the load, or in the loop's"
        raise SpecError("sweep.parameter", f"{what} own numbers")
    disk = make_mesh(spec)
    run = read_run(asked.run)
    said = run.special.get(asked.number)
    if said is None:
        there = ", ".join(str(number) for number in run.special) or "none"
        raise SpecError("--point", f"found {asked.number}; {asked.run} has {there}")
    row = next(row for row in run.rows if row.special == asked.number)
    shape = read_shape(run.shape_path(row))
    if shape.rest_mesh != disk.digest:
        raise OutputError(
            asked.run, "is the run of another mesh: explore its branches anew"
        )
    held = spec.held or 0.0
    if run.load.column != spec.column(spec.explored):
        raise OutputError(asked.run, f"varies {run.load.text}: explore its branches anew")
    problem, load = make_problem(spec, disk).at(spec.explored, row.load, held)
    if asked.second != "load" and asked.second not in problem.loop.parameters:
        needed = NEEDED[asked.second]
        what = f"loop.{asked.second} needs a run whose loop.{needed} is given, and not 0"
        raise SpecError("--with", what)
    return problem, Known(said["kind"], shape, int(said["multiplicity"])), load


def _window(value: float, asked: Asked) -> tuple[float, float]:
    """Return the window of the second parameter, whose value at the start is given."""
    reach = max(abs(value), 1.0)
    low = max(value - reach, LEAST[asked.second]) if asked.low is None else asked.low
    high = value + reach if asked.high is None else asked.high
    if not low <= value <= high:
        raise SpecError("--from, --to", f"{low:g} to {high:g} does not hold {value:g}")
    return low, high


def _name(spec: RunSpec, parameter: str) -> LoadName:
    """Return what a parameter is called in tables and on axes."""
    return LOOP_PARAMETERS.get(parameter) or FILM_LOADS[spec.film.model]


def _row(point: LocusPoint, columns: tuple[str, ...]) -> dict[str, Any]:
    values = (
        *(float(value) for value in point.values),
        point.arclength,
        energy_at(point),
        point.n_unstable,
        point.coefficient,
        BIFURCATION if point.course.symmetric else FOLD,
        point.special,
        point.end,
        point.model.residual,
    )
    return dict(zip(columns, values, strict=True))
