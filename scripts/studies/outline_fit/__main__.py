"""Print the coverage of the intervals."""

from __future__ import annotations

import time
from functools import partial

import click
import numpy as np

from scripts.studies.common import machine, markdown_table, processes
from scripts.studies.outline_fit.coverage import QUANTITIES, Hit, hit
from scripts.studies.outline_fit.outlines import KINDS


@click.command()
@click.option("--sets", default=400, show_default=True, type=click.IntRange(1))
@click.option("--seed", default=1, show_default=True, type=int)
def main(sets: int, seed: int) -> None:
    """Print how many of the 95 % intervals hold the truth, as a Markdown table."""
    start = time.perf_counter()
    with processes() as pool:
        hits = list(pool.map(partial(hit, seed=seed), range(sets)))
    head = "noise", "outlines", "lobes right", "load", "L", "tension", "load's half width"
    rows: list[tuple[str, ...]] = [head]
    for kind in (*KINDS, "all"):
        chosen = [one for one in hits if kind in (one.kind, "all")]
        rows.append((kind, str(len(chosen)), *_shares(chosen)))
    seconds = time.perf_counter() - start
    click.echo(f"{sets} outlines, seed {seed}, {seconds:.0f} s; {machine()}\n")
    click.echo(markdown_table(rows, words=1))


def _shares(hits: list[Hit]) -> list[str]:
    shares = [
        np.mean([getattr(one, name) for one in hits]) for name in ("lobes", *QUANTITIES)
    ]
    width = float(np.median([one.width for one in hits]))
    return [*(f"{100 * share:.1f} %" for share in shares), f"{100 * width:.2g} %"]


if __name__ == "__main__":
    main()
