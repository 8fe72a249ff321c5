"""Error against run time: films, solvers and meshes, and Surface Evolver beside them.

Every scene (error_scenes.py) is computed on meshes of growing fineness by every solver that
can, from the same start. A point is repeated in one process, whose peak memory it is;
making the problem (set-up, with the film's condensation) and solving it are timed apart.
Not counted for ours: the interpreter's start, imports and compiled kernels (start_up), and
making the mesh. Evolver is charged for its whole process, reading its datafile included,
but not for writing it nor for carrying a shape from mesh to mesh.
"""

from __future__ import annotations

import json
import math
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import click
import numpy as np
from error_conformal import (
    CONFORMAL,
    TANGENT_ANGLE,
    ladder,
    mesh_free,
    mesh_free_repeats,
    unknowns,
)
from error_measure import ENOUGH, REPEATS, distance, repeated
from error_records import COARSE_TO_FINE, HARMONICS, Measurement, with_errors, write_csv
from error_report import draw, markdown
from error_scenes import SCENES, Scene, gyration, prolong
from evolver import EvolverRun, find_evolver, relax, run_evolver
from evolver_files import film_datafile, gradient_script, start_script, string_datafile

from eulerplateau.mesh.disk import DiskMesh

# Seconds beyond ENOUGH after which a solver is given up, on finer meshes too: 20 s in all.
TOO_SLOW = 10.0
# Loop edges of the meshes, each twice as fine as the one before.
LEVELS = {"uniform": 4, "graded": 5, "fan": 5, "lattice": 4}
COARSEST = 36
# Without its interior a film's loop of 36 edges leads Evolver astray.
COARSEST_IN_PLANE = 72
SOLVERS = ("newton", "cg", CONFORMAL, TANGENT_ANGLE)


class Place(NamedTuple):
    """Where a point is computed: see Measurement."""

    kind: str
    loop_edges: int
    vertices: int


@click.group(invoke_without_command=True)
@click.option("--scene", "names", multiple=True, type=click.Choice(list(SCENES)))
@click.option("--out", default="docs", type=click.Path(path_type=Path, file_okay=False))
@click.pass_context
def main(context: click.Context, names: tuple[str, ...], out: Path) -> None:
    """Measure all scenes, or those named; write error_vs_time.csv and .png to OUT."""
    if context.invoked_subcommand is not None:
        return
    out.mkdir(parents=True, exist_ok=True)
    found: list[Measurement] = []
    with TemporaryDirectory() as folder:
        for name in names or SCENES:
            found += with_errors(list(measure_scene(SCENES[name], Path(folder))))
            write_csv(out / "error_vs_time.csv", found)
    draw(out / "error_vs_time.png", found)
    click.echo(markdown(found))


@main.command()
@click.argument("meshes", nargs=-1, type=click.Path(path_type=Path, exists=True))
@click.option("--scene", required=True, type=click.Choice(list(SCENES)))
@click.option("--solver", required=True, type=click.Choice(SOLVERS))
@click.option("--harmonics", default=0, help="In place of meshes.")
def point(meshes: tuple[Path, ...], scene: str, solver: str, harmonics: int) -> None:
    """Measure one point in this process and print its repeats as JSON.

    Solved on the last of the meshes, coming from the ones before it.
    """
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, user_api="blas"):
        if solver in (CONFORMAL, TANGENT_ANGLE):
            records = mesh_free_repeats(SCENES[scene], harmonics)
        else:
            sequence = [read_mesh(path) for path in meshes]
            records = repeated(sequence, SCENES[scene], solver)
        for record in records:
            click.echo(json.dumps(record))


def kinds(scene: Scene) -> tuple[str, ...]:
    """Return the kinds of meshes that make a difference in a scene."""
    if scene.film == "springs":  # they have a limit on nested lattices only
        return ("lattice",)
    return ("fan",) if scene.in_plane else ("uniform", "graded")


def solvers(scene: Scene) -> tuple[str, ...]:
    """Return the solvers of ours that can do a scene; cg only films of fixed weights."""
    if scene.threshold is not None:
        return ("newton",)
    from_coarse = f"newton{COARSE_TO_FINE}"
    return (
        ("newton", from_coarse) if scene.film == "area" else ("newton", from_coarse, "cg")
    )


def measure_scene(scene: Scene, folder: Path) -> Iterator[Measurement]:
    """Yield every repeat of every point of a scene."""
    if scene.film == "area" and scene.threshold is None:
        yield from measure_mesh_free(scene)
    for kind in kinds(scene):
        coarsest = COARSEST_IN_PLANE if scene.in_plane else COARSEST
        levels = 4 if scene.in_plane else LEVELS[kind]
        meshes = [scene.mesh(kind, coarsest * 2**level) for level in range(levels)]
        paths = [folder / f"{number}.npz" for number in range(levels)]
        for path, mesh in zip(paths, meshes, strict=True):
            write_mesh(path, mesh)
        for solver in solvers(scene):
            for last, mesh in enumerate(meshes):
                first = 0 if solver.endswith(COARSE_TO_FINE) else last
                place = Place(kind, mesh.n_b, mesh.n_v)
                records = run_point(paths[first : last + 1], scene, solver)
                yield from (as_measurement(scene, solver, place, r) for r in records)
                summarise(scene, solver, place, records)
                if not records or records[-1]["cpu"] > ENOUGH:
                    break
        with_evolver = scene.film == "area" and scene.threshold is None
        if with_evolver and find_evolver() is not None:
            yield from measure_evolver(scene, kind, meshes)


def measure_mesh_free(scene: Scene) -> Iterator[Measurement]:
    """Yield every repeat without a mesh."""
    solver = mesh_free(scene)
    for harmonics in ladder(scene):
        place = Place(HARMONICS, harmonics, unknowns(scene, harmonics))
        options = ("--harmonics", str(harmonics))
        records = run_point([], scene, solver, *options)
        yield from (as_measurement(scene, solver, place, r) for r in records)
        summarise(scene, solver, place, records)


def run_point(
    meshes: list[Path], scene: Scene, solver: str, *options: str
) -> list[dict[str, Any]]:
    """Run one point in a process of its own; nothing if it takes too long."""
    command = [sys.executable, __file__, "point", *map(str, meshes), *options]
    command += ["--scene", scene.name, "--solver", solver.removesuffix(COARSE_TO_FINE)]
    try:
        done = subprocess.run(
            command, stdout=subprocess.PIPE, check=True, timeout=ENOUGH + TOO_SLOW
        )
    except subprocess.TimeoutExpired as late:
        printed = late.stdout or b""
    else:
        printed = done.stdout
    return [json.loads(line) for line in printed.splitlines()]


def measure_evolver(
    scene: Scene, kind: str, meshes: list[DiskMesh]
) -> Iterator[Measurement]:
    """Yield Evolver's repeats, directly on each mesh and coarse to fine."""
    describe = string_datafile if scene.in_plane else film_datafile
    for name in ("evolver", f"evolver{COARSE_TO_FINE}"):
        for last, mesh in enumerate(meshes):
            place = Place(kind, mesh.n_b, mesh.n_v)
            sequence = meshes[: last + 1] if name != "evolver" else [mesh]
            reading = 0.0
            for level in sequence:
                data = describe(level, scene.start(level), scene.load)
                reading += run_evolver(data, start_script(scene.in_plane)).wall
            records = []
            for repeat in range(REPEATS):
                records.append(evolver_record(scene, sequence, repeat, reading))
                if sum(record["cpu"] for record in records) > ENOUGH:
                    break
            yield from (as_measurement(scene, name, place, r) for r in records)
            summarise(scene, name, place, records)
    if not scene.in_plane and kind == "uniform":
        mesh = meshes[1]
        place = Place(kind, mesh.n_b, mesh.n_v)
        data = film_datafile(mesh, scene.start(mesh), scene.load)
        run = run_evolver(data, gradient_script(TOO_SLOW), seconds=2 * TOO_SLOW)
        record = as_record(scene, mesh, run, 0, 0.0)
        yield as_measurement(scene, "evolver, gradients", place, record)
        summarise(scene, "evolver, gradients", place, [record])


def evolver_record(
    scene: Scene, sequence: list[DiskMesh], repeat: int, reading: float
) -> dict[str, Any]:
    """Run Evolver once; its memory is asked for in the first repeat only."""
    x = scene.start(sequence[0])
    try:
        run = relax(
            sequence, x, scene.load, prolong, in_plane=scene.in_plane, weigh=repeat == 0
        )
    except ValueError:
        nan, nowhere = math.nan, np.full((sequence[-1].n_b, 3), math.nan)
        run = EvolverRun(nan, nowhere, 0, nan, nan, nan, converged=False)
    return as_record(scene, sequence[-1], run, repeat, reading)


def as_record(
    scene: Scene, mesh: DiskMesh, run: EvolverRun, repeat: int, reading: float
) -> dict[str, Any]:
    """Return Evolver's run as a record; `reading`: seconds of starting and reading."""
    reached = math.nan
    if run.converged:
        reached = distance(scene, mesh.rest_lengths, run.loop)
    return {
        "repeat": repeat,
        "set_up": reading,
        "solve": run.wall - reading,
        "cpu": run.cpu,
        "start_up": 0.0,
        "iterations": run.steps,
        "memory": run.memory,
        "value": run.energy,
        "gyration": gyration(mesh.rest_lengths, run.loop),
        "shape_error": reached,
        "status": "converged" if run.converged else "failed",
    }


def as_measurement(
    scene: Scene, solver: str, place: Place, record: dict[str, Any]
) -> Measurement:
    """Return a record with the point it belongs to; its error is not known yet."""
    return Measurement(
        scene=scene.name,
        film=scene.film,
        solver=solver,
        mesh=place.kind,
        loop_edges=place.loop_edges,
        vertices=place.vertices,
        error=math.nan,
        **record,
    )


def summarise(
    scene: Scene, solver: str, place: Place, records: list[dict[str, Any]]
) -> None:
    """Tell what a point came to, on standard error."""
    cost = f"{np.median([r['cpu'] for r in records]):.4f} s" if records else "too slow"
    state = records[-1]["status"] if records else "given up"
    where = f"{solver}, {place.kind}, {place.loop_edges} edges, {place.vertices} vertices"
    click.echo(f"{scene.name}: {where}: {cost}, {state}", err=True)


def write_mesh(path: Path, mesh: DiskMesh) -> None:
    """Hand a mesh to another process, to the last bit."""
    np.savez(
        path, x=mesh.x, triangles=mesh.triangles, loop=mesh.loop, rest=mesh.rest_lengths
    )


def read_mesh(path: Path) -> DiskMesh:
    """Return the mesh that `write_mesh` wrote."""
    data = np.load(path)
    return DiskMesh(data["x"], data["triangles"], data["loop"], data["rest"], 1.0)


if __name__ == "__main__":
    main()
