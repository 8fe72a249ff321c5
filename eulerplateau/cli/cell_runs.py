"""`eulerplateau cell sweep` and `cell branches`: a cell's runs, with a progress bar."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eulerplateau.cli.batch import (
    GOES_ON,
    OVERWRITE,
    QUIET,
    RESUME,
    before,
    begin,
    carried_out,
)
from eulerplateau.cli.options import offered_settings, writes_to
from eulerplateau.cli.overrides import load_single, parse_setting, setting, single_values
from eulerplateau.errors import NOT_CONVERGED_EXIT_CODE

if TYPE_CHECKING:
    from eulerplateau.runs import CellBranchRow, CellRow, CellRun, CellRunSpec

_PICTURES = click.option(
    "--pictures/--no-pictures", default=True, help="Draw the diagram (default)."
)


@click.command()
@click.argument(
    "specs", metavar="RUN.toml...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@writes_to(
    "The run folder; for several runs, the folder that holds theirs. "
    "Default: beside RUN.toml, with its name.",
)
@click.option(
    "--set",
    "settings",
    metavar="KEY=VALUE,...",
    multiple=True,
    shell_complete=offered_settings("CellRunSpec"),
    help="Replace a key of the specification, as in cell.ks_hat=100,120; several values "
    "make several runs, several --set all their combinations.",
)
@_PICTURES
@RESUME
@OVERWRITE
@QUIET
def sweep(
    specs: tuple[Path, ...],
    out: Path | None,
    settings: tuple[str, ...],
    pictures: bool,
    resume: bool,
    overwrite: bool,
    quiet: bool,
) -> int:
    """Follow the stable shapes of each RUN.toml's cell over contractility or stiffness.

    Writes a run folder: sweep.csv (one row per value), shapes/*.vtp and sweep.pvd (for
    ParaView), run.json, diagram.png. A run ends where the cell's edge touches itself.
    """
    begin(out)
    from eulerplateau.runs import cell_conflict, load_cell_run, planned

    values = [parse_setting(text) for text in settings]

    def one(spec: CellRunSpec, folder: Path) -> int:
        result = _swept(spec, folder, quiet, resume, overwrite)
        drawn = ["sweep.csv", "sweep.pvd", *_drawn(folder, pictures, "diagram.png")]
        return _report(result, len(spec.pairs()), drawn, quiet)

    runs = planned(list(specs), values, out, load_cell_run)
    return carried_out(runs, partial(cell_conflict, resume=resume), one, overwrite)


def _swept(
    spec: CellRunSpec, folder: Path, quiet: bool, resume: bool, overwrite: bool
) -> CellRun:
    from eulerplateau.runs import run_cell_sweep

    return _shown(
        lambda show: run_cell_sweep(spec, folder, show, resume=resume, overwrite=overwrite),
        quiet,
        desc=folder.name,
        unit="shape",
        total=len(spec.pairs()),
    )


@click.command()
@click.argument("spec", metavar="RUN.toml", type=click.Path(path_type=Path))
@writes_to(
    "The folder to write to. Default: beside RUN.toml, with its name and -branches.",
)
@setting("branches.special_points=3", "CellRunSpec")
@_PICTURES
@GOES_ON
@OVERWRITE
@QUIET
def branches(
    spec: Path,
    out: Path | None,
    settings: tuple[str, ...],
    pictures: bool,
    overwrite: bool,
    quiet: bool,
) -> int:
    """Follow the branches of a cell's shapes, stable and unstable, through folds.

    Writes branches.csv (one row per point), special_points.csv (folds and bifurcations,
    located by an eigenvalue's crossing), shapes/*.vtp with the critical modes,
    branches.pvd (for ParaView), run.json, branches.png.
    """
    begin(out)
    from eulerplateau.runs import load_cell_run, run_cell_branches, run_name

    run = load_single(spec, settings, load_cell_run)
    name = run_name(spec, single_values(settings))
    folder = out or spec.with_name(f"{name}-branches")
    begin(folder)
    result = _shown(
        lambda show: run_cell_branches(run, folder, show, overwrite=overwrite),
        quiet,
        desc=folder.name,
        unit="point",
    )
    drawn = ["branches.csv", "special_points.csv", "branches.pvd"]
    drawn += _drawn(folder, pictures, "branches.png")
    if not quiet:
        from eulerplateau.branches import multiple

        for point in result.special:
            times = multiple(int(point["multiplicity"]))
            name = run.swept.parameter
            value, error = float(point[name]), float(point["error"])
            click.echo(
                f"{point['kind']} {point['number']}{times} at {name} = {value:.8g} +- "
                f"{error:.1g} on branch {point['branch']}, breaks: "
                f"{point['breaks'] or 'nothing'}"
            )
    return _report(result, len(result.rows), drawn, quiet)


def _shown(
    run: Callable[[Callable[[CellRow | CellBranchRow], None]], CellRun],
    quiet: bool,
    **options: Any,
) -> CellRun:
    """Carry out a run that is shown its rows, in a progress bar."""
    if quiet:
        return run(lambda row: None)
    from tqdm import tqdm

    with tqdm(dynamic_ncols=True, disable=None, **options) as bar:

        def show(row: CellRow) -> None:
            bar.set_postfix_str(
                f"{row.load_name.text} {row.load:g}, perimeter {row.perimeter:.4g}, "
                f"traction {row.traction:.4g}"
            )
            bar.update()

        return run(show)


def _drawn(folder: Path, pictures: bool, name: str) -> list[str]:
    if not pictures:
        return []
    from eulerplateau.pictures import draw_branches, draw_diagram

    draw = draw_diagram if name == "diagram.png" else draw_branches
    return [name] if draw(folder) else []


def _report(result: CellRun, wanted: int, drawn: list[str], quiet: bool) -> int:
    """Say what a run came to, failures in any case; return the exit code."""
    for status in dict.fromkeys(row.status for row in result.failures):
        rows = [row for row in result.failures if row.status is status]
        loads = ", ".join(f"{row.load:g}" for row in rows[:3])
        more = f" and {len(rows) - 3} more" if len(rows) > 3 else ""
        click.echo(
            f"eulerplateau: {result.folder}: {rows[0].load_name.text} {loads}{more} "
            f"{status.value}: {status.advice}",
            err=True,
        )
    if not quiet:
        before(result.folder, result.before)
        good = len(result.rows) - len(result.failures)
        click.echo(
            f"{result.folder}: {good} of {wanted} shapes converged in "
            f"{result.seconds:.1f} s: {', '.join(drawn)}"
        )
    return NOT_CONVERGED_EXIT_CODE if result.failures else 0
