"""Points of Surface Evolver's."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from eulerplateau.mesh import Disk
from scripts.studies.error_vs_time.evolver import EvolverRun, relax, run_evolver
from scripts.studies.error_vs_time.evolver_files import (
    film_datafile,
    gradient_script,
    start_script,
    string_datafile,
)
from scripts.studies.error_vs_time.measure import ENOUGH, REPEATS, distance
from scripts.studies.error_vs_time.points import TOO_SLOW, Place, as_measurement, summarise
from scripts.studies.error_vs_time.records import COARSE_TO_FINE, Measurement
from scripts.studies.error_vs_time.scenes import Scene, gyration, prolong


def measure_evolver(scene: Scene, kind: str, meshes: list[Disk]) -> Iterator[Measurement]:
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
                if not sum(record["cpu"] for record in records) <= ENOUGH:
                    break  # nor where it failed: then that is no number
            yield from (as_measurement(scene, name, place, r) for r in records)
            summarise(scene, name, place, records)
            if not records[-1]["cpu"] <= ENOUGH:
                break  # as ours: finer meshes take longer still
    if not scene.in_plane and kind == "uniform":
        mesh = meshes[1]
        place = Place(kind, mesh.n_b, mesh.n_v)
        data = film_datafile(mesh, scene.start(mesh), scene.load)
        script = gradient_script(TOO_SLOW)
        run = _tried(lambda: run_evolver(data, script, seconds=2 * TOO_SLOW), mesh)
        record = as_record(scene, mesh, run, 0, 0.0)
        yield as_measurement(scene, "evolver, gradients", place, record)
        summarise(scene, "evolver, gradients", place, [record])


def evolver_record(
    scene: Scene, sequence: list[Disk], repeat: int, reading: float
) -> dict[str, Any]:
    """Run Evolver once; its memory is asked for in the first repeat only."""
    x = scene.start(sequence[0])
    how = {"in_plane": scene.in_plane, "weigh": repeat == 0}
    run = _tried(lambda: relax(sequence, x, scene.load, prolong, **how), sequence[-1])
    return as_record(scene, sequence[-1], run, repeat, reading)


def _tried(run: Callable[[], EvolverRun], mesh: Disk) -> EvolverRun:
    """Return what Evolver came to; one that was stopped, or failed, came to nothing."""
    try:
        return run()
    except ValueError:
        nan, nowhere = math.nan, np.full((mesh.n_b, 3), math.nan)
        return EvolverRun(nan, nan, nowhere, 0, nan, nan, nan, converged=False)


def as_record(
    scene: Scene, mesh: Disk, run: EvolverRun, repeat: int, reading: float
) -> dict[str, Any]:
    """Return Evolver's run as a record; `reading`: seconds of starting and reading."""
    reached = bending = math.nan
    if run.converged:
        reached = distance(scene, mesh.rest_lengths, run.loop)
        bending = run.bending
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
        **scene.parts((run.energy - bending) / scene.load, bending),
    }
