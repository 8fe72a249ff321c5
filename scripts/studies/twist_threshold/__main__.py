"""Print the loads at which the film begins to twist."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import click
import numpy as np
from scipy.optimize import brentq
from threadpoolctl import threadpool_limits

from eulerplateau.film import AreaFilm
from eulerplateau.film.harmonic import follower
from eulerplateau.mesh import Disk
from eulerplateau.mesh.polygon import ellipse_perimeter
from eulerplateau.solvers import Equilibrium, Problem, solve
from scripts.studies.common import make_mesh

# The start, an ellipse, fixes which way the lobes lie and nothing else.
ASPECT = 2.0
LOOPS = (64, 96, 128, 192, 256, 384)
ALGORITHMS = {"Delaunay": 5, "Frontal-Delaunay": 6}
GRADINGS = (1.0, 3.0)
WINDOW = (1750.0, 1900.0)


@dataclass(frozen=True)
class Threshold:
    """The load sigma_hat at which the film on a mesh begins to twist."""

    mesh: str
    grading: float
    vertices: int
    loop_edges: int
    sigma_hat: float
    min_angle: float


@click.command()
@click.option("--csv", "path", type=click.Path(path_type=Path), help="Also write a CSV.")
def main(path: Path | None) -> None:
    """Print the thresholds and what they extrapolate to, as Markdown."""
    with threadpool_limits(1):
        found = list(thresholds())
    click.echo("| mesh | grading | vertices | loop edges | load of twist | worst angle |")
    click.echo("| --- | ---: | ---: | ---: | ---: | ---: |")
    for row in found:
        click.echo(
            f"| {row.mesh} | {row.grading:g} | {row.vertices} | {row.loop_edges} | "
            f"{row.sigma_hat:.5f} | {row.min_angle:.0f}° |"
        )
    click.echo()
    for mesh, grading in dict.fromkeys((row.mesh, row.grading) for row in found):
        same = [row for row in found if (row.mesh, row.grading) == (mesh, grading)]
        limit, error, order = extrapolated(same)
        click.echo(
            f"{mesh}, grading {grading:g}: {limit:.4f} ± {error:.4f}, order {order:.2f}"
        )
    if path is not None:
        with path.open("w", newline="") as file:
            table = csv.DictWriter(file, [field.name for field in fields(Threshold)])
            table.writeheader()
            table.writerows(asdict(row) for row in found)


def thresholds() -> Iterator[Threshold]:
    """Yield the threshold of every mesh."""
    for name, algorithm in ALGORITHMS.items():
        for grading in GRADINGS:
            for loop_edges in LOOPS:
                mesh = make_mesh(
                    polygon={"kind": "ellipse", "aspect": ASPECT},
                    edge_length=ellipse_perimeter(ASPECT) / loop_edges,
                    algorithm=algorithm,
                    grading=grading,
                )
                yield twist(mesh, name, grading)


def twist(mesh: Disk, name: str, grading: float) -> Threshold:
    """Return the threshold of one mesh."""
    problem = Problem(mesh, "area", in_plane=True)
    film = AreaFilm(mesh.loop, mesh.interior)
    start = solve(problem, sum(WINDOW) / 2)

    def lowest(load: float) -> float:
        return transverse_eigenvalue(problem, film, solve(problem, load, start))

    sigma_hat = brentq(lowest, *WINDOW, xtol=1e-7)
    angle = film.tiling(start.shape.triangles).sides(start.shape.x).smallest_angle
    return Threshold(name, grading, mesh.n_v, mesh.n_b, float(sigma_hat), angle)


def transverse_eigenvalue(problem: Problem, film: AreaFilm, found: Equilibrium) -> float:
    """Return the lowest eigenvalue across the plane of a flat film, rigid motions apart."""
    loop, shape = problem.loop, found.shape
    tiling = film.tiling(shape.triangles)
    pull = follower(tiling, tiling.sides(shape.x)).condensed.stiffness
    stiffness = 2 * loop.bending_matrix + loop.tension_stiffness(found.tensions)
    root = np.sqrt(loop.mean_lengths)
    hessian = (stiffness + found.load * pull) / (root * root[:, None])
    flat = np.linalg.svd(shape.x_loop, full_matrices=False)[0][:, :2]
    rigid = np.column_stack([np.ones(len(root)), flat]) * root[:, None]
    others = np.linalg.qr(rigid, mode="complete")[0][:, 3:]
    return float(np.linalg.eigvalsh(others.T @ hessian @ others)[0])


def extrapolated(rows: list[Threshold]) -> tuple[float, float, float]:
    """Return the limit of second-order values, its error, and the fitted order.

    A fit of sigma + a h^2 + b h^4 to all meshes but the coarsest; the error is how far the
    limit moves when the finest or the next coarsest is left out as well.
    """
    h = np.array([1 / row.loop_edges for row in rows])
    values = np.array([row.sigma_hat for row in rows])

    def limit(chosen: slice) -> float:
        powers = np.vander(h[chosen] ** 2, 3, increasing=True)
        return float(np.linalg.lstsq(powers, values[chosen], rcond=None)[0][0])

    best = limit(slice(1, None))
    error = max(abs(limit(slice(1, -1)) - best), abs(limit(slice(2, None)) - best))
    order = np.polyfit(np.log(h), np.log(np.abs(values - best)), 1)[0]
    return best, error, float(order)


if __name__ == "__main__":
    main()
