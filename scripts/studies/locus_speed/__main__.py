"""Follow curves of special points, without a mesh and on meshes; print seconds of CPU."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from functools import partial
from itertools import islice

import click
import numpy as np

from eulerplateau.branches import (
    BIFURCATION,
    LocusPoint,
    StepControl,
    follow_locus,
    locus_start,
    special_at,
)
from eulerplateau.branches.conformal import (
    Harmonics,
    SmoothFamily,
    Start,
    critical_moment,
    rod_film,
    smooth_family,
    stiffness,
)
from eulerplateau.branches.conformal.by_writhe import lobes_at
from eulerplateau.branches.locus_between import Resolution
from eulerplateau.exact.conformal import TWISTED, disk, make_basis
from eulerplateau.threads import one_thread
from scripts.studies.common import machine, markdown_table
from scripts.studies.locus_speed.on_meshes import of_flat_lobes, of_round_film

Cases = dict[str, Callable[[], float]]

# Points before which nothing counts: what is compiled is loaded then.
_WARM = 3
_RATIO = 0.8


def of_disk() -> LocusPoint:
    """Return where the disk at 500 yields to its twist, over link and load."""
    basis = make_basis(32, TWISTED)
    values = {"load": 500.0, "twist_ratio": _RATIO, "link": 0.0}
    family = SmoothFamily(basis, values, "link")
    link = critical_moment(500.0) / (4 * math.pi * _RATIO)
    flat = family.unknowns.x(disk(basis, 500.0).coefficients)
    special = special_at(family, flat, link, BIFURCATION)
    # Steps so short that the curve is more than 200 points long.
    first = StepControl((-0.1, 4.0), 4.0, largest_step=6e-3, least=-math.inf)
    second = StepControl((20.0, 1500.0), 1500.0)
    return locus_start(special, "load", 500.0, (first, second))


def of_lobes() -> LocusPoint:
    """Return where flat lobes at 1900 twist, over load and twist ratio."""
    flat = lobes_at(1900.0)
    ratio = -stiffness(flat) / (8 * math.pi**2)
    values = {"load": 1900.0, "twist_ratio": ratio, "link": 0.0}
    family = SmoothFamily(smooth_family(flat).basis, values, "load")
    special = special_at(family, flat.x, 1900.0, BIFURCATION)
    first = StepControl((1850.0, 2090.0), 2090.0, largest_step=2e-3)
    return locus_start(special, "twist_ratio", ratio, (first, StepControl((0.0, 1.0), 1.0)))


def seconds_of_points(
    start: LocusPoint, count: int, resolution: Resolution | None = None
) -> float:
    """Return the seconds of CPU that so many points of a curve take."""
    points = follow_locus(start, resolution=resolution or Resolution())
    list(islice(points, _WARM))
    began = time.process_time()
    found = sum(1 for _ in islice(points, count))
    return (time.process_time() - began) * count / found


def seconds_of_film(start: Start, load: float, link: float) -> float:
    """Return the seconds of CPU that a film takes, with all its numbers."""
    rod_film(start, load, 0.75, link).numbers()
    began = time.process_time()
    rod_film(start, load, 0.75, link).numbers()
    return time.process_time() - began


@click.command()
@click.option("--points", default=200, help="How many of a curve.")
@click.option("--repeat", default=3, help="How often each is done.")
def main(points: int, repeat: int) -> None:
    """Print a table: median, least and most seconds of CPU."""
    exact: Cases = {
        f"{points} points, the disk's link over its load": lambda: seconds_of_points(
            of_disk(), points, Harmonics()
        ),
        f"{points} points, the load at which lobes twist over C/B": lambda: (
            seconds_of_points(of_lobes(), points, Harmonics())
        ),
        "the disk at 1000, Lk = 0.2": lambda: seconds_of_film(Start.DISK, 1000.0, 0.2),
        "lobes at 1600, Lk = 0": lambda: seconds_of_film(Start.LOBES, 1600.0, 0.0),
        "lobes at 1600, Lk = 0.5": lambda: seconds_of_film(Start.LOBES, 1600.0, 0.5),
    }
    round_film = of_round_film()
    on_meshes: Cases = {
        "area, the disk's link over its load": partial(
            seconds_of_points, round_film, points
        )
    }
    for film in ("area", "springs"):
        for second, name in (("twist_ratio", "C/B"), ("link", "Lk")):
            start = of_flat_lobes(film, second)
            name = f"{film}, the load at which lobes twist over {name}"
            on_meshes[name] = partial(seconds_of_points, start, points)
    with one_thread():
        click.echo(_table("without a mesh", exact, repeat))
        click.echo(_table(f"{points} points on meshes of 474 vertices", on_meshes, repeat))
    click.echo(machine())


def _table(head: str, cases: Cases, repeat: int) -> str:
    rows: list[tuple[str, ...]] = [(head, "median (s of CPU)", "least", "most")]
    for name, case in cases.items():
        taken = [case() for _ in range(repeat)]
        rows.append((name, *(f"{f(taken):.3g}" for f in (np.median, np.min, np.max))))
    return markdown_table(rows, 1)


if __name__ == "__main__":
    main()
