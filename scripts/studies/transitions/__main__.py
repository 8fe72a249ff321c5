"""Print the transitions of a film on many meshes."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import click
import numpy as np

from eulerplateau.film import FILM_LOADS
from eulerplateau.film.load import SPRING_TENSION
from eulerplateau.mesh import Measurer
from eulerplateau.solvers import Equilibrium, Problem, Status, displaced, solve, sweep
from scripts.studies.common import make_mesh, processes
from scripts.studies.transitions.report import (
    BENT,
    DISK,
    DOUBLE,
    EIGHT,
    ELONGATED,
    HEXAGON,
    Case,
    Found,
    Transition,
    mesh_table,
    sequence_table,
    starts_table,
    write_csv,
)

# Contour integral of |kappa_n| up to which a film is flat. Flat films have 1e-12; near a
# transition it is 2 to 7 sqrt(load / onset - 1), which moves the onset by less than 1e-6.
FLAT = 1e-3
# To this share of the load where the error left by the mesh is to be extrapolated.
FINE_WIDTH = 1e-6

LENGTHS = (1.8, 2.2)
POLYGONS: dict[str, dict[str, Any]] = {
    ELONGATED: {"kind": "stretched-hexagon", "factor": 2.0},
    HEXAGON: {"kind": "regular", "sides": 6},
    **{
        f"hexagon stretched to {factor} times its length": {
            "kind": "stretched-hexagon",
            "factor": factor,
        }
        for factor in LENGTHS
    },
    "ellipse twice as long as wide": {"kind": "ellipse", "aspect": 2.0},
}
ALGORITHMS = (5, 6, 8)
SIZES, FINEST = (474, 1000, 2000), 4000


@click.command()
@click.option("--csv", "path", type=click.Path(path_type=Path), help="Also write a CSV.")
@click.option("--film", type=click.Choice(list(FILM_LOADS)), default="springs")
def main(path: Path | None, film: str) -> None:
    """Print the transitions over meshes, and of springs over starts and steps too."""
    if film == "springs":
        springs(path)
    else:
        tensioned(path, film)


def springs(path: Path | None) -> None:
    """Print the tables of the paper's film, whose transitions have no limit in the mesh."""
    up = upwards(300, 1500, 0.03)
    over_meshes = [
        Case(polygon, loads, vertices=size, algorithm=algorithm)
        for polygon, loads in ((ELONGATED, upwards(300, 4000, 0.03)), (HEXAGON, up))
        for algorithm in ALGORITHMS
        for size in SIZES
    ]
    over_starts = starts_and_steps()
    with processes() as pool:
        meshes = list(pool.map(locate, over_meshes))
        starts = dict(zip(over_starts, pool.map(locate, over_starts.values()), strict=True))
        hysteresis = pool.submit(locate, Case(HEXAGON, up + up[-2::-1], algorithm=5))
    for polygon in (ELONGATED, HEXAGON):
        click.echo(mesh_table(polygon, meshes))
    click.echo(starts_table(starts))
    click.echo(sequence_table(hysteresis.result()))
    tell_failures([*meshes, *starts.values(), hysteresis.result()])
    if path is not None:
        write_csv(path, meshes)


def tensioned(path: Path | None, film: str) -> None:
    """Print the tables of a film with a tension, on more polygons, with their limits.

    The loads are those of springs of the same effective tension.
    """
    scale = SPRING_TENSION / FILM_LOADS[film].tension_per_load
    cases = [
        Case(
            polygon,
            upwards(scale * 300, scale * (1500 if polygon == HEXAGON else 4000), 0.03),
            size,
            algorithm,
            film=film,
            width=FINE_WIDTH,
        )
        for polygon in POLYGONS
        for algorithm in ALGORITHMS
        for size in (*SIZES, FINEST)
    ]
    with processes() as pool:
        # The long ones first, so that no process is left with them.
        order = sorted(cases, key=lambda case: -case.vertices)
        found = dict(zip(order, pool.map(locate, order), strict=True))
    meshes = [found[case] for case in cases]
    for polygon in POLYGONS:
        click.echo(mesh_table(polygon, meshes))
    tell_failures(meshes)
    if path is not None:
        write_csv(path, meshes)


def tell_failures(every: list[Found]) -> None:
    """Print how many loads were solved, and each that did not converge."""
    failures = [text for found in every for text in found.failures]
    click.echo(f"{sum(f.solves for f in every)} loads, {len(failures)} not converged.\n")
    for text in failures:
        click.echo(f"- {text}")


def upwards(first: float, last: float, step: float) -> tuple[float, ...]:
    """Return loads from first to last, each `step` (a share) above the one before."""
    count = int(np.ceil(np.log(last / first) / np.log1p(step))) + 1
    return tuple(float(load) for load in np.geomspace(first, last, count))


def starts_and_steps() -> dict[str, Case]:
    """Return the stretched hexagon's case in every way of reaching its transitions."""
    up = upwards(300, 4000, 0.03)
    elongated = partial(Case, ELONGATED)
    return {
        "up from 300 by 3 %, seed 1, displacement 0.001": elongated(up),
        **{f"seed {seed}": elongated(up, seed=seed) for seed in (2, 3, 4, 5)},
        "displacement 0.000001": elongated(up, displacement=1e-6),
        "displacement 0.01": elongated(up, displacement=1e-2),
        "up by 0.5 %": elongated(upwards(300, 4000, 0.005)),
        "up by 10 %": elongated(upwards(300, 4000, 0.1)),
        "up from 1": elongated((1.0, *up)),
        "down from 4000, the flat polygon": elongated(up[::-1]),
        "down from 3000, the flat polygon": elongated(upwards(300, 3000, 0.03)[::-1]),
        "down again after going up to 4000": elongated(up + up[-2::-1]),
    }


def locate(case: Case) -> Found:
    """Sweep a case and bisect every change of state."""
    disk = make_mesh(
        polygon=POLYGONS[case.polygon], vertices=case.vertices, algorithm=case.algorithm
    )
    problem = Problem(disk, case.film)
    start = displaced(disk, case.displacement, case.seed)
    classify = partial(state, Measurer(disk))
    statuses = []

    def noted(found: Equilibrium) -> Equilibrium:
        statuses.append((found.load, found.status))
        return found

    def solve_next(load: float, last: Equilibrium) -> Equilibrium:
        return noted(solve(problem, load, last))

    transitions = [
        bisect(solve_next, classify, last, first, case.width)
        for last, first in pairwise(map(noted, sweep(problem, case.loads, start)))
        if classify(last) != classify(first)
    ]
    failures = tuple(
        f"{case.polygon}, algorithm {case.algorithm}, {disk.n_v} vertices, "
        f"load {load:.3f}: {status.value}"
        for load, status in statuses
        if status is not Status.CONVERGED
    )
    return Found(case, disk.n_v, disk.n_b, tuple(transitions), len(statuses), failures)


def bisect(
    solve_next: Callable[[float, Equilibrium], Equilibrium],
    classify: Callable[[Equilibrium], str],
    last: Equilibrium,
    first: Equilibrium,
    width: float,
) -> Transition:
    """Close the bracket around the change between the last shape and the first new one."""
    old, new = classify(last), classify(first)
    while abs(first.load - last.load) > width * last.load:
        found = solve_next(0.5 * (last.load + first.load), last)
        met = classify(found)
        if met == old:
            last = found
        else:
            new, first = met, found
    return Transition(old, new, last.load, first.load)


def state(measurer: Measurer, found: Equilibrium) -> str:
    """Tell the flat states from each other and from all others.

    A flat loop that winds twice has <K> = -2 pi (Gauss-Bonnet); half a turn of the film's
    normal across the waist makes an eight.
    """
    measured = measurer.measure(found.shape)
    if measured.abs_kappa_n > FLAT:
        return BENT
    if measured.total_gauss_curvature < -0.95 * 2 * np.pi:
        return DOUBLE
    return EIGHT if abs(measured.waist_twist) > 90 else DISK


if __name__ == "__main__":
    main()
