"""`eulerplateau ensemble`: many runs from one file, on all cores or on a cluster."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from eulerplateau.cli.batch import QUIET
from eulerplateau.cli.options import writes_to

if TYPE_CHECKING:
    from eulerplateau.runs.ensembles import Case, EnsembleResult, Outcome

    Show = Callable[[Case, Outcome], None]


class _Shard(click.ParamType[tuple[int, int]]):
    """I/N."""

    name = "I/N"

    def convert(
        self, value: str, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, int]:
        """Return (i, n)."""
        found = re.fullmatch(r"(\d+)/(\d+)", value)
        if found is None:
            self.fail(f"{value!r} should be I/N, as in 0/4", param, ctx)
        return int(found[1]), int(found[2])


@click.command()
@click.argument("spec", metavar="ENSEMBLE.toml", type=click.Path(path_type=Path))
@writes_to(
    "The folder of all cases. Default: beside ENSEMBLE.toml, with its name.",
)
@click.option("--workers", type=int, help="Processes. Default: one for each core.")
@click.option(
    "--shard",
    type=_Shard(),
    help="Only every N-th case, from the I-th on, counted from 0: for job arrays. "
    "`eulerplateau collect` joins what they come to.",
)
@click.option("--dask", metavar="ADDRESS", help="The scheduler of a Dask cluster, to use.")
@click.option("--parquet", is_flag=True, help="Write ensemble.parquet too.")
@QUIET
def ensemble(
    spec: Path,
    out: Path | None,
    workers: int | None,
    shard: tuple[int, int] | None,
    dask: str | None,
    parquet: bool,
    quiet: bool,
) -> int:
    """Carry out the cases of ENSEMBLE.toml that are missing, and write one table of all.

    A case is a run; it is known by its specification and by the contents of the files that
    it names, so that a repeated call computes what is missing and no more. Writes
    ensemble.csv (all rows, with the keys in which cases differ; of a case that failed its
    reason) and a run folder for each case, cases/NAME.
    """
    from eulerplateau.runs.ensembles import (
        cases_of,
        check_parquet,
        load_ensemble,
        missing,
        run_ensemble,
    )

    if dask and workers is not None:
        raise click.BadParameter("has workers of its own: drop --workers or --dask")
    if parquet:
        check_parquet()
    found = load_ensemble(spec)
    folder = out or spec.with_suffix("")
    part = shard or (0, 1)
    mine = cases_of(found, part)
    with _progress(len(missing(mine, folder)), folder.name, quiet) as show:
        count = _cores() if workers is None else workers
        result = run_ensemble(found, folder, show, workers=count, shard=part, dask=dask)
    written = []
    if shard is None:
        written = ["ensemble.csv", "ensemble.parquet"] if parquet else ["ensemble.csv"]
        for name in written:
            result.table.write(folder / name)
    _report(result, folder, written, quiet)
    return result.table.exit_code


def _cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@contextmanager
def _progress(total: int, name: str, quiet: bool) -> Iterator[Show]:
    """Yield what is shown each case: for people a bar, for scripts a line a case."""
    if quiet or not total:
        yield lambda case, outcome: None
    elif not sys.stderr.isatty():
        numbers = iter(range(1, total + 1))

        def line(case: Case, outcome: Outcome) -> None:
            click.echo(f"{next(numbers)}/{total} {_text(case, outcome)}", err=True)

        yield line
    else:
        from tqdm import tqdm

        with tqdm(total=total, desc=name, unit="case", dynamic_ncols=True) as bar:

            def show(case: Case, outcome: Outcome) -> None:
                if outcome.problem or outcome.not_converged:
                    bar.write(_text(case, outcome), file=sys.stderr)
                bar.update()

            yield show


def _text(case: Case, outcome: Outcome) -> str:
    if outcome.problem:
        said = f"failed: {outcome.problem}"
    elif outcome.not_converged:
        said = f"{outcome.not_converged} of {outcome.rows} rows did not converge"
    else:
        said = f"{outcome.rows} row{'s'[: outcome.rows != 1]} in {outcome.seconds:.2f} s"
    return f"{case.name} {case.label}: {said}" if case.label else f"{case.name}: {said}"


def _report(result: EnsembleResult, folder: Path, written: list[str], quiet: bool) -> None:
    """Say what did not converge, and, unless told to be quiet, what there is."""
    failed, lost = len(result.table.failed), result.table.not_converged
    if failed or lost:
        click.echo(
            f"eulerplateau: {folder}: {failed} of {result.cases} cases failed, "
            f"{lost} rows did not converge",
            err=True,
        )
    if quiet:
        return
    before = result.cases - result.computed
    known = f", {before} of them before" if before else ""
    rows = len(result.table.lines) - failed
    next_step = ", ".join(written) or f"next: eulerplateau collect {folder}"
    click.echo(f"{folder}: {rows} rows of {result.cases} cases{known}: {next_step}")
