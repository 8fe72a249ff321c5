"""Print what both ways of minimising come to."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import click
import numpy as np
from scipy.optimize import minimize
from threadpoolctl import threadpool_limits

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.planar import planar_film
from eulerplateau.film import AreaFilm
from eulerplateau.mesh import Disk, Shape, read_disk
from eulerplateau.solvers import Problem, displaced, solve
from scripts.studies.common import ROOT

MESH = ROOT / "meshes" / "elongated.vtp"
LOADS = (1400.0, 1600.0, 1800.0)
ROUNDS, ITERATIONS = 8, 20_000
KICK = 1e-4


@dataclass(frozen=True)
class Outcome:
    """What a minimisation made of the film at a load."""

    load: float
    method: str
    iterations: int
    excess: float
    length_error: float
    strip: float
    smallest_angle: float


@click.command()
def main() -> None:
    """Print both methods' outcomes as Markdown."""
    mesh = read_disk(MESH)
    click.echo(
        "| load | method | iterations | E over exact - 1 | length error | "
        "boundary triangles' area | worst angle |"
    )
    click.echo("| ---: | --- | ---: | ---: | ---: | ---: | ---: |")
    with threadpool_limits(1):
        for found in outcomes(mesh):
            click.echo(
                f"| {found.load:g} | {found.method} | {found.iterations} | "
                f"{found.excess:.1e} | {found.length_error:.0e} | {found.strip:.1%} | "
                f"{found.smallest_angle:.2g} deg |"
            )


def outcomes(mesh: Disk) -> Iterator[Outcome]:
    """Yield what either method comes to, from the flat polygon with a small kick."""
    film = AreaFilm(mesh.loop, mesh.interior)
    problem = Problem(mesh, film)
    start = problem.shape(displaced(mesh, KICK, 1))
    for load in LOADS:
        shape, iterations = all_coordinates(problem, start, load)
        yield outcome(problem, film, shape, load, "all coordinates", iterations)
        found = solve(problem, load, start)
        yield outcome(problem, film, found.shape, load, "along normals", found.iterations)


def all_coordinates(problem: Problem, start: Shape, load: float) -> tuple[Shape, int]:
    """Return the shape that scipy's CG comes to, and its iterations."""
    loop, shape = problem.loop, start
    penalty = 4 / float(loop.rest_lengths.mean()) ** 2
    multipliers = np.zeros(problem.disk.n_b)
    unit = float(np.sqrt(loop.rest_lengths.min() ** 3 / 32))
    spent = 0

    def lagrangian(scaled: FloatArray) -> tuple[float, FloatArray]:
        at = start.moved(unit * scaled.reshape(start.x.shape))
        value, gradient = problem.film.energy_gradient(at, load)
        bending, force = problem.bending_energy(at)
        excess = loop.constraint(at.x_loop)
        tension = multipliers + penalty * excess / loop.rest_lengths
        force = force + problem.tension_force(at, tension)
        stretching = (multipliers + 0.5 * penalty * excess / loop.rest_lengths) @ excess
        return value + bending + float(stretching), unit * (gradient + force).ravel()

    for _ in range(ROUNDS):
        options = {"maxiter": ITERATIONS, "gtol": 1e-6}
        scaled = shape.x.ravel() / unit
        found = minimize(lagrangian, scaled, jac=True, method="CG", options=options)
        shape = start.moved(unit * found.x.reshape(start.x.shape))
        spent += int(found.nit)
        excess = loop.constraint(shape.x_loop)
        multipliers = multipliers + penalty * excess / loop.rest_lengths
    return shape, spent


def outcome(
    problem: Problem,
    film: AreaFilm,
    shape: Shape,
    load: float,
    method: str,
    iterations: int,
) -> Outcome:
    """Measure a shape against the exact planar film."""
    sides = film.tiling(shape.triangles).sides(shape.x)
    energy = problem.bending_energy(shape)[0] + load * float(sides.areas.sum())
    on_loop = np.isin(shape.triangles, shape.loop).any(axis=1)
    return Outcome(
        load=load,
        method=method,
        iterations=iterations,
        excess=energy / planar_film(2, load).energy - 1,
        length_error=problem.length_error(shape),
        strip=float(sides.areas[on_loop].sum() / sides.areas.sum()),
        smallest_angle=sides.smallest_angle,
    )


if __name__ == "__main__":
    main()
