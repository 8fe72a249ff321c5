"""Print how many equilibria there are, and what each way of searching has missed."""

from __future__ import annotations

import time
from collections.abc import Sequence

import click

from eulerplateau.branches import Entry, Plan, catalogue_at
from eulerplateau.film import FILM_LOADS
from eulerplateau.solvers import Problem
from scripts.studies.common import machine, make_mesh, markdown_table

HEXAGON = {"kind": "regular", "sides": 6}
STRETCHED = {"kind": "stretched-hexagon", "factor": 2.0}
# Film, polygon, loads: below and above what is known to happen (docs/transitions.md).
CASES = (
    ("hexagon", "springs", HEXAGON, (600.0, 1000.0, 1400.0)),
    ("elongated polygon", "springs", STRETCHED, (600.0, 700.0, 800.0)),
    ("true area", "area", HEXAGON, (1400.0, 1600.0, 1800.0)),
)


@click.command()
@click.option("--starts", default=40, help="Random loops, and guesses for deflation.")
@click.option("--vertices", default=150, help="Of each mesh.")
@click.option("--seed", default=1)
def main(starts: int, vertices: int, seed: int) -> None:
    """Print the tables of docs/catalogue.md."""
    began = time.perf_counter()
    plan = Plan(starts=starts, seed=seed)
    counts, lists = [], []
    for name, film, polygon, loads in CASES:
        disk = make_mesh(vertices=vertices, algorithm=6, polygon=polygon)
        for load in loads:
            found = catalogue_at(Problem(disk, film), load, plan)
            place = name, f"{FILM_LOADS[film].text} = {load:g}"
            counts.append((*place, *counted(found, starts)))
            lists += [(*place, *listed(entry)) for entry in found]
    click.echo(markdown_table([COUNTED, *counts], words=2))
    click.echo(markdown_table([LISTED, *lists], words=2))
    sizes = f"{starts} starts and as many guesses, meshes of about {vertices} vertices"
    click.echo(f"{sizes}; {time.perf_counter() - began:.0f} s on {machine()}")


COUNTED = (
    "film", "load", "by index 0, 1, 2, 3, 4", "together", "after half", "by starts",
    "by deflation", "missed by starts", "missed by deflation",
)  # fmt: skip
LISTED = "film", "load", "energy", "index", "starts", "guess", "symmetry"


def counted(found: Sequence[Entry], starts: int) -> tuple[str, ...]:
    """Return the row of COUNTED behind film and load."""
    of_index = [sum(e.equilibrium.n_unstable == k for e in found) for k in range(5)]
    half = starts // 2
    early = [e for e in found if min((*e.starts, *e.guesses)) <= half]
    by_starts = [e for e in found if e.starts]
    by_deflation = [e for e in found if e.guesses]
    missed = [sum(not e.starts for e in found), sum(not e.guesses for e in found)]
    sizes = [len(part) for part in (found, early, by_starts, by_deflation)]
    return ", ".join(map(str, of_index)), *map(str, sizes), *map(str, missed)


def listed(entry: Entry) -> tuple[str, ...]:
    """Return the row of LISTED behind film and load."""
    found = entry.equilibrium
    guess = str(min(entry.guesses)) if entry.guesses else "-"
    numbers = f"{found.energy:.3f}", str(found.n_unstable), str(len(entry.starts)), guess
    return *numbers, entry.symmetry or "none"


if __name__ == "__main__":
    main()
