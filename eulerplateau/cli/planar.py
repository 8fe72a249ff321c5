"""`eulerplateau planar`: exact planar films, as a table, a line of numbers, or figures."""

from __future__ import annotations

import json
from pathlib import Path

import click

from eulerplateau.cli.options import writes_to
from eulerplateau.cli.refused import refusals_as_json

_JSON = click.option(
    "--json", "as_json", is_flag=True, help="Print JSON, in full precision."
)
_DIAMETER = click.option(
    "--diameter",
    type=float,
    help="The loop's diameter in L, above 0 and at most 0.1; by default none.",
)
# What the command line calls the arguments of `planar_film`.
_OPTIONS = {"lobes": "n", "tension": "sigma_hat"}


@click.group()
def planar() -> None:
    """Exact planar films, by elliptic functions: loads are sigma L^3 / alpha."""


@planar.command()
@_DIAMETER
@_JSON
def table(diameter: float | None, as_json: bool) -> None:
    """Print where n-lobed films buckle, touch in a point, and touch along a line.

    With a diameter "-", in JSON null, stands where the curvature would exceed 2/d there.
    """
    from dataclasses import asdict
    from math import isfinite

    from eulerplateau.exact.planar import LOBES, thresholds

    films = [asdict(thresholds(n, diameter)) for n in LOBES]
    rows = [{"n": film.pop("lobes"), **film} for film in films]
    if as_json:
        rows = [{k: v if isfinite(v) else None for k, v in row.items()} for row in rows]
        click.echo(json.dumps(rows, indent=2))
        return
    click.echo(f"{'n':>2} {'buckling':>18} {'point contact':>18} {'line contact':>18}")
    for n, *loads in (row.values() for row in rows):
        shown = (f"{load:.10f}" if isfinite(load) else "-" for load in loads)
        click.echo(f"{n:2d} " + " ".join(f"{load:>18}" for load in shown))


@planar.command()
@click.option(
    "-n", "--n", "lobes", required=True, type=int, help="Number of lobes, 2 to 12."
)
@click.option("--sigma-hat", required=True, type=float, help="The load sigma L^3 / alpha.")
@_DIAMETER
@_JSON
def shape(lobes: int, sigma_hat: float, diameter: float | None, as_json: bool) -> None:
    """Print energy (in alpha/L), area, curvatures and regime of one film (L = 1).

    Regimes: disk (up to the buckling threshold), buckled, point-contact, line-contact.

    With a diameter: free, point, line; also the contacts' force, their sum in alpha/L^2,
    and the length of each lobe's line. Ends with 4 where the curvature would exceed 2/d.
    """
    from eulerplateau.errors import SpecError
    from eulerplateau.exact.planar import planar_film

    names = ["energy", "area", "kappa_max", "kappa_min", "beta_hat"]
    if diameter is not None:
        names += ["contact_force", "contact_length"]
    try:
        with refusals_as_json(as_json, [*names, "regime"]):
            film = planar_film(lobes, sigma_hat, diameter)
    except SpecError as error:
        key, problem = error.args
        raise SpecError(_OPTIONS.get(key, key), problem) from None
    regime = film.regime.value if diameter is None else film.regime.contact
    numbers = {name: getattr(film, name) for name in names}
    if as_json:
        click.echo(json.dumps({**numbers, "regime": regime}, indent=2))
        return
    width = max(map(len, names))
    for name, value in numbers.items():
        click.echo(f"{name:{width}}  {value:.15g}")
    click.echo(f"{'regime':{width}}  {regime}")


@planar.command()
@writes_to(
    "The folder to write planar-gallery.png and planar-energy.png to.",
    required=True,
)
@click.option("--quiet", is_flag=True, help="Print nothing but errors.")
def figures(out: Path, quiet: bool) -> None:
    """Draw the gallery of shapes (n = 2 ... 5) and the energies (n = 2, 3)."""
    from eulerplateau.errors import OutputError
    from eulerplateau.pictures import ENERGY, GALLERY, draw_figures

    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(out, f"cannot be made: {error.strerror}") from None
    if not draw_figures(out):
        raise OutputError(out, "the figures could not be drawn there")
    if not quiet:
        click.echo(f"{out}: {GALLERY}, {ENERGY}")
