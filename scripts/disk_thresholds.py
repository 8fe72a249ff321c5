"""Where a disk loses stability, of each film on many meshes, against analysis.

The disk is the planar equilibrium, stable or not, that Newton's method in the plane reaches
from the circle. Its second variation falls apart into displacements in the plane and across
it; a threshold is the load at which the lowest eigenvalue of one part vanishes.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import click
import numpy as np
from scipy.optimize import brentq
from threadpoolctl import threadpool_limits

from eulerplateau.arrays import FloatArray
from eulerplateau.film.load import FILM_LOADS
from eulerplateau.loop.lengths import project_lengths
from eulerplateau.mesh import MeshSpec, generation as generate
from eulerplateau.settings import validate
from eulerplateau.solvers.condensed import loop_energy
from eulerplateau.solvers.problem import Problem, make_problem
from eulerplateau.solvers.second_variation import TangentModel, tangent_model

PI3 = np.pi**3
# sigma_hat, derived in docs/films.md. Springs have no planar one: their meshes are not
# round, and neither are their disks, which turn into ellipses without a threshold.
ACROSS = 96 * PI3
WITHIN = {"dirichlet": 192 * PI3, "area": 48 * PI3}

CIRCLE, HEXAGON = "circle", "regular hexagon"
MESHES: dict[tuple[str, str], list[dict[str, Any]]] = {
    **{
        (CIRCLE, name): [
            {"polygon": {"kind": "circle"}, "vertices": size, "algorithm": algorithm}
            for size in (130, 474, 1800, 7000)
        ]
        for algorithm, name in ((5, "Delaunay"), (6, "Frontal-Delaunay"))
    },
    # Edges that divide the hexagon's sides: Gmsh makes a lattice of equilateral triangles.
    (HEXAGON, "lattice"): [
        {"polygon": {"kind": "regular", "sides": 6}, "edge_length": 1 / count}
        for count in (6, 12, 24, 48)
    ],
}
# Loads are tried upwards in steps of this share of the threshold, from half of it.
STEP = 0.05
CONVERGED, ITERATIONS = 1e-9, 40
COLUMNS = (
    *("film", "polygon", "mesh", "vertices", "loop_edges"),
    *("across", "across_over_limit", "within", "within_over_limit"),
)


@dataclass(frozen=True)
class Case:
    """A film on a mesh, and what MeshSpec says of the mesh."""

    film: str
    polygon: str
    mesh: str
    number: int

    @property
    def settings(self) -> dict[str, Any]:
        """The mesh's specification."""
        return MESHES[self.polygon, self.mesh][self.number]


@dataclass(frozen=True)
class Thresholds:
    """Tensions sigma_hat at which a disk gives way across its plane, and within it."""

    case: Case
    n_v: int
    n_b: int
    across: float
    within: float | None


@click.command()
@click.option(
    "--film",
    "films",
    type=click.Choice(list(FILM_LOADS)),
    multiple=True,
    default=tuple(FILM_LOADS),
    help="May be repeated. Default: all.",
)
@click.option("--csv", "path", type=click.Path(path_type=Path), help="Also write a CSV.")
def main(films: tuple[str, ...], path: Path | None) -> None:
    """Print the thresholds of a disk, and their orders of convergence, as Markdown."""
    cases = [
        Case(film, polygon, mesh, number)
        for film in films
        for polygon, mesh in MESHES
        for number in range(len(MESHES[polygon, mesh]))
    ]
    with ProcessPoolExecutor(initializer=partial(threadpool_limits, 1)) as pool:
        found = list(pool.map(thresholds, cases))
    for film in films:
        click.echo(table(film, found))
    if path is not None:
        write_csv(path, found)


def thresholds(case: Case) -> Thresholds:
    """Locate both thresholds of a case."""
    mesh = generate(validate(case.settings, MeshSpec, "mesh"))
    problem = make_problem(mesh, case.film)
    turns = 2 * np.pi * np.arange(mesh.n_b) / mesh.n_b
    circle = np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1)
    start = project_lengths(problem.loop, circle / (2 * np.pi))
    assert start is not None
    per_load = FILM_LOADS[case.film].tension_per_load
    within = None
    if case.film in WITHIN and case.polygon == CIRCLE:
        within = per_load * first_zero(problem, start, 0, WITHIN[case.film] / per_load)
    across = per_load * first_zero(problem, start, 1, ACROSS / per_load)
    return Thresholds(case, mesh.n_v, mesh.n_b, across, within)


def first_zero(problem: Problem, x: FloatArray, part: int, expected: float) -> float:
    """Return the load at which the lowest eigenvalue of a part of the spectrum vanishes."""

    def lowest(load: float, x: FloatArray) -> tuple[float, FloatArray]:
        model = planar_equilibrium(problem, x, load)
        return float(np.linalg.eigvalsh(parts(model)[part][1])[0]), model.x

    loads = expected * np.arange(0.5, 1.5, STEP)
    _, x = lowest(loads[0], x)
    for low, high in pairwise(loads):
        value, after = lowest(high, x)
        if value <= 0:
            return float(
                brentq(lambda load, x=x: lowest(load, x)[0], low, high, rtol=1e-10)
            )
        x = after
    raise ArithmeticError(f"no threshold up to {loads[-1]:g}")


def planar_equilibrium(problem: Problem, x: FloatArray, load: float) -> TangentModel:
    """Return the equilibrium that Newton's method in the plane reaches from x (n_b, 3)."""
    for _ in range(ITERATIONS):
        model = tangent_model(loop_energy(problem, load), x)
        if model.residual <= max(CONVERGED, 10 * model.rounding):
            return model
        basis, hessian = parts(model)[0]
        step = basis @ np.linalg.solve(hessian, -(basis.T @ model.gradient))
        moved = project_lengths(problem.loop, x + model.displacement(step))
        if moved is None:
            break
        x = moved
    raise ArithmeticError(f"no planar equilibrium at the load {load:g}")


def parts(model: TangentModel) -> list[tuple[FloatArray, FloatArray]]:
    """Return basis and Hessian of the displacements in the plane, and of those across."""
    up = model.basis.reshape(len(model.x), 3, -1)[:, 2]
    # The tangent space at a flat loop is the sum of the two: squares of z are 0 or 1.
    share, vectors = np.linalg.eigh(up.T @ up)
    bases = vectors[:, share < 0.5], vectors[:, share > 0.5]
    return [(basis, basis.T @ model.hessian @ basis) for basis in bases]


def order(found: Iterable[Thresholds], of: Callable[[Thresholds], float | None]) -> float:
    """Return the fitted order in the loop's edges of an error relative to its limit."""
    errors = [(1 / t.n_b, abs(value)) for t in found if (value := of(t)) is not None]
    return float(np.polyfit(*np.log(errors).T, 1)[0])


def errors(found: Thresholds) -> tuple[float, float | None]:
    """Return the relative errors of the thresholds across the plane and within it."""
    within = None
    if found.within is not None:
        within = found.within / WITHIN[found.case.film] - 1
    return found.across / ACROSS - 1, within


def table(film: str, every: Iterable[Thresholds]) -> str:
    """Return the Markdown table of a film."""
    every = [found for found in every if found.case.film == film]
    rows = [["polygon", "mesh", "vertices", "loop edges"]]
    rows[0] += ["σ̂ across", "over 96π³"]  # noqa: RUF001
    planar = film in WITHIN
    if planar:
        rows[0] += ["σ̂ within", f"over {WITHIN[film] / PI3:.0f}π³"]  # noqa: RUF001
    for polygon, mesh in MESHES:
        here = [f for f in every if (f.case.polygon, f.case.mesh) == (polygon, mesh)]
        rows += [
            [polygon, mesh, str(f.n_v), str(f.n_b), *cells(f)[: 4 if planar else 2]]
            for f in here
        ]
        if planar and polygon == CIRCLE:
            across, within = (order(here, lambda f, i=i: errors(f)[i]) for i in (0, 1))
            rows.append(["", "order", "", "", "", f"{across:.2f}", "", f"{within:.2f}"])
    rule = ["---"] * 2 + ["---:"] * (len(rows[0]) - 2)
    lines = ["| " + " | ".join(row) + " |" for row in (rows[0], rule, *rows[1:])]
    return f"\n### {film.capitalize()}\n\n" + "\n".join(lines) + "\n"


def cells(found: Thresholds) -> list[str]:
    """Return both thresholds, each with its ratio to the limit."""
    across, within = errors(found)
    text = [f"{found.across:.3f}", f"{1 + across:.6f}"]
    if found.within is None or within is None:
        return [*text, "", ""]
    return [*text, f"{found.within:.3f}", f"{1 + within:.6f}"]


def write_csv(path: Path, every: Iterable[Thresholds]) -> None:
    """Write one row for each film on each mesh."""
    with path.open("w", newline="", encoding="utf-8") as file:
        lines = csv.writer(file, lineterminator="\n")
        lines.writerow(COLUMNS)
        for f in every:
            mesh = [f.case.film, f.case.polygon, f.case.mesh, f.n_v, f.n_b]
            across, within = errors(f)
            planar = ["", ""] if within is None else [f.within, 1 + within]
            lines.writerow([*mesh, f.across, 1 + across, *planar])


if __name__ == "__main__":
    main()
