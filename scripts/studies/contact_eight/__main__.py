"""Print the tables of the eight in contact."""

from __future__ import annotations

import math
from collections.abc import Iterator

import click

from eulerplateau.branches.conformal import (
    ThickEight,
    opening_load,
    splitting_load,
    thick_eight,
)
from eulerplateau.exact.conformal import flat_eight
from eulerplateau.threads import one_thread
from scripts.studies.common import machine, markdown_table
from scripts.studies.contact_eight import refinement, splitting, unstable
from scripts.studies.contact_eight.on_meshes import table

DIAMETERS = (0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
NARROW = (0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
LOAD = 1700.0
ROD = 2 / 3, 1.0
# The least diameter of which the load is sought at which contact splits: of thinner lines
# the conformal grid is too crowded there.
SPLIT = 0.02


@click.command()
@click.option("--no-loads", is_flag=True, help="Leave out the slow table of loads.")
@click.option("--meshes", is_flag=True, help="Print the table of meshes only.")
@click.option("--refined", is_flag=True, help="Print the table of refined meshes only.")
@click.option("--splits", is_flag=True, help="Print where contact splits on meshes only.")
@click.option("--saddle", is_flag=True, help="Print the table of a saddle on meshes only.")
def main(no_loads: bool, meshes: bool, refined: bool, splits: bool, saddle: bool) -> None:
    """Print films at one load, the formula's error, meshes, then loads over diameters."""
    with one_thread():
        if splits:
            click.echo(markdown_table(splitting.table(), 0))
            return
        if saddle:
            click.echo(markdown_table(unstable.table(), 0))
            return
        if refined:
            click.echo(f"{machine()}\n\n{markdown_table(refinement.table(), 0)}")
            return
        if meshes:
            click.echo(markdown_table(table(), 0))
            return
        films = [thick_eight(LOAD, d) for d in NARROW]
        turned = [thick_eight(LOAD, d, *ROD) for d in NARROW[:3]]
        click.echo(markdown_table(_numbers(films), 0))
        click.echo(markdown_table(_numbers(turned), 0))
        click.echo(markdown_table(_formula(films), 0))
        click.echo(markdown_table(table(), 0))
        if not no_loads:
            for row in _loads():
                click.echo(row)


def _numbers(films: list[ThickEight]) -> Iterator[list[str]]:
    yield ["d", "energy", "force", "angle", "writhe", "moment", "unstable", "error"]
    for film in films:
        yield [
            f"{film.diameter:g}",
            f"{film.energy:.8f}",
            f"{film.contact_force:.6f}",
            f"{film.crossing_angle:.5f}",
            f"{film.writhe:.7f}",
            f"{film.twist_moment + 0.0:.6f}",
            f"{film.n_unstable}",
            f"{film.energy_error:.0e}",
        ]


def _formula(films: list[ThickEight]) -> Iterator[list[str]]:
    """Yield the excess over the flat eight, and the formula's with C of the narrowest."""
    flat = flat_eight(LOAD)
    stiff = LOAD / (2 * abs(flat.angle))
    last = films[-1]
    excess = (last.energy - flat.energy) / (stiff * last.diameter**2)
    log_size = excess + math.log(last.diameter)
    yield ["d", "E - E8", "formula", "relative error", "error of the force"]
    for film in films:
        d = film.diameter
        found = film.energy - flat.energy
        said = stiff * d**2 * (log_size - math.log(d))
        pull = stiff * d * (2 * (log_size - math.log(d)) - 1)
        yield [
            f"{d:g}",
            f"{found:.3e}",
            f"{said:.3e}",
            f"{said / found - 1:.1e}",
            f"{pull / film.contact_force - 1:.1e}",
        ]


def _loads() -> Iterator[str]:
    for d in DIAMETERS:
        opens = opening_load(d)
        splits = splitting_load(d) if d >= SPLIT else None
        shown = ["-" if load is None else f"{load:.2f}" for load in (opens, splits)]
        yield f"| {d:g} | {' | '.join(shown)} |"


if __name__ == "__main__":
    main()
