"""What is measured: a record a run, a point of all its repeats."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass, fields, replace
from itertools import groupby, pairwise
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from scripts.studies.error_vs_time.arithmetic import richardson
from scripts.studies.error_vs_time.scenes import SCENES

COARSE_TO_FINE = ", coarse to fine"
CORRECTED = ", corrected"
EXTRAPOLATED = ", extrapolated"
# The "mesh" of a solver that has none; its loop_edges are harmonics, in the plane a lobe's.
HARMONICS = "harmonics"


@dataclass(frozen=True)
class Measurement:
    """One repeat of one point.

    Attributes
    ----------
    loop_edges, vertices : int
        Of the mesh; without one, the harmonics and the unknowns.
    set_up, solve : float
        Wall seconds. Of Evolver, set_up is its start with reading the datafiles.
    cpu : float
        CPU seconds of both together, by which the tools are compared.
    start_up : float
        CPU seconds of interpreter, imports and compiled kernels, not in the others.
    memory : float
        Peak resident memory, MiB.
    value : float
        The energy, or the threshold where that is what is sought.
    error : float
        Of the value, relative.
    shape_error : float
        Root mean square distance from the exact loop, in L; where only a limit is known,
        the relative error of the loop's radius of gyration.
    area_error, bending_error : float
        Relative, of exact scenes; nan of others, and of tools that do not tell them apart.
    """

    scene: str
    film: str
    solver: str
    mesh: str
    loop_edges: int
    vertices: int
    repeat: int
    set_up: float
    solve: float
    cpu: float
    start_up: float
    iterations: int
    memory: float
    value: float
    gyration: float
    error: float
    shape_error: float
    status: str
    area_error: float = math.nan
    bending_error: float = math.nan

    @property
    def worst_error(self) -> float:
        """The worst of the errors of area, bending energy and shape; nan if one is."""
        return float(np.max([self.area_error, self.bending_error, self.shape_error]))


@dataclass(frozen=True)
class Point:
    """A point's repeats in one: medians, and the spread of the CPU seconds."""

    first: Measurement
    cpu: float
    least: float
    most: float
    wall: float
    memory: float

    @property
    def ladder(self) -> tuple[str, str, str]:
        """The scene, solver and kind of mesh: one after the other, meshes get finer."""
        return self.first.scene, self.first.solver, self.first.mesh


def with_errors(scene: list[Measurement]) -> list[Measurement]:
    """Return the measurements of one scene with their errors filled in.

    The reference is exact, or else the limit of newton's values under uniform refinement
    (graded meshes do not refine their middle at first); without one the errors stay nan.
    """
    answer = SCENES[scene[0].scene].answer
    if answer is not None:
        return [replace(m, error=abs(m.value / answer - 1)) for m in scene]
    newton = [m for m in scene if m.solver == "newton" and m.repeat == 0]
    ladder = [m for m in newton if m.mesh != "graded"]
    try:
        energy = richardson([m.value for m in ladder]).value
        size = richardson([m.gyration for m in ladder]).value
    except ValueError:
        return scene
    return [
        replace(
            m,
            error=abs(m.value / energy - 1),
            shape_error=abs(m.gyration / size - 1),
        )
        for m in scene
    ]


def points(found: Iterable[Measurement]) -> list[Point]:
    """Return the points that converged and whose error is known, as measured."""

    def key(m: Measurement) -> tuple[str, str, str, int]:
        return m.scene, m.solver, m.mesh, m.loop_edges

    grouped = [list(group) for _, group in groupby(found, key)]
    return [
        Point(
            first=group[0],
            cpu=median(m.cpu for m in group),
            least=min(m.cpu for m in group),
            most=max(m.cpu for m in group),
            wall=median(m.set_up + m.solve for m in group),
            memory=max(
                (m.memory for m in group if not math.isnan(m.memory)), default=math.nan
            ),
        )
        for group in grouped
        if group[0].status == "converged" and not math.isnan(group[0].error)
    ]


def extrapolated(known: list[Point]) -> list[Point]:
    """Return what two meshes, one twice as fine, give together: (4 fine - coarse) / 3.

    The error of order h^2 cancels; harmonics, and what is corrected, have none. The cost is
    both points', or the fine one's where it came from the coarse one. Only where the answer
    is known exactly, for any tool alike.
    """
    found = []
    for coarse, fine in pairwise(known):
        a, b = coarse.first, fine.first
        answer = SCENES[b.scene].answer
        same = (a.scene, a.solver, a.mesh) == (b.scene, b.solver, b.mesh)
        if (
            answer is None
            or b.mesh == HARMONICS
            or b.solver.endswith(CORRECTED)
            or not same
            or b.loop_edges != 2 * a.loop_edges
        ):
            continue
        value = (4 * b.value - a.value) / 3
        first = replace(
            b,
            solver=b.solver + EXTRAPOLATED,
            value=value,
            error=abs(value / answer - 1),
            shape_error=math.nan,
        )
        if not b.solver.endswith(COARSE_TO_FINE):
            fine = replace(
                fine,
                cpu=fine.cpu + coarse.cpu,
                least=fine.least + coarse.least,
                most=fine.most + coarse.most,
                wall=fine.wall + coarse.wall,
            )
        found.append(replace(fine, first=first))
    return found


def write_csv(path: Path, found: list[Measurement]) -> None:
    """Write every repeat of every point."""
    with path.open("w", newline="", encoding="ascii") as file:
        names = [field.name for field in fields(Measurement)]
        writer = csv.DictWriter(file, names, lineterminator="\n")
        writer.writeheader()
        for m in found:
            row = {
                name: f"{value:.6g}" if isinstance(value, float) else value
                for name, value in asdict(m).items()
            }
            writer.writerow(row | {"value": repr(m.value)})


def read_csv(path: Path) -> list[Measurement]:
    """Return what a table holds that `write_csv` has written, to its six digits."""
    kinds: dict[Any, Any] = {"int": int, "float": float, "str": str}
    with path.open(newline="", encoding="ascii") as file:
        return [
            Measurement(
                **{
                    field.name: kinds[field.type](row[field.name])
                    for field in fields(Measurement)
                    if field.name in row  # older tables have fewer
                }
            )
            for row in csv.DictReader(file)
        ]
