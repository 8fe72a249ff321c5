"""`eulerplateau plot`: figures for print of one run, or of several compared."""

from __future__ import annotations

from pathlib import Path

import click

from eulerplateau.cli.options import FIGURES, writes_to

_WHAT = ("diagram", "energy", "curvature", "eigenvalue", "contact", "onset")


@click.command()
@click.argument(
    "folders", metavar="DIR...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@writes_to(
    "The file to draw: .png, .pdf or .svg.",
    default=Path("plot.png"),
    show_default=True,
)
@click.option("--what", type=click.Choice(_WHAT), default="diagram", show_default=True)
@click.option("--quiet", is_flag=True, help="Print nothing but errors.")
def plot(folders: tuple[Path, ...], out: Path, what: str, quiet: bool) -> None:
    """Plot the run folders DIR, of sweeps or branches, together.

    Over the load: `diagram` the loop's total normal curvature, of a cell its perimeter and
    traction, with the shapes; `energy`; `curvature`, the film's total Gauss curvature, of a
    cell the least curvature half-way along its sides; `eigenvalue`, the smallest one of the
    second variation; `contact`, of a loop with a diameter, the force with which strands
    push and the angle at which they cross. `onset`, of films only, fits the exponents with
    which a film leaves its plane: it needs a dozen loads within 2 % above, as
    runs/onset.toml has them.
    """
    from eulerplateau.errors import OutputError
    from eulerplateau.pictures import check_plot, draw_comparison, fit_onset
    from eulerplateau.runs import read_runs

    if out.suffix.lower() not in FIGURES:
        raise click.BadParameter(f"{out}: should end in {', '.join(FIGURES)}")
    runs = read_runs(folders)
    check_plot(runs, what)
    if what == "onset":
        # First, so that what is wrong with a folder is an error that names it.
        for run in runs:
            fit_onset(run)
    if not draw_comparison(runs, what, out):
        raise OutputError(out, "the figure could not be drawn there")
    if not quiet:
        click.echo(str(out))
