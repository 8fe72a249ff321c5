"""`eulerplateau locus`: a curve of folds or bifurcations in two parameters."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eulerplateau.cli.batch import OVERWRITE, QUIET, begin
from eulerplateau.cli.options import writes_to
from eulerplateau.cli.overrides import load_single, setting, single_values
from eulerplateau.compiling import telling_of_compiling

if TYPE_CHECKING:
    from eulerplateau.runs import Asked, Locus, RunSpec

_WITH = {
    "load": "load",
    "loop.link": "link",
    "loop.twist_ratio": "twist_ratio",
    "loop.rest_curvature": "rest_curvature",
}


@click.command()
@click.argument("spec", metavar="RUN.toml", type=click.Path(path_type=Path))
@click.option(
    "--point", type=int, required=True, help="Number of the special point to start from."
)
@click.option(
    "--with",
    "second",
    type=click.Choice(list(_WITH)),
    required=True,
    help="The second parameter.",
)
@click.option(
    "--from", "low", type=float, help="Where the second parameter's window begins."
)
@click.option("--to", "high", type=float, help="Where it ends.")
@click.option(
    "--branches",
    "run",
    type=click.Path(path_type=Path),
    help="The folder of the run's branches. Default: where `branches` writes them.",
)
@writes_to(
    "The folder to write to. Default: beside RUN.toml, with its name, -locus and what "
    "is asked for.",
)
@setting("branches.special_points=3")
@click.option("--pictures/--no-pictures", default=True, help="Draw locus.png (default).")
@OVERWRITE
@QUIET
def locus(
    spec: Path,
    point: int,
    second: str,
    low: float | None,
    high: float | None,
    run: Path | None,
    out: Path | None,
    settings: tuple[str, ...],
    pictures: bool,
    overwrite: bool,
    quiet: bool,
) -> None:
    """Follow a fold or a bifurcation of RUN.toml's branches in a second parameter.

    Writes locus.csv (one row per point, special ones among them) and locus.png. A
    bifurcation whose symmetry the second parameter breaks leaves a fold, which is followed.
    """
    begin(out)
    from eulerplateau.runs import Asked, load_run, run_name

    specified = load_single(spec, settings, load_run)
    name = run_name(spec, single_values(settings))
    folder = out or spec.with_name(f"{name}-locus-{point}-{_WITH[second]}")
    begin(folder)
    explored = run or spec.with_name(f"{name}-branches")
    asked = Asked(explored, point, _WITH[second], low, high)
    result = _followed(specified, asked, folder, quiet, overwrite)
    drawn = ["locus.csv"]
    if pictures:
        from eulerplateau.pictures import draw_locus

        if draw_locus(result):
            drawn.append("locus.png")
    if not quiet:
        _report(result, drawn)


def _followed(
    spec: RunSpec, asked: Asked, folder: Path, quiet: bool, overwrite: bool
) -> Locus:
    from eulerplateau.runs import run_locus

    if quiet:
        return run_locus(spec, asked, folder, overwrite=overwrite)
    from tqdm import tqdm

    with tqdm(desc=folder.name, unit="point", dynamic_ncols=True, disable=None) as bar:

        def show(row: dict[str, Any]) -> None:
            first, second = list(row)[:2]
            bar.set_postfix_str(
                f"{first} {row[first]:g}, {second} {row[second]:g}, "
                f"{row['n_unstable']} unstable beside"
            )
            bar.update()

        with telling_of_compiling(bar.set_postfix_str):
            return run_locus(spec, asked, folder, show, overwrite=overwrite)


def _report(result: Locus, drawn: list[str]) -> None:
    start = result.rows[0]
    first, second = result.names
    symmetry = ", ".join(result.breaks)
    if start["special"] == "cusp":
        needs = f"{second.text} breaks what the bifurcation needs ({symmetry})"
        click.echo(f"{needs}: followed is the fold that it leaves")
    for row in result.rows:
        what = row["end"] or (row["special"] if row["arclength"] else "")
        if what == "symmetry is lost" and symmetry:
            what += f": the mesh breaks what the bifurcation needs ({symmetry})"
        if what:
            click.echo(
                f"{what} at {first.text} = {row[first.column]:.8g}, "
                f"{second.text} = {row[second.column]:.8g}"
            )
    click.echo(
        f"{result.folder}: {len(result.rows)} points of a curve of {start['kind']}s in "
        f"{result.seconds:.1f} s: {', '.join(drawn)}"
    )
