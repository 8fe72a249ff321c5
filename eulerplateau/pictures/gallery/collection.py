"""What the gallery page shows: runs with their shapes, and the meshes these share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.pictures.of_run import pictures_of
from eulerplateau.runs import Run, ShapeSequence, read_runs


@dataclass(frozen=True)
class Mesh:
    """What the shapes of a run have in common, and often those of several runs.

    Only a soap film that was repaired has other triangles (ShapeSequence.tilings).

    Attributes
    ----------
    n_v : int, number of vertices
    triangles : (n_t, 3) int, counter-clockwise seen from the film's front
    loop : (n_b,) int, cyclic
    """

    n_v: int
    triangles: IntArray
    loop: IntArray

    def is_same(self, other: Mesh) -> bool:
        """Whether the two have the same vertices, triangles and loop."""
        return (
            self.n_v == other.n_v
            and np.array_equal(self.triangles, other.triangles)
            and np.array_equal(self.loop, other.loop)
        )


@dataclass(frozen=True)
class Exhibit:
    """A run as it is shown.

    Attributes
    ----------
    run : its rows, curves and special points
    mesh : int, the number of its mesh in the gallery
    shapes : of its rows, each turned to lie close to the one before it
    """

    run: Run
    mesh: int
    shapes: ShapeSequence

    @property
    def x(self) -> FloatArray:
        """Positions (n_rows, n_v, 3), in units of L, of cells R_0."""
        return self.shapes.x


@dataclass(frozen=True)
class Gallery:
    """Runs and the meshes they share."""

    exhibits: tuple[Exhibit, ...]
    meshes: tuple[Mesh, ...]


def collect(folders: Sequence[Path]) -> Gallery:
    """Read run folders as `sweep` and `branches` write them, finished or not.

    Raises OutputError naming the folder that is no run or has no rows yet, or the file
    that cannot be read or does not belong there, or is not of the first one's kind. A
    folder named twice counts once; of films of different kinds all loads are sigma_hat.
    """
    meshes: list[Mesh] = []
    exhibits: list[Exhibit] = []
    for run in read_runs(folders):
        shapes = run.shapes()
        mesh = Mesh(shapes.x.shape[1], shapes.triangles(0), shapes.loop)
        place = next((i for i, other in enumerate(meshes) if other.is_same(mesh)), None)
        if place is None:
            place = len(meshes)
            meshes.append(mesh)
        exhibits.append(Exhibit(run, place, shapes))
    for place, mesh in enumerate(meshes):
        _settle(exhibits, place, mesh.loop)
    return Gallery(tuple(exhibits), tuple(meshes))


def _settle(exhibits: list[Exhibit], mesh: int, loop: IntArray) -> None:
    """Replace the exhibits of one mesh by ones whose shapes follow each other."""
    alike = [place for place, shown in enumerate(exhibits) if shown.mesh == mesh]
    shown = [exhibits[place] for place in alike]
    stage = pictures_of(shown[0].run.kind).stage
    settled = stage.settled([(one.run.series, one.x) for one in shown], loop)
    for place, one, x in zip(alike, shown, settled, strict=True):
        exhibits[place] = replace(one, shapes=replace(one.shapes, x=x))
