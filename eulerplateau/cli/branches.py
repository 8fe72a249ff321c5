"""`eulerplateau branches`: the whole bifurcation diagram of one run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from eulerplateau.cli.batch import GOES_ON, OVERWRITE, QUIET, before, begin
from eulerplateau.cli.options import writes_to
from eulerplateau.cli.overrides import load_single, setting, single_values
from eulerplateau.compiling import telling_of_compiling
from eulerplateau.errors import NOT_CONVERGED_EXIT_CODE

if TYPE_CHECKING:
    from eulerplateau.runs import BranchRow, Exploration, RunSpec


@click.command()
@click.argument("spec", metavar="RUN.toml", type=click.Path(path_type=Path))
@writes_to(
    "The folder to write to. Default: beside RUN.toml, with its name, what is set and "
    "-branches.",
)
@setting("branches.special_points=3")
@click.option("--pictures/--no-pictures", default=True, help="Draw branches.png (default).")
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
    """Follow the branches of equilibria of RUN.toml, stable and unstable, through folds.

    Writes branches.csv (one row per point), special_points.csv (folds and bifurcations,
    their loads located by an eigenvalue's crossing, and where strands of a loop with a
    diameter touch, part or split), shapes/*.vtp with the critical
    modes, branches.pvd (for ParaView), run.json, branches.png.
    """
    begin(out)
    from eulerplateau.runs import load_run, run_name

    run = load_single(spec, settings, load_run)
    name = run_name(spec, single_values(settings))
    folder = out or spec.with_name(f"{name}-branches")
    begin(folder)
    result = _explore(run, folder, quiet, overwrite)
    drawn = ["branches.csv", "special_points.csv", "branches.pvd"]
    if pictures:
        from eulerplateau.pictures import draw_branches

        if draw_branches(folder):
            drawn.append("branches.png")
    if not quiet:
        before(folder, result.before)
        _report(result, drawn)
    if not result.unresolved:
        return 0
    statuses = [row.status for row in result.rows if not row.converged]
    for status in dict.fromkeys(statuses):
        share = f"{statuses.count(status)} of {len(result.rows)} points"
        line = f"eulerplateau: {folder}: {share} {status.value}: {status.advice}"
        click.echo(line, err=True)
    return NOT_CONVERGED_EXIT_CODE


def _explore(run: RunSpec, folder: Path, quiet: bool, overwrite: bool) -> Exploration:
    from eulerplateau.runs import run_branches

    if quiet:
        return run_branches(run, folder, overwrite=overwrite)
    from tqdm import tqdm

    with tqdm(desc=folder.name, unit="point", dynamic_ncols=True, disable=None) as bar:

        def show(row: BranchRow) -> None:
            bar.set_postfix_str(
                f"branch {row.branch}, {row.load_name.text} {row.load:g}, "
                f"<|kappa_n|> {row.abs_kappa_n:.3g}, {row.n_unstable} unstable"
            )
            bar.update()

        with telling_of_compiling(bar.set_postfix_str):
            return run_branches(run, folder, show, overwrite=overwrite)


def _report(result: Exploration, drawn: list[str]) -> None:
    from eulerplateau.branches import multiple

    load = result.rows[0].load_name
    for point in result.special:
        times = multiple(int(point["multiplicity"]))
        what = f" ({point['contact']})" if point.get("contact") else ""
        place, error = (
            load.shown(float(point[name])) for name in (load.column, f"{load.column}_error")
        )
        click.echo(
            f"{point['kind']} {point['number']}{times}{what} at {load.text} = "
            f"{place:.8g} +- {error:.1g} on branch {point['branch']}, "
            f"breaks: {point['breaks'] or 'nothing'}"
        )
    number = 1 + max(row.branch for row in result.rows)
    click.echo(
        f"{result.folder}: {number} branches, {len(result.rows)} points in "
        f"{result.seconds:.1f} s: {', '.join(drawn)}"
    )
