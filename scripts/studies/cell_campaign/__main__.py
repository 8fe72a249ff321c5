"""Print what random cells come to."""

from __future__ import annotations

from collections import Counter
from functools import partial

import click
import numpy as np

from scripts.studies.cell_campaign.cases import Outcome, outcome
from scripts.studies.common import machine, markdown_table, processes


@click.command()
@click.option("--cells", default=200, show_default=True, help="How many.")
@click.option("--seed", default=1, show_default=True, help="Of the random numbers.")
@click.option("--all", "every", is_flag=True, help="Also print a row for each cell.")
def main(cells: int, seed: int, every: bool) -> None:
    """Print how many of random cells end in which way, as Markdown."""
    with processes() as pool:
        found = list(pool.map(partial(outcome, seed), range(cells)))
    click.echo(f"{cells} cells, seed {seed}, {machine()}\n")
    click.echo(shares(found))
    others = [one for one in found if every or one.status not in {"converged", "touching"}]
    if others:
        click.echo(rows(others))


def shares(found: list[Outcome]) -> str:
    """Return the table of how many end in which way."""
    table = [["ends as", "cells", "share", "N", "σ̂", "k̂", "iterations", "s each"]]  # noqa: RUF001
    for status, count in Counter(one.status for one in found).most_common():
        these = [one for one in found if one.status == status]
        sizes = [
            spread([getattr(one, name) for one in these])
            for name in ("adhesions", "sigma_hat", "ks_hat", "iterations", "seconds")
        ]
        table.append([status, str(count), f"{100 * count / len(found):.3g} %", *sizes])
    unstable = [one for one in found if one.status == "converged" and one.n_unstable]
    crossed = sum(one.crossed for one in found)
    notes = f"\nconverged but unstable: {len(unstable)}; crossing themselves: {crossed}; "
    residuals = [one.residual for one in found if one.status == "converged"]
    worst = max(residuals, default=float("nan"))
    return markdown_table(table, words=1) + f"{notes}largest residual: {worst:.1g}\n"


def spread(values: list[float]) -> str:
    """Return the median, the least and the most."""
    middle = float(np.median(values))
    return f"{middle:.3g} ({min(values):.3g}-{max(values):.3g})"


def rows(found: list[Outcome]) -> str:
    """Return a table with a row for each cell."""
    head = ["number", "ends as", "N", "σ̂", "k̂", "unstable", "residual", "iterations"]  # noqa: RUF001
    table = [[*head, "largest turn"]]
    for one in found:
        cells = [str(one.number), one.status, str(one.adhesions), f"{one.sigma_hat:.4g}"]
        cells += [f"{one.ks_hat:.4g}", str(one.n_unstable), f"{one.residual:.1e}"]
        table.append([*cells, str(one.iterations), f"{one.worst_turning:.1f}°"])
    return markdown_table(table, words=2)


if __name__ == "__main__":
    main()
