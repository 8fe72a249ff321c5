"""Locate the transitions of spring films on many meshes, and what they depend on.

A sweep starts from the flat polygon with a seeded displacement, every load from the last
shape. Where two neighbouring loads have different states, bisection, always from the last
shape before the change, closes the bracket around the transition.
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
from threadpoolctl import threadpool_limits

from eulerplateau.curvature import loop_frame, total_gauss_curvature
from eulerplateau.measures import WaistPath, waist_path, waist_twist
from eulerplateau.mesh import DiskMesh, FloatArray
from eulerplateau.newton import solve
from eulerplateau.parameters import validate
from eulerplateau.problem import Problem, make_problem
from eulerplateau.runs.spec import RunSpec
from eulerplateau.runs.sweep import Solver, make_mesh, start_shape, sweep
from eulerplateau.solution import Equilibrium, Status

# Contour integral of |kappa_n| up to which a film is flat. Flat films have 1e-12; near a
# transition it is 2 to 7 sqrt(load / onset - 1), which moves the onset by less than 1e-6.
FLAT = 1e-3
# Brackets are closed to this share of the load.
WIDTH = 1e-5

DISK, EIGHT, DOUBLE, BENT = "disk", "figure eight", "double disk", "not flat"
# Names of transitions, by the states below and above them.
LEAVES, LEAVES_AGAIN = "leaves the plane", "leaves the plane again"
FLAT_EIGHT, WOUND_TWICE = "flat eight", "jumps to the double disk"
NAMES = {
    (DISK, BENT): LEAVES,
    (BENT, EIGHT): FLAT_EIGHT,
    (EIGHT, BENT): LEAVES_AGAIN,
    (BENT, DOUBLE): WOUND_TWICE,
}

ELONGATED, HEXAGON = "hexagon stretched to twice its length", "regular hexagon"
POLYGONS: dict[str, dict[str, Any]] = {
    ELONGATED: {"kind": "stretched-hexagon", "factor": 2.0},
    HEXAGON: {"kind": "regular", "sides": 6},
}
ALGORITHMS = {5: "Delaunay", 6: "Frontal-Delaunay", 8: "Frontal-Delaunay for quads"}
SIZES = (474, 1000, 2000)
# What the paper reports; it does not mention the last one.
PAPER = {
    ELONGATED: {LEAVES: "643", FLAT_EIGHT: "740", LEAVES_AGAIN: "2000"},
    HEXAGON: {LEAVES: "855", WOUND_TWICE: "-"},
}
CSV_COLUMNS = (
    *("polygon", "algorithm", "vertices", "loop_edges"),
    *("from", "to", "last_load", "first_load", "paper"),
)


@dataclass(frozen=True)
class Case:
    """A polygon's mesh, a start, and the loads of the coarse sweep, in order."""

    polygon: str
    loads: tuple[float, ...]
    vertices: int = 474
    algorithm: int = 6
    seed: int = 1
    displacement: float = 1e-3


@dataclass(frozen=True)
class Transition:
    """A change of state between two loads, in the order of the sweep."""

    before: str
    after: str
    last: float
    first: float

    @property
    def rising(self) -> bool:
        """Whether it was met on the way up."""
        return self.last < self.first

    @property
    def name(self) -> str | None:
        """What it is called, whichever way it was met."""
        states = (self.before, self.after)
        return NAMES.get(states if self.rising else states[::-1])


@dataclass(frozen=True)
class Found:
    """What a case came to: its mesh, and its transitions in the order of the sweep."""

    case: Case
    n_v: int
    n_b: int
    transitions: tuple[Transition, ...]
    solves: int
    failures: tuple[str, ...]


@click.command()
@click.option("--csv", "path", type=click.Path(path_type=Path), help="Also write a CSV.")
def main(path: Path | None) -> None:
    """Print the transitions over meshes, and over starts and steps, as Markdown."""
    up = upwards(300, 1500, 0.03)
    over_meshes = [
        Case(polygon, loads, vertices=size, algorithm=algorithm)
        for polygon, loads in ((ELONGATED, upwards(300, 4000, 0.03)), (HEXAGON, up))
        for algorithm in ALGORITHMS
        for size in SIZES
    ]
    over_starts = starts_and_steps()
    with ProcessPoolExecutor(initializer=partial(threadpool_limits, 1)) as pool:
        meshes = list(pool.map(locate, over_meshes))
        starts = dict(zip(over_starts, pool.map(locate, over_starts.values()), strict=True))
        hysteresis = pool.submit(locate, Case(HEXAGON, up + up[-2::-1], algorithm=5))
    click.echo(mesh_table(ELONGATED, meshes))
    click.echo(mesh_table(HEXAGON, meshes))
    click.echo(starts_table(starts))
    click.echo(sequence_table(hysteresis.result()))
    every = [*meshes, *starts.values(), hysteresis.result()]
    failures = [text for found in every for text in found.failures]
    click.echo(f"{sum(f.solves for f in every)} loads, {len(failures)} not converged.")
    for text in failures:
        click.echo(f"- {text}")
    if path is not None:
        write_csv(path, meshes)


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
    settings = {
        "mesh": {
            "polygon": POLYGONS[case.polygon],
            "vertices": case.vertices,
            "algorithm": case.algorithm,
        },
        "start": {"seed": case.seed, "displacement": case.displacement},
        "sweep": {"loads": list(case.loads)},
    }
    spec = validate(settings, RunSpec, "case")
    mesh = make_mesh(spec)
    problem, classify = make_problem(mesh), partial(state, mesh, waist_path(mesh))
    statuses = []

    def recorded(*arguments: Any) -> Equilibrium:
        found = solve(*arguments)
        statuses.append((found.load, found.status))
        return found

    shapes = sweep(problem, start_shape(spec, mesh), case.loads, recorded)
    transitions = [
        bisect(problem, recorded, classify, last, first)
        for last, first in pairwise(shapes)
        if classify(last.x) != classify(first.x)
    ]
    failures = tuple(
        f"{case.polygon}, algorithm {case.algorithm}, {mesh.n_v} vertices, "
        f"load {load:.3f}: {status.value}"
        for load, status in statuses
        if status is not Status.CONVERGED
    )
    return Found(case, mesh.n_v, mesh.n_b, tuple(transitions), len(statuses), failures)


def bisect(
    problem: Problem,
    solver: Solver,
    classify: Callable[[FloatArray], str],
    last: Equilibrium,
    first: Equilibrium,
) -> Transition:
    """Close the bracket around the change between the last shape and the first new one."""
    old, new = classify(last.x), classify(first.x)
    while abs(first.load - last.load) > WIDTH * last.load:
        middle = 0.5 * (last.load + first.load)
        found = solver(problem, last.x, last.multipliers, middle)
        met = classify(found.x)
        if met == old:
            last = found
        else:
            new, first = met, found
    return Transition(old, new, last.load, first.load)


def state(mesh: DiskMesh, path: WaistPath | None, x: FloatArray) -> str:
    """Tell the flat states from each other and from all others.

    A flat loop that winds twice has <K> = -2 pi (Gauss-Bonnet); half a turn of the film's
    normal across the waist makes an eight.
    """
    frame = loop_frame(mesh, x)
    if float(np.abs(frame.kappa_n) @ frame.mean_lengths) > FLAT:
        return BENT
    if total_gauss_curvature(mesh, x) < -0.95 * 2 * np.pi:
        return DOUBLE
    return EIGHT if abs(waist_twist(path, x)) > 90 else DISK


def mesh_table(polygon: str, meshes: Iterable[Found]) -> str:
    """Return the Markdown table of a polygon: a row for each mesh."""
    paper = PAPER[polygon]
    rows = [["algorithm", "vertices", "loop edges", *paper]]
    for found in meshes:
        if found.case.polygon == polygon:
            name = f"{found.case.algorithm} ({ALGORITHMS[found.case.algorithm]})"
            rows.append([name, str(found.n_v), str(found.n_b), *cells(found, paper)])
    rows.append(["paper", "474", "", *paper.values()])
    return f"\n## {polygon.capitalize()}\n\n{markdown(rows)}"


def starts_table(starts: dict[str, Found]) -> str:
    """Return the Markdown table of the ways to reach the same transitions."""
    names = PAPER[ELONGATED]
    rows = [["start and sweep", *names]]
    rows += [[label, *cells(found, names)] for label, found in starts.items()]
    return f"\n## Starts and sweeps\n\n{markdown(rows)}"


def sequence_table(found: Found) -> str:
    """Return the Markdown table of everything that one sweep went through."""
    rows = [["direction", "from", "to", "load"]]
    rows += [
        ["up" if t.rising else "down", t.before, t.after, cell(t)]
        for t in found.transitions
    ]
    title = f"{found.case.polygon.capitalize()}, algorithm {found.case.algorithm}"
    return f"\n## {title}, up and down\n\n{markdown(rows)}"


def cells(found: Found, names: Iterable[str]) -> list[str]:
    """Return where the sweep last met each transition."""
    met = {t.name: cell(t) for t in found.transitions}
    return [met.get(name, "-") for name in names]


def cell(transition: Transition) -> str:
    """Return the middle of the bracket and half its width."""
    middle = 0.5 * (transition.last + transition.first)
    return f"{middle:.3f} ± {abs(transition.first - middle):.3f}"


def markdown(rows: list[list[str]]) -> str:
    """Return rows, the first of which is the head, as a Markdown table."""
    rule = ["---"] + ["---:"] * (len(rows[0]) - 1)
    lines = ["| " + " | ".join(row) + " |" for row in (rows[0], rule, *rows[1:])]
    return "\n".join(lines) + "\n"


def write_csv(path: Path, meshes: Iterable[Found]) -> None:
    """Write one row for each transition on each mesh."""
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(CSV_COLUMNS)
        for found in meshes:
            case, paper = found.case, PAPER[found.case.polygon]
            mesh = [case.polygon, case.algorithm, found.n_v, found.n_b]
            for t in found.transitions:
                known = paper.get(t.name or "", "-")
                table.writerow([*mesh, t.before, t.after, t.last, t.first, known])


if __name__ == "__main__":
    main()
