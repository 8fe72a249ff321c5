"""Print how many equilibria there are, and what each way of searching has missed."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence

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
# Of loops with a diameter, in space or in the plane: loads before lobes touch at d = 0.05,
# where they touch at a point, and along a line.
THICK_CASES = (
    ("true area", "area", False, (2000.0, 2800.0)),
    ("in its plane", "area", True, (2800.0, 4500.0)),
)


@click.command()
@click.option("--starts", default=40, help="Random loops, and guesses for deflation.")
@click.option("--vertices", default=150, help="Of each mesh.")
@click.option("--seed", default=1)
@click.option("--diameter", type=float, help="Of loops with one, on the hexagon's mesh.")
def main(starts: int, vertices: int, seed: int, diameter: float | None) -> None:
    """Print the tables of docs/catalogue.md."""
    began = time.process_time()
    plan = Plan(starts=starts, seed=seed)
    counts, lists = [], []
    problems = _thin(vertices) if diameter is None else _thick(vertices, diameter)
    for name, film, problem, load in problems:
        found = catalogue_at(problem, load, plan)
        place = name, f"{FILM_LOADS[film].text} = {load:g}"
        counts.append((*place, *counted(found, starts)))
        lists += [(*place, *listed(entry)) for entry in found]
    listed_as = LISTED if diameter is None else (*LISTED, *IN_CONTACT)
    click.echo(markdown_table([COUNTED, *counts], words=2))
    click.echo(markdown_table([listed_as, *lists], words=2))
    sizes = f"{starts} starts and as many guesses, meshes of about {vertices} vertices"
    click.echo(f"{sizes}; {time.process_time() - began:.0f} CPU s on {machine()}")


def _thin(vertices: int) -> Iterator[Case]:
    """Yield what is listed of loops without a diameter."""
    for name, film, polygon, loads in CASES:
        disk = make_mesh(vertices=vertices, algorithm=6, polygon=polygon)
        for load in loads:
            yield name, film, Problem(disk, film), load


def _thick(vertices: int, diameter: float) -> Iterator[Case]:
    """Yield what is listed of loops with one."""
    disk = make_mesh(vertices=vertices, algorithm=6, polygon=HEXAGON)
    for name, film, in_plane, loads in THICK_CASES:
        for load in loads:
            problem = Problem(disk, film, in_plane=in_plane, diameter=diameter)
            yield name, film, problem, load


COUNTED = (
    "film", "load", "by index 0, 1, 2, 3, 4", "together", "after half", "by starts",
    "by deflation", "missed by starts", "missed by deflation",
)  # fmt: skip
LISTED = "film", "load", "energy", "index", "starts", "guess", "symmetry"
IN_CONTACT = "contacts", "their force"
# Name, film, problem and load.
Case = tuple[str, str, Problem, float]


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
    told = *numbers, entry.symmetry or "none"
    if found.contacts is None:
        return told
    return *told, str(len(found.contacts)), f"{found.contacts.force:.1f}"


if __name__ == "__main__":
    main()
