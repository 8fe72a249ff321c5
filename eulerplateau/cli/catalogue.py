"""`eulerplateau catalogue`: how many equilibria there are."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from eulerplateau.cli.batch import OVERWRITE, QUIET, before, begin
from eulerplateau.cli.options import writes_to
from eulerplateau.cli.overrides import load_single, setting, single_values

if TYPE_CHECKING:
    from eulerplateau.runs import Catalogue, RunSpec


@click.command()
@click.argument("spec", metavar="RUN.toml", type=click.Path(path_type=Path))
@writes_to(
    "The folder to write to. Default: beside RUN.toml, with its name, what is set and "
    "-catalogue.",
)
@setting("catalogue.starts=50")
@click.option(
    "--pictures/--no-pictures", default=True, help="Draw catalogue.png (default)."
)
@OVERWRITE
@QUIET
def catalogue(
    spec: Path,
    out: Path | None,
    settings: tuple[str, ...],
    pictures: bool,
    overwrite: bool,
    quiet: bool,
) -> int:
    """List the distinct equilibria of RUN.toml, stable or not, at each of its loads.

    They are sought from random starts, and by deflation: Newton's method with all that is
    known divided out. Writes catalogue.csv (one row per equilibrium), counts.csv (how many
    were known after each search), shapes/*.vtp, catalogue.pvd, run.json, catalogue.png.
    """
    from eulerplateau.runs import load_run, run_name

    run = load_single(spec, settings, load_run)
    folder = out or spec.with_name(f"{run_name(spec, single_values(settings))}-catalogue")
    begin(folder)
    result = _listed(run, folder, quiet, overwrite)
    drawn = ["catalogue.csv", "counts.csv", "catalogue.pvd"]
    if pictures and result.rows:
        from eulerplateau.pictures import draw_catalogue

        if draw_catalogue(folder):
            drawn.append("catalogue.png")
    if not quiet:
        before(folder, result.before)
        _report(result, drawn)
    return 0


def _listed(run: RunSpec, folder: Path, quiet: bool, overwrite: bool) -> Catalogue:
    from eulerplateau.runs import run_catalogue

    if quiet:
        return run_catalogue(run, folder, overwrite=overwrite)
    from tqdm import tqdm

    with tqdm(desc=folder.name, unit="search", dynamic_ncols=True, disable=None) as bar:

        def show(load: float) -> None:
            bar.set_postfix_str(f"load {load:g}")
            bar.update()

        return run_catalogue(run, folder, show, overwrite=overwrite)


def _report(result: Catalogue, drawn: list[str]) -> None:
    for row in result.rows:
        click.echo(
            f"{row.load_name.text} = {row.load:g}, {row.number}: energy {row.energy:.6f}, "
            f"index {row.n_unstable}, {row.by_starts} starts, {row.by_deflation} by "
            f"deflation: {row.symmetry or 'no symmetry'}"
        )
    for last in {count["load"]: count for count in result.counts}.values():
        click.echo(
            f"load {last['load']:g}: {last['together']:.0f} equilibria, "
            f"{last['by_starts']:.0f} by {last['search']:.0f} starts, "
            f"{last['by_deflation']:.0f} by deflation from as many guesses"
        )
    click.echo(f"{result.folder}: {result.seconds:.1f} s: {', '.join(drawn)}")
