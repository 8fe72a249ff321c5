"""Print how cells tend to arcs as alpha tends to 0.

Arcs meet at an adhesion at an angle of 2 psi, psi = pi / N + phi. Bending rounds it over a
length of about (alpha / beta)^(1/2), for which a tense edge pays

    2 (alpha beta)^(1/2) int (1 - cos u)^(1/2) du,  u from -psi to psi,

or 8 (2 alpha beta)^(1/2) (1 - cos(psi / 2)) at each adhesion. To first order that is the
whole difference of the energies, for the arcs are in equilibrium.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import click
import numpy as np

from eulerplateau.exact.cell import ArcCell, arc_cell, regular_cell
from scripts.studies.common import markdown_table

# N, sigma, k_s, beta, in one unit of force: sigma R_0^2, k_s R_0^2 and beta R_0.
CASES = ((3, 1.0, 5.0, 1.5), (4, 1.0, 20.0, 2.0), (6, 2.0, 10.0, 3.0))
RIGIDITIES = 10.0 ** -np.arange(1, 8)
_FITTED = 3


@dataclass(frozen=True)
class Errors:
    """Relative errors of arcs at a rigidity alpha / (beta R_0^2), and the law's."""

    rigidity: float
    energy: float
    perimeter: float
    extension: float
    law: float


@click.command()
def main() -> None:
    """Print the differences between cells and arcs over the rigidity, as Markdown."""
    head = ["N", "σR₀/β", "k_sR₀/β", "α/βR₀²", "energy", "over the law", "perimeter"]  # noqa: RUF001
    rows = [[*head, "extension"]]
    for n, sigma, stiffness, beta in CASES:
        arcs = arc_cell(n, sigma, stiffness, beta)
        found = [errors(arcs, sigma, stiffness, beta, float(a)) for a in RIGIDITIES]
        name = [str(n), f"{sigma / beta:.3g}", f"{stiffness / beta:.3g}"]
        for one in found:
            cells = [f"{one.rigidity:.0e}", f"{one.energy:.3e}"]
            cells += [f"{one.energy / one.law:.4f}", f"{one.perimeter:.3e}"]
            rows.append([*name, *cells, f"{one.extension:.3e}"])
        powers = [power(found, of) for of in ("energy", "perimeter", "extension")]
        cells = [f"{powers[0]:.3f}", "", *(f"{p:.3f}" for p in powers[1:])]
        rows.append([*name, f"power, last {_FITTED}", *cells])
    click.echo(markdown_table(rows, words=0))


def errors(
    arcs: ArcCell, sigma: float, stiffness: float, beta: float, rigidity: float
) -> Errors:
    """Return by how much a cell exceeds the arcs, relative to these."""
    alpha = rigidity * beta
    cell = regular_cell(arcs.adhesions, sigma / alpha, stiffness / alpha, beta / alpha)
    angle = pi / arcs.adhesions + arcs.opening
    corner = 8 * np.sqrt(2 * alpha * beta) * (1 - np.cos(0.5 * angle))
    return Errors(
        rigidity,
        cell.energy * alpha / arcs.energy - 1,
        cell.perimeter / arcs.perimeter - 1,
        cell.extension / arcs.extension - 1,
        arcs.adhesions * corner / arcs.energy,
    )


def power(found: list[Errors], of: str) -> float:
    """Return the power of the rigidity with which the last errors vanish."""
    last = found[-_FITTED:]
    logs = np.log([[one.rigidity, abs(getattr(one, of))] for one in last])
    return float(np.polyfit(logs[:, 0], logs[:, 1], 1)[0])


if __name__ == "__main__":
    main()
