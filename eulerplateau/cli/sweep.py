"""`eulerplateau sweep`: one run or many, with a progress bar."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from eulerplateau.cli.batch import OVERWRITE, RESUME, before, begin, carried_out
from eulerplateau.cli.options import offered, offered_settings, writes_to
from eulerplateau.cli.overrides import parse_setting
from eulerplateau.compiling import telling_of_compiling
from eulerplateau.errors import NOT_CONVERGED_EXIT_CODE

if TYPE_CHECKING:
    from eulerplateau.runs import Row, RunResult, RunSpec


@click.command()
@click.argument(
    "specs", metavar="RUN.toml...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@writes_to(
    "The run folder; for several runs, the folder that holds theirs. "
    "Default: beside RUN.toml, with its name and what is set.",
)
@click.option(
    "--solver",
    shell_complete=offered("newton", "cg", "cg-plain"),
    help="newton, cg or cg-plain; short for --set solver.name=NAME.",
)
@click.option(
    "--set",
    "settings",
    metavar="KEY=VALUE,...",
    multiple=True,
    shell_complete=offered_settings("RunSpec"),
    help="Replace a key of the specification, as in solver.name=cg or start.seed=1,2,3; "
    "several values make several runs, several --set all their combinations.",
)
@click.option("--pictures/--no-pictures", default=True, help="Draw diagram.png (default).")
@click.option("--render", is_flag=True, help="Render one picture per distinct state.")
@RESUME
@OVERWRITE
@click.option("--quiet", is_flag=True, help="No progress bar, no summary: for batches.")
def sweep(
    specs: tuple[Path, ...],
    out: Path | None,
    solver: str | None,
    settings: tuple[str, ...],
    pictures: bool,
    render: bool,
    resume: bool,
    overwrite: bool,
    quiet: bool,
) -> int:
    """Follow the equilibria of each RUN.toml over its loads.

    Writes a run folder: sweep.csv (one row per load), shapes/*.vtp and sweep.pvd (for
    ParaView), run.json, diagram.png. A run that is there already is kept, and continued if
    it was interrupted.
    """
    begin(out)
    from eulerplateau.runs import conflict, load_run, planned

    values = [parse_setting(text) for text in settings]
    if solver is not None:
        values.append(("solver.name", [solver]))

    def one(spec: RunSpec, folder: Path) -> int:
        result = _run(spec, folder, quiet, resume, overwrite)
        values = "loads" if spec.sweep.varied == "load" else "values"
        _report(result, values, _draw(result, pictures, render), quiet)
        return NOT_CONVERGED_EXIT_CODE if result.failures else 0

    runs = planned(list(specs), values, out, load_run)
    return carried_out(runs, partial(conflict, resume=resume), one, overwrite)


def _run(
    spec: RunSpec, folder: Path, quiet: bool, resume: bool, overwrite: bool
) -> RunResult:
    from eulerplateau.runs import run_sweep

    if quiet:
        return run_sweep(spec, folder, resume=resume, overwrite=overwrite)
    from tqdm import tqdm

    total = len(spec.values())
    with tqdm(
        total=total,
        desc=folder.name,
        unit=spec.sweep.varied,
        dynamic_ncols=True,
        disable=None,
    ) as bar:

        def show(row: Row) -> None:
            bar.set_postfix_str(
                f"{row.load_name.text} {row.load:g}, <|kappa_n|> {row.abs_kappa_n:.3g}"
            )
            bar.update()

        with telling_of_compiling(bar.set_postfix_str):
            return run_sweep(spec, folder, show, resume=resume, overwrite=overwrite)


def _draw(result: RunResult, pictures: bool, render: bool) -> list[str]:
    """Draw what was asked for; return the names of what was drawn."""
    drawn = []
    if pictures:
        from eulerplateau.pictures import draw_diagram

        if draw_diagram(result.folder):
            drawn.append("diagram.png")
    if render:
        from eulerplateau.pictures.render import draw_shapes
        from eulerplateau.runs import distinct_steps

        steps = distinct_steps(result.rows)
        if draw_shapes(result.folder, steps):
            drawn.append(f"{len(steps)} pictures")
    return drawn


def _report(result: RunResult, values: str, drawn: list[str], quiet: bool) -> None:
    """Say what a sweep came to; `values` is what those are called that it is over."""
    for row in result.failures:
        click.echo(
            f"eulerplateau: {result.folder}: {row.load_name.text} {row.load:g} "
            f"{row.status.value}: {row.status.advice}",
            err=True,
        )
    if result.neutral and not quiet:
        click.echo(
            f"{result.folder}: {len(result.neutral)} rows are neutral: their lowest "
            "eigenvalue cannot be told from zero (run.json lists them)",
            err=True,
        )
    if not quiet:
        before(result.folder, result.before)
        converged = len(result.rows) - len(result.failures)
        click.echo(
            f"{result.folder}: {converged} of {len(result.rows)} {values} converged in "
            f"{result.seconds:.1f} s: {', '.join(['sweep.csv', 'sweep.pvd', *drawn])}"
        )
