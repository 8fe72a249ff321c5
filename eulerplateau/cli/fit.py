"""`eulerplateau fit`: load, size and surface tension of a film from its outline."""

from __future__ import annotations

import json
from collections.abc import Iterator
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eulerplateau.cli.bench_options import line_options, quantity, rigidity
from eulerplateau.cli.options import FIGURES, writes_to

if TYPE_CHECKING:
    from eulerplateau.exact import Estimate, OutlineFit

_SURFACE_TENSION = "mN/m"
# What the command line calls the arguments of the fits.
_OPTIONS = {"lobes": "--lobes", "level": "--level"}


@click.command()
@click.argument("outline", metavar="OUTLINE.csv", type=click.Path(path_type=Path))
@click.option("-n", "--lobes", type=int, help="Their number; by default the likeliest.")
@click.option("--racket", is_flag=True, help="The outline is that of a racket's head.")
@click.option(
    "--edge",
    type=click.Choice(["centre", "outer"]),
    default="centre",
    show_default=True,
    help="Whether the points lie on the line's centre or on its outer edge.",
)
@line_options
@click.option("--unit", help="Of the points: mm. Surface tensions and edges need it.")
@click.option(
    "--level", type=float, default=0.95, show_default=True, help="Of the intervals."
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in full precision.")
@writes_to("Also draw the outline and the fit: .png, .pdf or .svg.")
def fit(
    outline: Path,
    lobes: int | None,
    racket: bool,
    edge: str,
    young: str | None,
    diameter: str | None,
    bending_rigidity: str | None,
    unit: str | None,
    level: float,
    as_json: bool,
    out: Path | None,
) -> None:
    """Fit a planar film to the points of its outline.

    OUTLINE.csv has a line for each point, x and y, in their order round the loop: in any
    unit, place and orientation, evenly spaced or not. Printed are the number of lobes,
    sigma_hat = sigma L^3 / alpha and the length L with intervals that allow for noise that
    is alike along the outline; with the line's rigidity and --unit the liquid's surface
    tension. A circle yields an upper bound.

    With --racket the points run along one strand, round the head, and back along the
    other; the size is (EI / sigma)^(1/3).
    """
    from eulerplateau.cli.point_table import read_points
    from eulerplateau.errors import OutputError, SpecError
    from eulerplateau.exact import fit_outline, fit_racket
    from eulerplateau.threads import one_thread

    if out is not None and out.suffix.lower() not in FIGURES:
        raise SpecError("--out", f"found {out}; should end in {', '.join(FIGURES)}")
    if racket and lobes is not None:
        raise SpecError("--lobes", "is for films; a racket has none: leave it out")
    stiffness = rigidity(young, diameter, bending_rigidity)
    metres = _metres(unit, edge == "outer" or stiffness is not None)
    wide = _width(edge, diameter, metres)
    points = read_points(outline)
    try:
        with one_thread():
            if racket:
                found = fit_racket(points, wide, level)
                nearer = found.is_misfit and found.is_farther_than(
                    fit_outline(points, None, wide, level)
                )
            else:
                found = fit_outline(points, lobes, wide, level)
                nearer = found.is_farther_than(fit_racket(points, wide, level))
    except SpecError as error:
        key, problem = error.args
        raise SpecError(_OPTIONS.get(key, str(outline)), problem) from None
    factor = None if stiffness is None else stiffness / 4 / metres**3
    if as_json:
        numbers = _numbers(found, factor, racket)
        numbers["misfit"] = nearer or found.is_misfit
        click.echo(json.dumps(numbers, indent=2))
    else:
        click.echo("\n".join(_lines(found, factor, racket, unit or "")))
        if nearer or found.is_misfit:
            click.echo(_doubt(racket, nearer))
    if out is not None:
        from eulerplateau.pictures import draw_outline_fit

        if not draw_outline_fit(points, found, unit or "", out):
            raise OutputError(out, "the figure could not be drawn there")


def _metres(unit: str | None, needed: bool) -> float:
    """Return what the points' unit is in metres; raises SpecError."""
    from eulerplateau.errors import SpecError
    from eulerplateau.units import LENGTH

    if unit is None:
        if needed:
            raise SpecError("--unit", "is missing, as mm: that of the points")
        return 1.0
    try:
        return LENGTH.factor(unit)
    except ValueError:
        raise SpecError("--unit", f"found {unit!r}; should be a length, as mm") from None


def _width(edge: str, diameter: str | None, metres: float) -> float | None:
    """Return the line's diameter in the unit of the points, where they lie on its edge."""
    from eulerplateau.errors import SpecError
    from eulerplateau.units import DIAMETER

    if edge == "centre":
        return None
    if diameter is None:
        raise SpecError("--edge", f'outer needs --diameter, as "{DIAMETER.example}"')
    return quantity("--diameter", diameter, DIAMETER).value / metres


def _numbers(fit: OutlineFit, factor: float | None, racket: bool) -> dict[str, Any]:
    """Return what is printed as JSON, which knows no infinity: null stands for it."""
    size = "elastocapillary_length" if racket else "length"
    return {
        "lobes": fit.lobes,
        "circle": fit.is_circle,
        "sigma_hat": fit.sigma_hat and _interval(fit.sigma_hat),
        size: _interval(fit.size),
        "surface_tension": factor and _interval(fit.strength, factor),
        "level": fit.level,
        "noise": {
            "deviation": fit.noise.deviation,
            "correlated": fit.noise.correlated,
            "correlation_length": fit.noise.length,
        },
        "points": len(fit.distances),
    }


def _interval(estimate: Estimate, factor: float = 1.0) -> dict[str, float | None]:
    numbers = {name: factor * getattr(estimate, name) for name in ("value", "low", "high")}
    return {name: value if isfinite(value) else None for name, value in numbers.items()}


def _lines(fit: OutlineFit, factor: float | None, racket: bool, unit: str) -> Iterator[str]:
    """Yield the lines that are printed."""
    from eulerplateau.units import SURFACE_TENSION

    yield f"{'':15}  {'value':>10}  {100 * fit.level:g} % interval"
    if fit.lobes is not None:
        yield f"{'lobes':15}  {fit.lobes:10d}"
    if fit.sigma_hat is not None:
        yield _line("sigma_hat", fit.sigma_hat, 1.0, "")
    yield _line("(EI/sigma)^(1/3)" if racket else "length", fit.size, 1.0, unit)
    if factor is not None:
        scale = factor / SURFACE_TENSION.factor(_SURFACE_TENSION)
        yield _line("surface tension", fit.strength, scale, _SURFACE_TENSION)
    noise = fit.noise
    alike = ""
    if fit.is_exact:
        alike = ", rounding only"
    elif noise.correlated > 0:
        alike = f", {100 * noise.correlated:.0f} % of it alike over {noise.length:.3g}"
    yield f"{'noise':15}  {noise.deviation:10.4g}  of a point{alike}"
    yield f"{'points':15}  {len(fit.distances):10d}"
    if fit.is_circle:
        yield "The outline cannot be told from a circle: its load has an upper bound only."


def _doubt(racket: bool, nearer: bool) -> str:
    """Return what is said of points that are those of another curve."""
    if nearer and racket:
        return "The points are much nearer to a film: leave out --racket."
    if nearer:
        return "The points are much nearer to a racket's head: try --racket."
    if racket:
        return "What is left is no noise: the points are hardly those of a racket's head."
    return (
        "What is left is no noise: the points are hardly those of a film. "
        "Try --edge, --racket, or another -n."
    )


def _line(name: str, estimate: Estimate, factor: float, unit: str) -> str:
    value, low, high = (
        factor * end for end in (estimate.value, estimate.low, estimate.high)
    )
    if low == 0 and value == 0:
        return f"{name:15}  {'':10}  at most {high:.5g} {unit}".rstrip()
    return f"{name:15}  {value:10.5g}  {low:.5g} to {high:.5g} {unit}".rstrip()
