"""`eulerplateau cell fit`: contractility and bending rigidity from measured areas."""

from __future__ import annotations

import json
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eulerplateau.cli.options import FIGURES, writes_to

if TYPE_CHECKING:
    from eulerplateau.cli.area_table import AreaTable
    from eulerplateau.exact.cell import AreaFit, Estimate

# What the command line calls the arguments of `fit_areas`.
_OPTIONS = {name: f"--{name.replace('_', '-')}" for name in ("rest_radius", "level")}
_PARAMETERS = ("sigma", "alpha", "rest_radius")


@click.command()
@click.argument("data", metavar="DATA.csv", type=click.Path(path_type=Path))
@click.option(
    "--rest-radius", type=float, help="The radius R0 on a rigid substrate, if it is known."
)
@click.option(
    "--level", type=float, default=0.95, show_default=True, help="Of the intervals."
)
@click.option(
    "--relative",
    is_flag=True,
    help="Without errors: the noise is a share of each area, not the same for all.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in full precision.")
@writes_to(
    "Also draw the data and the fit: .png, .pdf or .svg.",
)
def fit(
    data: Path,
    rest_radius: float | None,
    level: float,
    relative: bool,
    as_json: bool,
    out: Path | None,
) -> None:
    """Fit contractility sigma, bending rigidity alpha and rest radius R0 to cell areas.

    DATA.csv has a line for each substrate: stiffness, projected area and, if known, the
    area's standard deviation; in this order, or in columns named stiffness, area and error
    in a first line. What follows a # is a comment.

    Units are those of the data: areas in um^2 and stiffnesses in nN/um give sigma in nN/um,
    alpha in nN um^2 and R0 in um. xi = (alpha / sigma)^(1/3) is the radius on the softest
    substrates.
    """
    from eulerplateau.cli.area_table import read_areas
    from eulerplateau.errors import OutputError, SpecError
    from eulerplateau.exact.cell import fit_areas

    if out is not None and out.suffix.lower() not in FIGURES:
        raise click.BadParameter(f"{out}: should end in {', '.join(FIGURES)}")
    table = read_areas(data)
    if relative and table.error is not None:
        raise SpecError("--relative", f"{data} has errors; leave one of them out")
    try:
        found = fit_areas(
            table.stiffness, table.area, table.error, rest_radius, level, relative=relative
        )
    except SpecError as error:
        key, problem = error.args
        raise SpecError(_OPTIONS.get(key, str(data)), problem) from None
    if as_json:
        click.echo(json.dumps(_numbers(found, table), indent=2))
    else:
        click.echo("\n".join(_lines(found, table, rest_radius is None)))
    if out is not None:
        from eulerplateau.pictures import draw_area_fit

        if not draw_area_fit(table.stiffness, table.area, table.error, found, out):
            raise OutputError(out, "the figure could not be drawn there")


def _numbers(fit: AreaFit, table: AreaTable) -> dict[str, Any]:
    """Return what is printed as JSON, which knows no infinity: null stands for it."""

    def finite(number: float) -> float | None:
        return number if isfinite(number) else None

    def interval(estimate: Estimate) -> dict[str, float | None]:
        names = ("value", "low", "high")
        return {name: finite(getattr(estimate, name)) for name in names}

    return {
        **{name: interval(getattr(fit, name)) for name in _PARAMETERS},
        "xi": finite(fit.xi),
        "level": fit.level,
        "noise": {"kind": _noise(fit), "value": fit.noise},
        "chi2": fit.chi2,
        "dof": fit.dof,
        "points": len(table.area),
    }


def _noise(fit: AreaFit) -> str:
    if fit.noise is None:
        return "given"
    return "relative" if fit.relative else "constant"


def _lines(fit: AreaFit, table: AreaTable, radius_fitted: bool) -> list[str]:
    """Return the lines that are printed."""
    lines = [f"{'':11}  {'value':>10}  {100 * fit.level:g} % interval"]
    for name in _PARAMETERS:
        found: Estimate = getattr(fit, name)
        interval = f"{found.low:.5g} to {found.high:.5g}"
        if name == "rest_radius" and not radius_fitted:
            interval = "given"
        lines.append(f"{name:11}  {found.value:10.5g}  {interval}")
    lines.append(f"{'xi':11}  {fit.xi:10.5g}  the radius on the softest substrates")
    if fit.noise is not None:
        of = "of each area" if fit.relative else "of an area"
        lines.append(f"{'noise':11}  {fit.noise:10.5g}  {of}, estimated from the residuals")
    if fit.chi2 is not None and fit.dof > 0:
        share = f"{fit.chi2 / fit.dof:10.5g}  {fit.chi2:.5g} over {fit.dof}"
        lines.append(f"{'chi2/dof':11}  {share}")
    lines.append(f"{'points':11}  {len(table.area):10d}  {fit.dof} degrees of freedom")
    return lines
