"""Print the comparison of films along normals with minimal surfaces."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass

import click
import numpy as np
from threadpoolctl import threadpool_limits

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import BranchPoint, Settings, SpecialPoint, first_point
from eulerplateau.branches.continuation import follow
from eulerplateau.branches.special import branches_from, special_points
from eulerplateau.film import AreaFilm, chart_at, minimal
from eulerplateau.film.harmonic import moved_with
from eulerplateau.mesh import DiskMesh
from eulerplateau.solvers import make_problem, newton
from scripts.studies.common import make_mesh

# Loop edges of disks, and the load of the films that are compared.
LOOPS = (48, 72, 96, 144)
LOAD, START = 1780.0, 1740.0
SETTINGS = Settings(load_range=(1400.0, 2400.0), load_unit=2000.0)
# Loads this part below the onset are fitted.
NEAR = 0.06
# Of the film itself: docs/true-film.md.
EXACT_ONSET = 1855.677270245


@dataclass(frozen=True)
class Shape:
    """A film: the gradient left inside it, and its smallest angle (degrees)."""

    left: float
    angle: float


@dataclass(frozen=True)
class Comparison:
    """One mesh: the film near LOAD along normals and free, and both onsets."""

    loop_edges: int
    vertices: int
    along_normals: Shape
    free: Shape
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
        mesh = make_mesh(polygon=polygon, edge_length=2 * np.pi / loop_edges)
        special = twist_point(mesh)
        loads, twists, last = [], [], None
        for point in follow(next(branches_from(special, SETTINGS)), SETTINGS):
            if point.load < LOAD:
                last = point
                break
            if point.load > (1 - NEAR) * special.point.load:
                loads.append(point.load)
                twists.append(np.ptp(point.x[:, 2]))
        assert last is not None, "the branch ended early"
        curve = np.polynomial.Polynomial.fit(np.square(twists), loads, 2)
        yield compared(mesh, special, last, float(curve(0.0)))


def twist_point(mesh: DiskMesh) -> SpecialPoint:
    """Return the first bifurcation of the planar two-lobed film on a mesh of the disk."""
    problem = make_problem(mesh, "area")
    found = newton.solve(problem, mesh.x * [1.25, 0.8, 1.0], np.zeros(mesh.n_b), START)
    if found.triangles is not None:
        problem = problem.with_triangles(found.triangles)
    loop = found.x[mesh.loop]
    before = first_point(problem.near(found.x), loop, START, SETTINGS)
    for after in follow(before, SETTINGS):
        for special in special_points(before, after, SETTINGS):
            return special
        before = after
    raise AssertionError("no bifurcation met")


def compared(
    mesh: DiskMesh, special: SpecialPoint, point: BranchPoint, onset: float
) -> Comparison:
    """Compare the films on a twisted loop: on the flat film's mesh, and set free."""
    flat = special.point
    film = flat.problem.film
    assert isinstance(film, AreaFilm)
    bent = moved_with(film, flat.film, point.x)
    along = chart_at(film, bent).relax(point.x)
    started = time.process_time()
    found = minimal(film, along.x)
    seconds = time.process_time() - started
    assert found is not None, "no discrete minimal surface"
    sides = found[0].sides(found[1])
    return Comparison(
        loop_edges=mesh.n_b,
        vertices=mesh.n_v,
        along_normals=shape(film, along.x),
        free=shape(*found),
        smaller=1 - float(sides.areas.sum()) / along.area,
        seconds=seconds,
        onset=flat.load,
        onset_of_twisted=onset,
    )


def shape(film: AreaFilm, x: FloatArray) -> Shape:
    """Return what is left of the gradient inside a film (n_v, 3), and its worst angle."""
    sides = film.sides(x)
    pull = np.abs(film.gradient(sides)).max(axis=1)
    left = float(pull[film.interior].max() / pull.max())
    return Shape(left, sides.smallest_angle)


if __name__ == "__main__":
    main()
