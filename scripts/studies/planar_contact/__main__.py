"""Print how far polygons in contact are from the exact films, and the fitted orders."""

from __future__ import annotations

from collections.abc import Iterator

import click
import numpy as np

from eulerplateau.exact.planar import PlanarFilm, planar_film
from eulerplateau.mesh import Disk
from eulerplateau.solvers import Equilibrium, Problem, Status, solve
from scripts.studies.common import markdown_table

# Lobes, diameter, load.
FILMS = [
    (2, 0.05, 2400.0),
    (2, 0.05, 3500.0),
    (2, 0.05, 6000.0),
    (2, 0.02, 2600.0),
    (2, 0.02, 4000.0),
    (2, 0.02, 7000.0),
    (2, 0.005, 2700.0),
    (2, 0.005, 4000.0),
    (2, 0.005, 8000.0),
    (3, 0.02, 12000.0),
]
EDGES = (84, 168, 336)


@click.command()
def main() -> None:
    """Print the table of docs/planar.md."""
    click.echo(markdown_table(_rows(), 0))


def _rows() -> Iterator[list[str]]:
    yield [
        "n",
        "d",
        "load",
        "contact",
        "energy",
        "error",
        "order",
        "force",
        "error",
        "order",
    ]
    for lobes, diameter, load in FILMS:
        exact = planar_film(lobes, load, diameter)
        found = [_on_polygon(exact, edges) for edges in EDGES]
        yield [
            f"{lobes}",
            f"{diameter:g}",
            f"{load:g}",
            exact.regime.contact,
            *_convergence([each.energy for each in found], exact.energy),
            *_convergence([_force(each) for each in found], exact.contact_force),
        ]


def _on_polygon(film: PlanarFilm, edges: int) -> Equilibrium:
    """Return what the exact film relaxes to; triangles about a point fill the plane."""
    k = np.arange(edges)
    x = np.zeros((edges + 1, 3))
    x[1:, :2] = film.positions(k / edges)
    disk = Disk.from_triangles(x, np.stack([0 * k, 1 + k, 1 + (k + 1) % edges], axis=1))
    problem = Problem(disk, "area", in_plane=True, diameter=film.diameter)
    found = solve(problem, film.tension, disk.shape)
    if found.status is not Status.CONVERGED:
        raise click.ClickException(f"{found.status.value}: {film}, {edges} edges")
    return found


def _force(found: Equilibrium) -> float:
    assert found.contacts is not None
    return found.contacts.force


def _convergence(values: list[float], exact: float) -> list[str]:
    """Return the exact number, the finest polygon's relative error, and the order."""
    errors = np.abs(np.array(values) / exact - 1)
    order = -np.polyfit(np.log(EDGES), np.log(errors), 1)[0]
    return [f"{exact:.6f}", f"{errors[-1]:.1e}", f"{order:.2f}"]


if __name__ == "__main__":
    main()
