"""Carry out an ensemble: what is missing of it, by processes here or by a cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from eulerplateau.errors import SpecError
from eulerplateau.interruption import working_on
from eulerplateau.runs.ensembles.cases import Case, Outcome, carry_out
from eulerplateau.runs.ensembles.folder import (
    case_folder,
    case_places,
    is_finished,
    open_ensemble,
    record_failure,
)
from eulerplateau.runs.ensembles.joining import Table, joined
from eulerplateau.runs.ensembles.spec import Ensemble
from eulerplateau.runs.ensembles.workers import Died, in_workers

Task = tuple[Case, Path]


@dataclass(frozen=True)
class EnsembleResult:
    """What a call came to.

    Attributes
    ----------
    table : Table, of all cases of this call, computed now or before
    computed : int, of the cases those that this call carried out
    cases : int, all of this call
    """

    table: Table
    computed: int
    cases: int


def run_ensemble(
    ensemble: Ensemble,
    out: Path,
    on_case: Callable[[Case, Outcome], None] = lambda case, outcome: None,
    *,
    workers: int = 1,
    shard: tuple[int, int] = (0, 1),
    dask: str | None = None,
) -> EnsembleResult:
    """Carry out the cases of an ensemble that are missing in the folder `out`.

    A case that an earlier call has finished is not computed again; one that failed is.
    A case that fails, or whose process dies twice, costs the others nothing.

    Parameters
    ----------
    on_case : called as each case ends
    workers : processes of this machine
    shard : (i, n)
        Only every n-th case, from the i-th on, counted from 0.
    dask : address of a Dask scheduler, whose workers are used instead
        They have to see `out` and the files that the cases name.

    Raises
    ------
    SpecError, OutputError, MissingLibraryError : what is wrong, in a line
    """
    if workers < 1:
        raise SpecError("--workers", f"found {workers}; should be 1 or more")
    out = out.absolute()
    mine = cases_of(ensemble, shard)
    open_ensemble(out, [case.name for case in ensemble.cases])
    tasks = [(case, case_folder(out, case.name)) for case in missing(mine, out)]
    there = len(mine) - len(tasks)
    working_on(lambda: f"{out}: {there} of {len(mine)} cases are there")
    for case, outcome in _outcomes(tasks, workers, dask):
        there += not outcome.problem
        record_failure(out, case.name, _failure(case, outcome))
        on_case(case, outcome)
    table = joined(case_places(out, [case.name for case in mine]))
    return EnsembleResult(table, len(tasks), len(mine))


def _failure(case: Case, outcome: Outcome) -> dict[str, Any] | None:
    """Return what is kept of a case that failed; None if it did not."""
    if not outcome.problem:
        return None
    return {
        "kind": "cell" if case.kind.startswith("cell") else "film",
        "spec": case.spec.model_dump(mode="json"),
        "problem": outcome.problem,
        "exit_code": outcome.exit_code,
    }


def cases_of(ensemble: Ensemble, shard: tuple[int, int] = (0, 1)) -> tuple[Case, ...]:
    """Return the cases of a shard: every n-th, from the i-th on; raises SpecError."""
    part, parts = shard
    if not 0 <= part < parts:
        found = f"found {part}/{parts}"
        raise SpecError("--shard", f"{found}; should be I/N with I from 0 to N - 1")
    return ensemble.cases[part::parts]


def missing(cases: Sequence[Case], out: Path) -> list[Case]:
    """Return the cases that are not finished in a folder."""
    return [case for case in cases if not is_finished(out, case.name)]


def _outcomes(
    tasks: Sequence[Task], workers: int, dask: str | None
) -> Iterator[tuple[Case, Outcome]]:
    if not tasks:
        return
    if dask is None:
        ended = in_workers(carry_out, tasks, workers)
    else:
        # Loaded with Dask only.
        from eulerplateau.runs.ensembles.cluster import on_dask

        ended = on_dask(carry_out, tasks, dask)
    for (case, _), found in ended:
        if isinstance(found, Died):
            yield case, Outcome(0, 0, 0.0, found.how, 1)
        else:
            yield case, found
