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
from eulerplateau.film.area import area
from eulerplateau.loop import Loop
from eulerplateau.mesh import DiskMesh, load_mesh
from eulerplateau.solvers import make_problem, newton
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
    mesh = load_mesh(MESH)
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


def outcomes(mesh: DiskMesh) -> Iterator[Outcome]:
    """Yield what either method comes to, from the flat polygon with a small kick."""
    film, problem = area(mesh), make_problem(mesh, "area")
    noise = np.random.default_rng(1).standard_normal(mesh.n_v)
    start = mesh.x + KICK * np.outer(noise, [0.0, 0.0, 1.0])
    nobody = np.zeros(mesh.n_b)
    for load in LOADS:
        x, iterations = all_coordinates(mesh, film, start, load)
        yield outcome(mesh, film, x, load, "all coordinates", iterations)
        found = newton.solve(problem, start, nobody, load)
        here = film if found.triangles is None else film.retiled(found.triangles)
        yield outcome(mesh, here, found.x, load, "along normals", found.iterations)


def all_coordinates(
    mesh: DiskMesh, film: AreaFilm, x: FloatArray, load: float
) -> tuple[FloatArray, int]:
    """Return the shape (n_v, 3) that scipy's CG comes to, and its iterations."""
    problem, loop = make_problem(mesh, "area"), Loop(mesh.rest_lengths)
    penalty = 4 / float(loop.rest_lengths.mean()) ** 2
    multipliers = np.zeros(mesh.n_b)
    unit = float(np.sqrt(loop.rest_lengths.min() ** 3 / 32))
    spent = 0

    def lagrangian(scaled: FloatArray) -> tuple[float, FloatArray]:
        at = unit * scaled.reshape(x.shape)
        value, gradient = film.energy_gradient(at, load)
        bending, force = problem.bending_energy(at)
        excess = loop.constraint(at[mesh.loop])
        tension = multipliers + penalty * excess / loop.rest_lengths
        force = force + problem.tension_force(at, tension)
        stretching = (multipliers + 0.5 * penalty * excess / loop.rest_lengths) @ excess
        return value + bending + float(stretching), unit * (gradient + force).ravel()

    for _ in range(ROUNDS):
        options = {"maxiter": ITERATIONS, "gtol": 1e-6}
        scaled = x.ravel() / unit
        found = minimize(lagrangian, scaled, jac=True, method="CG", options=options)
        x, spent = unit * found.x.reshape(x.shape), spent + int(found.nit)
        excess = loop.constraint(x[mesh.loop])
        multipliers = multipliers + penalty * excess / loop.rest_lengths
    return x, spent


def outcome(
    mesh: DiskMesh, film: AreaFilm, x: FloatArray, load: float, method: str, iterations: int
) -> Outcome:
    """Measure a shape against the exact planar film."""
    problem, sides = make_problem(mesh, "area"), film.sides(x)
    energy = problem.bending_energy(x)[0] + load * float(sides.areas.sum())
    on_loop = np.isin(film.triangles, mesh.loop).any(axis=1)
    return Outcome(
        load=load,
        method=method,
        iterations=iterations,
        excess=energy / planar_film(2, load).energy - 1,
        length_error=problem.length_error(x),
        strip=float(sides.areas[on_loop].sum() / sides.areas.sum()),
        smallest_angle=sides.smallest_angle,
    )


if __name__ == "__main__":
    main()
