"""Run the cases of the benchmark, each in a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click
import numpy as np
from threadpoolctl import threadpool_limits

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Disk
from eulerplateau.solvers import SOLVERS, Equilibrium, Problem, displaced, solve
from scripts.studies.benchmark.report import draw, read_csv, report, summary, write_csv
from scripts.studies.common import make_mesh, peak_memory

SIZES = (474, 2000, 7500, 50_000, 200_000)
COLD, WARM = 700.0, 710.0
# A solver that has not finished the cold task after so many CPU seconds is run no further.
SECONDS = 300.0
REPEATS = {"cg-plain": 3, "cg": 5, "newton": 5}

Result = TypeVar("Result")


class OutOfTimeError(Exception):
    """Raised from a report when the time is used up."""


class Watch:
    """Collects (CPU seconds, error) of a solver's reports; judging is not counted."""

    def __init__(self, problem: Problem, load: float, answer: float) -> None:
        energy = problem.film.of_loop(problem.disk.shape).energy(problem.loop, load)
        self.film = energy.terms["film"]
        self.problem, self.answer = problem, answer
        self.points: list[tuple[float, float]] = []
        self.started = time.process_time()

    def __call__(self, x_loop: FloatArray) -> None:
        """Judge the loop (n_b, 3) that a solver reports."""
        now = time.process_time()
        film = self.film.change(np.zeros_like(x_loop), x_loop)
        off = abs((film + self.problem.loop.bending_energy(x_loop)) / self.answer - 1)
        error = max(off, self.problem.loop.length_error(x_loop))
        self.points.append((now - self.started, error))
        if now - self.started > SECONDS:
            raise OutOfTimeError
        self.started += time.process_time() - now


@click.group(invoke_without_command=True)
@click.option("--sizes", default=",".join(map(str, SIZES)), help="Numbers of vertices.")
@click.option("--out", default="docs", type=click.Path(path_type=Path, file_okay=False))
@click.option(
    "--from",
    "table",
    type=click.Path(path_type=Path, dir_okay=False, exists=True),
    help="Only draw benchmark.png to OUT, from a benchmark.csv; nothing is measured.",
)
@click.pass_context
def main(context: click.Context, sizes: str, out: Path, table: Path | None) -> None:
    """Run all cases and write benchmark.md, benchmark.csv and benchmark.png to OUT."""
    if context.invoked_subcommand is not None:
        return
    if table is not None:
        draw(out / "benchmark.png", read_csv(table))
        return
    cases = []
    alive = set(SOLVERS)
    for size in map(int, sizes.split(",")):
        for solver in sorted(alive):
            case = run_apart(size, solver)
            cases.append(case)
            if not case["finished"]:
                alive.discard(solver)
            click.echo(summary(case), err=True)
    out.mkdir(parents=True, exist_ok=True)
    write_csv(out / "benchmark.csv", cases)
    (out / "benchmark.md").write_text(report(cases), encoding="utf-8")
    draw(out / "benchmark.png", cases)
    click.echo(report(cases))


@main.command()
@click.argument("size", type=int)
@click.argument("solver", type=click.Choice(sorted(SOLVERS)))
def case(size: int, solver: str) -> None:
    """Run one case in this process and print it as JSON."""
    with threadpool_limits(1, user_api="blas"):
        click.echo(json.dumps(measure(size, solver)))


def run_apart(size: int, solver: str) -> dict[str, Any]:
    """Run a case in a process of its own."""
    command = [sys.executable, "-P", "-m", __package__, "case", str(size), solver]
    done = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def measure(size: int, solver: str) -> dict[str, Any]:
    """Return set-up times, peak memory and the runs of both tasks."""
    mesh = hexagon(size)
    problem, set_up = timed(lambda: Problem(mesh))
    _, condensed = timed(lambda: problem.film.of_loop(mesh.shape))
    flat = displaced(mesh, 1e-3, 1)
    cold = solve(problem, COLD, flat)
    warm = solve(problem, WARM, cold)
    tasks: dict[str, tuple[FloatArray | Equilibrium, Equilibrium]] = {
        "cold": (flat, cold),
        "warm": (cold, warm),
    }
    runs = []
    for task, (start, answer) in tasks.items():
        for repeat in range(REPEATS[solver]):
            run = timed_run(problem, solver, start, answer)
            runs.append({"task": task, "repeat": repeat, **run})
            if run["seconds"] > 0.2 * SECONDS:
                break
        if runs[-1]["status"] == "out of time":
            break
    return {
        "vertices": mesh.n_v,
        "loop_edges": mesh.n_b,
        "solver": solver,
        "set_up": set_up + condensed,
        "memory": peak_memory() / 1024,
        "finished": runs[-1]["status"] != "out of time",
        "runs": runs,
    }


def hexagon(size: int) -> Disk:
    """Return the x2.0 hexagon with about `size` vertices."""
    polygon = {"kind": "stretched-hexagon", "factor": 2.0}
    return make_mesh(polygon=polygon, vertices=size, algorithm=6)


def timed(call: Callable[[], Result]) -> tuple[Result, float]:
    """Return what `call` returns, and the CPU seconds it took."""
    started = time.process_time()
    result = call()
    return result, time.process_time() - started


def timed_run(
    problem: Problem,
    solver: str,
    start: FloatArray | Equilibrium,
    answer: Equilibrium,
) -> dict[str, Any]:
    """Return one run: the whole solve's CPU seconds and the errors on the way."""
    watch = Watch(problem, answer.load, answer.energy)
    try:
        found = solve(problem, answer.load, start, solver=solver, observe=watch)
    except OutOfTimeError:
        seconds, error = watch.points[-1]
        return {
            "seconds": seconds,
            "points": watch.points,
            "status": "out of time",
            "iterations": None,
            "residual": None,
            "length_error": error,
        }
    return {
        "seconds": time.process_time() - watch.started,
        "points": watch.points,
        "status": found.status.value,
        "iterations": found.iterations,
        "residual": found.residual,
        "length_error": found.length_error,
    }


if __name__ == "__main__":
    main()
