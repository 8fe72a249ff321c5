"""`eulerplateau cell shape`: one cell, by the boundary-value problem or as a polygon."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from eulerplateau.errors import NOT_CONVERGED_EXIT_CODE

if TYPE_CHECKING:
    from eulerplateau.cells import Sites

_DEFAULT_EDGES = 64


@click.command()
@click.option("--adhesions", type=int, help="So many on a regular polygon, 2 or more.")
@click.option(
    "--points",
    type=click.Path(path_type=Path),
    help="Or a file of their places: x,y[,stiffness] in units of R_0, one a line.",
)
@click.option("--sigma-hat", required=True, type=float, help="sigma R_0^3 / alpha.")
@click.option("--ks-hat", required=True, type=float, help="k_s R_0^3 / alpha.")
@click.option(
    "--beta-hat", default=0.0, show_default=True, help="beta R_0^2 / alpha, line tension."
)
@click.option(
    "--discrete",
    type=int,
    metavar="N",
    help="The cell as a polygon of N edges a side. Default with --points: 64.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in full precision.")
def shape(
    adhesions: int | None,
    points: Path | None,
    sigma_hat: float,
    ks_hat: float,
    beta_hat: float,
    discrete: int | None,
    as_json: bool,
) -> int:
    """Print the stable shape of one cell: lengths in R_0, energies in alpha / R_0.

    The traction is the force 2 k_s Delta of an adhesion on the substrate, in
    alpha / R_0^2. On regular adhesions it is the solution of the boundary-value problem;
    with --discrete or --points that of a polygon, and n_unstable its whole Morse index.
    """
    if (adhesions is None) == (points is None):
        raise click.UsageError("give one of --adhesions N and --points FILE")
    if points is None and discrete is None:
        numbers = _exact(adhesions or 0, sigma_hat, ks_hat, beta_hat)
    else:
        edges = _DEFAULT_EDGES if discrete is None else discrete
        sites = _sites(adhesions, points)
        numbers = _discrete(sites, edges, sigma_hat, ks_hat, beta_hat)
        numbers = _mean(numbers) if points is None else numbers
    _print(numbers, as_json)
    return 0 if numbers["status"] == "converged" else NOT_CONVERGED_EXIT_CODE


def _exact(adhesions: int, sigma: float, ks: float, beta: float) -> dict[str, Any]:
    from eulerplateau.exact.cell import CellStatus, regular_cell

    cell = regular_cell(adhesions, sigma, ks, beta)
    names = (
        "perimeter",
        "area",
        "kappa_adhesion",
        "kappa_mid",
        "extension",
        "traction",
        "energy",
    )
    numbers: dict[str, Any] = {name: getattr(cell, name) for name in names}
    if cell.status is not CellStatus.CONVERGED:
        numbers = dict.fromkeys(numbers)
    index = cell.n_unstable if cell.status is CellStatus.CONVERGED else None
    return {**numbers, "n_unstable": index, "status": cell.status.value}


def _sites(adhesions: int | None, points: Path | None) -> Sites:
    from eulerplateau.cells import read_sites, regular_sites

    return regular_sites(adhesions or 0) if points is None else read_sites(points)


def _discrete(
    sites: Sites, edges: int, sigma: float, ks: float, beta: float
) -> dict[str, Any]:
    from eulerplateau.cells import Cell, solve_cell

    found = solve_cell(Cell(sites, edges, beta), sigma, ks)
    return {
        "perimeter": found.perimeter,
        "area": found.area,
        "kappa_adhesion": found.kappa_adhesion,
        "kappa_mid": found.kappa_mid,
        "extension": found.extensions,
        "traction": found.traction,
        "energy": found.energy,
        "n_unstable": found.n_unstable,
        "status": found.status.value,
    }


def _mean(numbers: dict[str, Any]) -> dict[str, Any]:
    """Return one value for the adhesions of a regular polygon, which are all alike."""
    return {
        name: float(value.mean()) if hasattr(value, "mean") else value
        for name, value in numbers.items()
    }


def _print(numbers: dict[str, Any], as_json: bool) -> None:
    """Print numbers, one value for each adhesion or side where these differ."""
    plain = {
        name: value.tolist() if hasattr(value, "tolist") else value
        for name, value in numbers.items()
    }
    if as_json:
        click.echo(json.dumps(plain, indent=2))
        return
    for name, value in plain.items():
        values = value if isinstance(value, list) else [value]
        shown = (f"{v:.12g}" if isinstance(v, float) else str(v) for v in values)
        click.echo(f"{name:14}  {', '.join(shown)}")
