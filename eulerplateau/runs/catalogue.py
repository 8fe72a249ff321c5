"""Carry out a catalogue: the distinct equilibria at each load, into a folder."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path

from eulerplateau.branches import Entry, Plan, catalogue_at
from eulerplateau.errors import SpecError
from eulerplateau.film import FILM_LOADS
from eulerplateau.mesh import write_whole
from eulerplateau.runs.catalogue_table import (
    COUNT_COLUMNS,
    Catalogue,
    catalogue_row,
    read_counts,
)
from eulerplateau.runs.inputs import make_mesh
from eulerplateau.runs.kinds import film_kind
from eulerplateau.runs.loads import in_order
from eulerplateau.runs.recording import Opening, recording
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.start import make_problem
from eulerplateau.runs.table import table_content


def run_catalogue(
    spec: RunSpec,
    path: Path,
    on_search: Callable[[float], None] = lambda load: None,
    *,
    overwrite: bool = False,
) -> Catalogue:
    """List the equilibria of `spec` at its loads into the folder `path`.

    The rows of a load appear when all its searches, of which `on_search` is told, are over.
    This very run, finished, is left as it is; unfinished, it starts again. Another run
    raises ConflictError, or is replaced if `overwrite` is true.
    """
    started = time.perf_counter()
    if spec.loop.twist_ratio is not None:
        what = "should be absent: catalogues take mirror images for the same"
        raise SpecError("loop.twist_ratio", what)
    disk = make_mesh(spec)
    problem = make_problem(spec, disk)
    settings = spec.catalogue
    plan = Plan(settings.starts, settings.index, settings.distance, settings.seed)
    row = catalogue_row(film_kind(None, None, diameter=spec.diameter))
    column = FILM_LOADS[spec.film.model].column
    opening = Opening("catalogue", row, column, overwrite)
    counts: list[dict[str, float]] = []
    with recording(spec, problem, path, opening, started) as recorder:
        run = recorder.run
        if run.finished:
            return Catalogue(
                path, tuple(run.rows), read_counts(path), run.seconds, True, run.before
            )
        for load in catalogue_loads(spec):
            found = catalogue_at(problem, load, plan, lambda load=load: on_search(load))  # type: ignore[misc]
            for number, entry in enumerate(found):
                recorder.record(
                    problem,
                    entry.equilibrium,
                    {},
                    number=number,
                    symmetry=entry.symmetry,
                    by_starts=len(entry.starts),
                    by_deflation=len(entry.guesses),
                    first_start=min(entry.starts, default=None),
                    first_guess=min(entry.guesses, default=None),
                )
            counts += _counted(load, found, plan.starts)
            write_whole(
                run.folder.path / "counts.csv", table_content(COUNT_COLUMNS, counts)
            )
        run.totals |= {"equilibria": len(run.rows)}
    return Catalogue(path, tuple(run.rows), tuple(counts), run.seconds)


def catalogue_loads(spec: RunSpec) -> list[float]:
    """Return the loads of a catalogue, rising."""
    given = spec.catalogue.loads
    return sorted(set(spec.loads())) if given is None else in_order(given, "up")


def _counted(load: float, found: Sequence[Entry], searches: int) -> list[dict[str, float]]:
    """Return how many of the equilibria were known after each search."""
    starts = [min(entry.starts, default=searches + 1) for entry in found]
    guesses = [min(entry.guesses, default=searches + 1) for entry in found]
    either = [min(pair) for pair in zip(starts, guesses, strict=True)]
    firsts = dict(zip(COUNT_COLUMNS[2:], (starts, guesses, either), strict=True))
    return [
        {"load": load, "search": number}
        | {name: sum(first <= number for first in all_) for name, all_ in firsts.items()}
        for number in range(1, searches + 1)
    ]
