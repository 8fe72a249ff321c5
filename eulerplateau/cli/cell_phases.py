"""`eulerplateau cell phase-diagram`: which shape, over contractility and stiffness."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eulerplateau.cli.batch import QUIET
from eulerplateau.cli.options import writes_to
from eulerplateau.cli.overrides import load_single, setting, single_values

if TYPE_CHECKING:
    from eulerplateau.runs import PhaseDiagram


@click.command("phase-diagram")
@click.argument("spec", metavar="RUN.toml", type=click.Path(path_type=Path))
@writes_to(
    "The folder to write to. Default: beside RUN.toml, with its name and -phases.",
)
@setting("cell.adhesions=4", "CellRunSpec")
@click.option("--pictures/--no-pictures", default=True, help="Draw it (default).")
@QUIET
def phase_diagram(
    spec: Path, out: Path | None, settings: tuple[str, ...], pictures: bool, quiet: bool
) -> None:
    """Locate the lines between the shapes of a regular cell, and solve for one in each.

    Writes lines.csv (where sides become inflected, where the cell loses its symmetry, the
    fold of its regular shapes), points.csv, sweep.csv and shapes/*.vtp (a shape in the
    middle of each region), run.json, phase-diagram.png.
    """
    from eulerplateau.runs import load_cell_run, run_name

    run = load_single(spec, settings, load_cell_run)
    name = run_name(spec, single_values(settings))
    folder = out or spec.with_name(f"{name}-phases")
    result = _computed(run, folder, quiet)
    drawn = ["lines.csv", "points.csv", "sweep.csv"]
    if pictures:
        from eulerplateau.pictures import PHASE_DIAGRAM, draw_phase_diagram

        if draw_phase_diagram(result):
            drawn.append(PHASE_DIAGRAM)
    if not quiet:
        for name, (sigma, ks) in result.points.items():
            click.echo(f"{name}: sigma_hat = {sigma:.8g}, ks_hat = {ks:.8g}")
        if result.sigma_p is not None:
            click.echo(f"star without protrusion: sigma_hat = {result.sigma_p:.8g}")
        click.echo(f"{folder}: {result.seconds:.1f} s: {', '.join(drawn)}")


def _computed(run: Any, folder: Path, quiet: bool) -> PhaseDiagram:
    from eulerplateau.runs import run_phase_diagram

    if quiet:
        return run_phase_diagram(run, folder)
    from tqdm import tqdm

    with tqdm(desc=folder.name, unit="point", dynamic_ncols=True, disable=None) as bar:

        def show(point: str) -> None:
            bar.set_postfix_str(point)
            bar.update()

        return run_phase_diagram(run, folder, show)
