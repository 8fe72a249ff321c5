"""Print the coverage of the intervals."""

from __future__ import annotations

import time

import click

from scripts.studies.cell_fit.coverage import CASES, coverage
from scripts.studies.common import machine, markdown_table


@click.command()
@click.option("--sets", default=1000, show_default=True, type=click.IntRange(1))
@click.option("--seed", default=1, show_default=True, type=int)
def main(sets: int, seed: int) -> None:
    """Print how many of the 95 % intervals hold the truth, as a Markdown table."""
    rows = [("R₀", "noise", "parameter", "coverage", "binomial ±", "open", "s per set")]
    for case in CASES:
        start = time.process_time()
        found = coverage(case, sets, seed)
        seconds = (time.process_time() - start) / sets
        for one in found:
            rows.append(
                (
                    "given" if case.rest_radius_given else "fitted",
                    "known" if case.noise_known else "estimated",
                    one.parameter,
                    f"{100 * one.share:.2f} %",
                    f"{100 * one.spread:.2f} %",
                    f"{100 * one.open / one.sets:.1f} %",
                    f"{seconds:.3f}",
                )
            )
    click.echo(f"{sets} sets, seed {seed}; {machine()}\n")
    click.echo(markdown_table(rows, words=3))


if __name__ == "__main__":
    main()
