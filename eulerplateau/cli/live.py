"""`eulerplateau live`: a film in the browser that follows as one drags its load."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import click

from eulerplateau.cli.batch import begin
from eulerplateau.cli.options import writes_to
from eulerplateau.cli.overrides import load_single, setting, single_values
from eulerplateau.compiling import telling_of_compiling
from eulerplateau.interruption import working_on

# Seconds after the last page has closed.
_IDLE = 60.0


@click.command()
@click.argument("spec", metavar="RUN.toml", type=click.Path(path_type=Path))
@writes_to(
    "The run folder that shapes are saved into. Default: beside RUN.toml, with its name "
    "and what is set.",
)
@setting("sweep.loads=[1,3000]")
@click.option("--browser/--no-browser", default=True, help="Open a browser (default).")
@click.option("--idle", type=click.FloatRange(min=0), default=_IDLE, hidden=True)
def live(
    spec: Path, out: Path | None, settings: tuple[str, ...], browser: bool, idle: float
) -> None:
    """Show the film of RUN.toml in the browser, to be dragged through its loads.

    A slider goes over the loads of the sweep, or what else it varies, others over link and
    diameter where the run has them; the film follows, and the diagram fills with the
    points visited. Only this machine is answered, at the address that is printed. Ends with
    Ctrl-C, or 60 s after the last page has closed. Shapes that are saved go into live/ of
    the run folder. Needs: pip install 'eulerplateau[live]'.
    """
    begin(out)
    from eulerplateau.live import Pages, Service, Worker, check_aiohttp, serve
    from eulerplateau.runs import LiveFilm, load_run, run_name

    check_aiohttp()
    run = load_single(spec, settings, load_run)
    folder = out or spec.with_name(run_name(spec, single_values(settings)))
    saved: list[Path] = []

    def save() -> str:
        saved.append(film.save(folder))
        return f"Saved as {saved[-1]}"

    working_on(lambda: f"{folder}: {len(saved)} shapes were saved")
    once = cache(lambda said: click.echo(f"eulerplateau: {said}", err=True))
    with telling_of_compiling(once):
        film = LiveFilm(run)
    pages = Pages(folder.name, film.varied, film.at)
    serve(Service(pages, Worker(film, save), idle, browser, click.echo))
    click.echo(f"{folder}: no page is open, so this ends; {len(saved)} shapes were saved")
