"""Print the exponents."""

from __future__ import annotations

import click
import numpy as np
from threadpoolctl import threadpool_limits

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import Limits, Settings, explore, first_point, fit_power
from eulerplateau.mesh import DiskMesh, load_mesh, loop_frame
from eulerplateau.mesh.curvature import total_gauss_curvature
from eulerplateau.runs.sweep import sweep
from eulerplateau.solvers import Problem, make_problem, solve
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
        mesh = load_mesh(MESHES / file)
        problem = make_problem(mesh)
        onset, error = locate(mesh, problem)
        loads = onset * (1 + DISTANCES)
        values = np.array(follow(mesh, problem, loads))
        for name, column in zip((r"⟨\|κₙ\|⟩", "⟨K⟩"), values.T, strict=True):
            free, fixed = (fit_power(loads, column, onset=o) for o in (None, onset))
            click.echo(
                f"| {film} | {name} | {free.exponent:.5f} ± {free.exponent_error:.5f} | "
                f"{fixed.exponent:.5f} ± {fixed.exponent_error:.5f} |"
            )
        click.echo(f"| {film} | onset | | {onset:.8f} ± {error:.0e} |")


def locate(mesh: DiskMesh, problem: Problem) -> tuple[float, float]:
    """Return the load at which the planar film loses stability, and its error."""
    flat = solve(problem, mesh.x, np.zeros(mesh.n_b), WINDOW[0])
    settings = Settings(load_range=WINDOW, load_unit=WINDOW[1])
    start = first_point(problem, flat.x[mesh.loop], WINDOW[0], settings)
    visits = explore(start, settings, Limits(special_points=0))
    special = next(v.special for v in visits if v.special is not None)
    return special.point.load, special.load_error


def follow(
    mesh: DiskMesh, problem: Problem, loads: FloatArray
) -> list[tuple[float, float]]:
    """Return <|kappa_n|> and <K> at falling loads."""
    noise = 1e-3 * np.random.default_rng(1).standard_normal(mesh.n_v)
    start = mesh.x + np.outer(noise, [0.0, 0.0, 1.0])
    found = []
    for state in sweep(problem, start, loads.tolist(), solve):
        frame = loop_frame(mesh, state.x)
        bent = float(np.abs(frame.kappa_n) @ frame.mean_lengths)
        found.append((bent, total_gauss_curvature(mesh, state.x)))
    return found


if __name__ == "__main__":
    with threadpool_limits(1, user_api="blas"):
        main()
