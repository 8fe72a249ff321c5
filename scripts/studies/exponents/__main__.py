"""Print the exponents."""

from __future__ import annotations

import click
import numpy as np
from threadpoolctl import threadpool_limits

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import explore, fit_power
from eulerplateau.mesh import Measurer, read_disk
from eulerplateau.solvers import Problem, sweep
from scripts.studies.common import ROOT

MESHES = ROOT / "meshes"
FILMS = {"stretched hexagon": "elongated.vtp", "regular hexagon": "hexagon.vtp"}
DISTANCES = np.geomspace(1e-2, 1e-4, 21)
WINDOW = (600.0, 900.0)


@click.command()
def main() -> None:
    """Print the exponents as a Markdown table."""
    click.echo("| film | quantity | n, onset fitted | n, onset from the eigenvalue |")
    click.echo("|---|---|---:|---:|")
    for film, file in FILMS.items():
        problem = Problem(read_disk(MESHES / file))
        onset, error = locate(problem)
        loads = onset * (1 + DISTANCES)
        values = np.array(follow(problem, loads))
        for name, column in zip((r"⟨\|κₙ\|⟩", "⟨K⟩"), values.T, strict=True):
            free, fixed = (fit_power(loads, column, onset=o) for o in (None, onset))
            click.echo(
                f"| {film} | {name} | {free.exponent:.5f} ± {free.exponent_error:.5f} | "
                f"{fixed.exponent:.5f} ± {fixed.exponent_error:.5f} |"
            )
        click.echo(f"| {film} | onset | | {onset:.8f} ± {error:.0e} |")


def locate(problem: Problem) -> tuple[float, float]:
    """Return the load at which the planar film loses stability, and its error."""
    points = explore(problem, WINDOW, special_points=0)
    special = next(point.special for point in points if point.special is not None)
    return special.point.value, special.error


def follow(problem: Problem, loads: FloatArray) -> list[tuple[float, float]]:
    """Return <|kappa_n|> and <K> at falling loads."""
    measurer = Measurer(problem.disk)
    shapes = (found.shape for found in sweep(problem, loads.tolist()))
    measured = [measurer.measure(shape) for shape in shapes]
    return [(m.abs_kappa_n, m.total_gauss_curvature) for m in measured]


if __name__ == "__main__":
    with threadpool_limits(1, user_api="blas"):
        main()
