"""Print the comparison of films along normals with minimal surfaces."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass

import click
import numpy as np
from threadpoolctl import threadpool_limits

from eulerplateau.branches import (
    BranchPoint,
    Limits,
    SpecialPoint,
    StepControl,
    branches_from,
    equilibrium,
    explore_from,
    film_point,
    follow,
)
from eulerplateau.film import AreaFilm
from eulerplateau.film.harmonic import follow_loop
from eulerplateau.mesh import Shape, measure
from eulerplateau.solvers import Problem, solve
from scripts.studies.common import make_mesh

# Loop edges of disks, and the load of the films that are compared.
LOOPS = (48, 72, 96, 144)
LOAD, START = 1780.0, 1740.0
CONTROL = StepControl(window=(1400.0, 2400.0), unit=2000.0)
# Loads this part below the onset are fitted.
NEAR = 0.06
# Of the film itself: docs/true-film.md.
EXACT_ONSET = 1855.677270245


@dataclass(frozen=True)
class Quality:
    """A film: the gradient left inside it, and its smallest angle (degrees)."""

    left: float
    angle: float


@dataclass(frozen=True)
class Comparison:
    """One mesh: the film near LOAD along normals and free, and both onsets."""

    loop_edges: int
    vertices: int
    along_normals: Quality
    free: Quality
    smaller: float
    seconds: float
    onset: float
    onset_of_twisted: float


@click.command()
def main() -> None:
    """Print the comparison as Markdown."""
    click.echo(
        "| loop edges | vertices | gradient, along normals | free | worst angle, along "
        "normals | free | area | found in |"
    )
    click.echo("| ---: " * 8 + "|")
    with threadpool_limits(1):
        found = list(comparisons())
    for row in found:
        click.echo(
            f"| {row.loop_edges} | {row.vertices} | {row.along_normals.left:.1e} | "
            f"{row.free.left:.1e} | {row.along_normals.angle:.0f}° | "
            f"{row.free.angle:.0f}° | -{row.smaller:.1e} | {row.seconds:.2f} s |"
        )
    click.echo()
    click.echo(
        "| loop edges | sigma_hat of twist, flat mesh | from twisted films | relative "
        "difference | relative error of the first |"
    )
    click.echo("| ---: " * 5 + "|")
    for row in found:
        click.echo(
            f"| {row.loop_edges} | {row.onset:.3f} | {row.onset_of_twisted:.3f} | "
            f"{row.onset_of_twisted / row.onset - 1:.1e} | "
            f"{row.onset / EXACT_ONSET - 1:.1e} |"
        )


def comparisons() -> Iterator[Comparison]:
    """Yield one comparison for each of LOOPS."""
    for loop_edges in LOOPS:
        polygon = {"kind": "ellipse", "aspect": 1.0}
        disk = make_mesh(polygon=polygon, edge_length=2 * np.pi / loop_edges)
        film = AreaFilm(disk.loop, disk.interior)
        problem = Problem(disk, film)
        special = twist_point(problem)
        loads, twists, last = [], [], None
        for point in follow(next(branches_from(special, CONTROL)), CONTROL):
            if point.value < LOAD:
                last = point
                break
            if point.value > (1 - NEAR) * special.point.value:
                loads.append(point.value)
                twists.append(np.ptp(point.x[:, 2]))
        assert last is not None, "the branch ended early"
        curve = np.polynomial.Polynomial.fit(np.square(twists), loads, 2)
        yield compared(problem, film, special, last, float(curve(0.0)))


def twist_point(problem: Problem) -> SpecialPoint:
    """Return the first bifurcation of the planar two-lobed film on a mesh of the disk."""
    found = solve(problem, START, problem.disk.x * [1.25, 0.8, 1.0])
    start = film_point(found, problem, CONTROL)
    points = explore_from(start, CONTROL, Limits(special_points=0))
    return next(point.special for point in points if point.special is not None)


def compared(
    problem: Problem,
    film: AreaFilm,
    special: SpecialPoint,
    point: BranchPoint,
    onset: float,
) -> Comparison:
    """Compare the films on a twisted loop: on the flat film's mesh, and set free."""
    flat = equilibrium(special.point).shape
    bent = follow_loop(film.tiling(flat.triangles), flat.x, point.x)
    heights = film.of_loop(flat.moved(bent))
    along = heights.shape(point.x)
    started = time.process_time()
    released = heights.released(point.x)
    seconds = time.process_time() - started
    assert released is not heights, "no discrete minimal surface"
    free = released.shape(point.x)
    areas = [film.energy_gradient(shape, 1.0)[0] for shape in (along, free)]
    return Comparison(
        loop_edges=problem.disk.n_b,
        vertices=problem.disk.n_v,
        along_normals=quality(problem, along),
        free=quality(problem, free),
        smaller=1 - areas[1] / areas[0],
        seconds=seconds,
        onset=special.point.value,
        onset_of_twisted=onset,
    )


def quality(problem: Problem, shape: Shape) -> Quality:
    """Return what is left of the gradient inside a film, and its worst angle."""
    pull = np.abs(problem.film.energy_gradient(shape, 1.0)[1]).max(axis=1)
    left = float(pull[problem.disk.interior].max() / pull.max())
    return Quality(left, measure(problem.disk, shape).min_angle)


if __name__ == "__main__":
    main()
