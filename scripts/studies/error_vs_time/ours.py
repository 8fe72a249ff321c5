"""Points of our solvers, each measured in a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from eulerplateau.mesh import Disk
from scripts.studies.error_vs_time.conformal import ladder, mesh_free, unknowns
from scripts.studies.error_vs_time.measure import ENOUGH
from scripts.studies.error_vs_time.points import TOO_SLOW, Place, as_measurement, summarise
from scripts.studies.error_vs_time.records import (
    COARSE_TO_FINE,
    CORRECTED,
    HARMONICS,
    Measurement,
)
from scripts.studies.error_vs_time.scenes import Scene


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
    if scene.film != "area":
        return ("newton", from_coarse, "cg")
    if scene.in_plane:
        return ("newton", from_coarse)
    return ("newton", from_coarse, f"newton{CORRECTED}")


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
    command = [
        sys.executable,
        "-P",
        "-m",
        __package__,
        "point",
        *map(str, meshes),
        *options,
    ]
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


def write_mesh(path: Path, mesh: Disk) -> None:
    """Hand a mesh to another process, to the last bit."""
    np.savez(
        path, x=mesh.x, triangles=mesh.triangles, loop=mesh.loop, rest=mesh.rest_lengths
    )


def read_mesh(path: Path) -> Disk:
    """Return the mesh that `write_mesh` wrote."""
    data = np.load(path)
    return Disk(data["x"], data["triangles"], data["loop"], data["rest"], 1.0)
