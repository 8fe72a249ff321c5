"""`eulerplateau render`: pictures and animations of the shapes of a run."""

from __future__ import annotations

from pathlib import Path

import click

from eulerplateau.cli.options import offered, writes_to
from eulerplateau.errors import OutputError, SpecError

_OF_LOOP = "kappa", "kappa_n", "kappa_g", "contact_angle"


@click.command()
@click.argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@click.option(
    "--step", "steps", type=int, multiple=True, help="Show this step; may be repeated."
)
@click.option(
    "--load",
    "loads",
    type=float,
    multiple=True,
    help="Show the shape nearest to this load (kL^3/alpha of springs, sigma_hat of other "
    "films, what is varied of cells) on each branch that reaches it; may be repeated.",
)
@click.option("--all", "everything", is_flag=True, help="Show every shape.")
@click.option(
    "--colour",
    shell_complete=offered("sides", "soap", "angle_defect", *_OF_LOOP),
    help="sides (front blue, back orange; of films by default), soap (the same, "
    "translucent), or a field of the shape files: angle_defect inside; kappa (of cells by "
    "default), kappa_n, kappa_g, contact_angle on the loop.",
)
@click.option(
    "--animate",
    type=click.Choice(["turn", "sweep"]),
    help="Instead of pictures, an animation of each shape turning, or one of the sweep "
    "(of every shape, if none is chosen).",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(["gif", "mp4"]),
    default="gif",
    show_default=True,
    help="Of animations; MP4 needs eulerplateau[mp4].",
)
@writes_to("The folder that pictures are written into. Default: DIR/pictures.")
@click.option("--quiet", is_flag=True, help="No summary: for batches.")
def render(
    folder: Path,
    steps: tuple[int, ...],
    loads: tuple[float, ...],
    everything: bool,
    colour: str | None,
    animate: str | None,
    form: str,
    out: Path | None,
    quiet: bool,
) -> None:
    """Draw the shapes of the run folder DIR, of a sweep or of branches, to DIR/pictures.

    Without --step, --load or --all: one shape per distinct state. All pictures of a run
    have one scale, so that shapes can be compared, and one view, but that flat films are
    seen from above in pictures; several make a contact sheet too.
    """
    from eulerplateau.pictures.render import (
        GIF,
        SIDES,
        SOAP,
        STILLS,
        SWEEP,
        check_format,
        chosen_steps,
        draw_shapes,
        pictures_folder,
        read_field,
    )
    from eulerplateau.runs import read_run, shape_name

    if form != GIF and animate is None:
        raise SpecError("--format", f"{form} is of animations: add --animate turn or sweep")
    check_format(form)
    run = read_run(folder)
    if everything or (animate == SWEEP and not steps and not loads):
        chosen = [row.step for row in run.rows]
    else:
        chosen = chosen_steps(run, steps, loads)
    if colour not in (None, SIDES, SOAP):
        read_field(folder / shape_name(chosen[0]), colour)
    out = out or pictures_folder(folder)
    if not draw_shapes(folder, chosen, animate or STILLS, colour, form, out):
        raise OutputError(out, "the pictures could not all be drawn")
    if not quiet:
        click.echo(f"{out}: {len(chosen)} shape(s) drawn")
