"""What runs in a process of its own: our solvers on one point."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any, TypeVar

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Disk, Shape
from eulerplateau.solvers import (
    Corrected,
    Equilibrium,
    Problem,
    Status,
    corrected,
    solve,
)
from scripts.studies.common import peak_memory
from scripts.studies.error_vs_time.records import CORRECTED
from scripts.studies.error_vs_time.scenes import (
    Scene,
    gyration,
    lattice,
    prolong,
    shape_error,
)
from scripts.studies.error_vs_time.thresholds import disk_threshold

Found = TypeVar("Found")

REPEATS = 5
# Seconds after which a point is not repeated again: points of 2 s are repeated in full.
ENOUGH = 10.0


def repeated(meshes: list[Disk], scene: Scene, solver: str) -> Iterator[dict[str, Any]]:
    """Yield what each repeat of a point cost and came to."""
    # Loads the compiled kernels and whatever is imported late.
    solved([lattice(3, 1.0)], replace(scene, load=1.0, threshold=None), solver)
    run = partial(solved, meshes, scene, solver)
    return timed(run, partial(what, scene, meshes[-1]))


def timed(
    run: Callable[[], tuple[Found, float, float]],
    describe: Callable[[Found], dict[str, Any]],
) -> Iterator[dict[str, Any]]:
    """Yield what each repeat of `run` cost and came to, which `describe` says.

    It returns what was found and the wall seconds of set-up and solving.
    """
    start_up, began = time.process_time(), time.perf_counter()
    for repeat in range(REPEATS):
        cpu = time.process_time()
        found, set_up, seconds = run()
        cpu = time.process_time() - cpu
        yield {
            "repeat": repeat,
            "set_up": set_up,
            "solve": seconds,
            "cpu": cpu,
            "start_up": start_up,
            "memory": peak_memory(),
            **describe(found),
        }
        if time.perf_counter() - began > ENOUGH:
            return


def solved(
    meshes: list[Disk], scene: Scene, solver: str
) -> tuple[Equilibrium | Corrected | tuple[float, int], float, float]:
    """Return what is found on the last mesh, and the wall seconds of set-up and solving.

    Carrying the shape from mesh to mesh counts as solving, and so does correcting.
    """
    x, found, steps = scene.start(meshes[0]), None, 0
    set_up, started = 0.0, time.perf_counter()
    for number, mesh in enumerate(meshes):
        if found is not None:
            before = meshes[number - 1]
            x = prolong(before, found.shape.x_loop, mesh, scene.in_plane)
        making = time.perf_counter()
        problem = Problem(mesh, scene.film, in_plane=scene.in_plane)
        if scene.film != "area":
            problem.film.of_loop(mesh.shape)
        set_up += time.perf_counter() - making
        if scene.threshold is not None:
            threshold = disk_threshold(problem, scene.transverse)
            return threshold, set_up, time.perf_counter() - started - set_up
        if scene.saddle:
            found = saddle_in_plane(problem, problem.shape(x), scene.load)
        else:
            method = solver.removesuffix(CORRECTED)
            found = solve(problem, scene.load, x, solver=method)
        steps += found.iterations
    assert found is not None
    result: Equilibrium | Corrected = replace(found, iterations=steps)
    if solver.endswith(CORRECTED) and found.converged:
        result = corrected(problem, found)
    total = time.perf_counter() - started
    return result, set_up, total - set_up


def saddle_in_plane(problem: Problem, start: Shape, load: float) -> Equilibrium:
    """Return the equilibrium next to a start in the plane, whatever its index.

    What lies inside stays where it was: in its plane the film is its polygon.
    """
    from eulerplateau.solvers.in_plane.newton import settle_in_plane

    film = problem.film.of_loop(start)
    flat = settle_in_plane(problem.loop, load, film.project(start.x_loop), 100)
    if flat is None:
        nothing = np.zeros(len(start.loop))
        return problem.equilibrium(start, nothing, load, Status.STALLED)
    x = start.x.copy()
    x[start.loop] = film.lift(flat.x)
    shape = start.moved(x)
    found = problem.equilibrium(shape, flat.tensions, load, Status.CONVERGED)
    return replace(found, iterations=flat.iterations)


def what(
    scene: Scene, mesh: Disk, found: Equilibrium | Corrected | tuple[float, int]
) -> dict[str, Any]:
    """Return the part of a record that says what was found, not what it cost."""
    if isinstance(found, tuple):
        value, loads = found
        return {
            "value": value,
            "iterations": loads,
            "gyration": math.nan,
            "shape_error": math.nan,
            "status": "converged",
        }
    loop = found.shape.x_loop
    solved = found.found if isinstance(found, Corrected) else found
    return {
        "value": found.energy,
        "iterations": solved.iterations,
        "gyration": gyration(mesh.rest_lengths, loop),
        "shape_error": distance(scene, mesh.rest_lengths, loop),
        "status": solved.status.value,
        **scene.parts(
            (found.energy - found.bending_energy) / scene.load, found.bending_energy
        ),
    }


def distance(scene: Scene, lengths: FloatArray, loop: FloatArray) -> float:
    """Return the error of the shape (n_b, 3) where it is known exactly, else nan."""
    return math.nan if scene.exact is None else shape_error(lengths, loop, scene.exact)
