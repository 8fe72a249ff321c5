"""Read run folders into what the gallery page shows: rows, series of rows, shapes."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import groupby, pairwise
from pathlib import Path

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import OutputError
from eulerplateau.pictures.gallery.alignment import settled
from eulerplateau.runs import BranchRow, Row, read_shape, read_tables, shape_name


@dataclass(frozen=True)
class Mesh:
    """What the shapes of a run have in common, and often those of several runs.

    Only a soap film that was repaired has other triangles (Run.tilings).

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
class Series:
    """Successive rows of a run that make one curve of the diagram: a branch or a leg.

    Attributes
    ----------
    name : str
    group : str, shared by the series drawn alike: mirror images, which start together
    first, last : int, the numbers of its rows in the run
    origin : int or None, the row at which the curve starts, if that is another series'
    """

    name: str
    group: str
    first: int
    last: int
    origin: int | None = None


@dataclass(frozen=True)
class Run:
    """A run folder, read.

    Attributes
    ----------
    name : str
    rows : of sweep.csv or branches.csv
    series : their curves, which cover all rows in order
    special : what special_points.csv says, by number; empty for a sweep
    mesh : int, the number of the run's mesh in the gallery
    shapes : (n_rows, n_v, 3) float, in units of L, each turned to lie close to the one
        before it
    tilings : where triangles change: the row from which on, and (n_t, 3) int
        The first is (0, the mesh's).
    """

    name: str
    rows: tuple[Row, ...]
    series: tuple[Series, ...]
    special: dict[int, dict[str, str]]
    mesh: int
    shapes: FloatArray
    tilings: tuple[tuple[int, IntArray], ...]

    def triangles(self, place: int) -> IntArray:
        """Return the triangles (n_t, 3) of a row's shape."""
        return next(tiles for first, tiles in self.tilings[::-1] if first <= place)


@dataclass(frozen=True)
class Gallery:
    """Runs and the meshes they share."""

    runs: tuple[Run, ...]
    meshes: tuple[Mesh, ...]


def collect(folders: Sequence[Path]) -> Gallery:
    """Read run folders as `sweep` and `branches` write them, finished or not.

    Raises OutputError naming the folder that is no run or has no rows yet, or the file
    that cannot be read or does not belong there. A folder named twice counts once; of films
    of different kinds all loads are sigma_hat.
    """
    distinct = list({folder.resolve(): folder for folder in folders}.values())
    meshes: list[Mesh] = []
    runs: list[Run] = []
    for folder, name, rows in zip(
        distinct, _names(distinct), read_tables(distinct), strict=True
    ):
        series, special = _curves(folder, rows)
        mesh, x, tilings = _read_shapes(folder, rows)
        place = next((i for i, other in enumerate(meshes) if other.is_same(mesh)), None)
        if place is None:
            place = len(meshes)
            meshes.append(mesh)
        runs.append(Run(name, tuple(rows), tuple(series), special, place, x, tilings))
    for place, mesh in enumerate(meshes):
        _settle(runs, place, mesh.loop)
    return Gallery(tuple(runs), tuple(meshes))


def _names(folders: Sequence[Path]) -> list[str]:
    """Return the last parts of the folders' paths, as many as tell them apart."""
    parts = [folder.resolve().parts for folder in folders]
    for count in range(1, max((len(part) for part in parts), default=0) + 1):
        names = ["/".join(part[-count:]) for part in parts]
        if len(set(names)) == len(names):
            return names
    return []


def _curves(
    folder: Path, rows: Sequence[Row]
) -> tuple[list[Series], dict[int, dict[str, str]]]:
    """Return the curves of a run's rows, and its special points."""
    branches = [row for row in rows if isinstance(row, BranchRow)]
    if not branches:
        return _legs(rows), {}
    return _branches(branches), _read_special(folder / "special_points.csv")


def _branches(rows: Sequence[BranchRow]) -> list[Series]:
    special: dict[int | None, int] = {}
    for place, row in enumerate(rows):
        if row.special is not None:
            special.setdefault(row.special, place)
    found = []
    numbered = groupby(enumerate(rows), key=lambda numbered: numbered[1].branch)
    for number, members in numbered:
        places = [place for place, _ in members]
        origin = special.get(rows[places[0]].origin)
        group = "the first branch"
        if origin is not None:
            at = rows[origin]
            group = f"from point {rows[places[0]].origin} at {at.load:.6g}"
        found.append(Series(f"branch {number}", group, places[0], places[-1], origin))
    return found


def _legs(rows: Sequence[Row]) -> list[Series]:
    """Split a sweep where its load turns; each leg but the first starts at the turn."""
    rising = [after.load >= row.load for row, after in pairwise(rows)] or [True]
    turns = [place for place in range(1, len(rising)) if rising[place] != rising[place - 1]]
    legs = []
    first = 0
    for last in (*turns, len(rows) - 1):
        name = "load rising" if rising[max(last - 1, 0)] else "load falling"
        legs.append(Series(name, name, first, last, first - 1 if first else None))
        first = last + 1
    return legs


def _read_special(path: Path) -> dict[int, dict[str, str]]:
    """Read special_points.csv, which an exploration that has met none does not write."""
    try:
        with path.open(newline="", encoding="utf-8") as file:
            return {int(line["number"]): dict(line) for line in csv.DictReader(file)}
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise OutputError(path, f"cannot be read: {error.strerror}") from None
    except (KeyError, ValueError):
        problem = "is no table of special points: no column of whole numbers `number`"
        raise OutputError(path, problem) from None


def _read_shapes(
    folder: Path, rows: Sequence[Row]
) -> tuple[Mesh, FloatArray, tuple[tuple[int, IntArray], ...]]:
    """Return the run's mesh, the positions (n_rows, n_v, 3) and the triangles they have."""
    mesh: Mesh | None = None
    x: list[FloatArray] = []
    tilings: list[tuple[int, IntArray]] = []
    for row in rows:
        path = folder / shape_name(row.step)
        shape = read_shape(path)
        own = Mesh(len(shape.x), shape.triangles, shape.loop)
        mesh = mesh or own
        if own.n_v != mesh.n_v or not np.array_equal(own.loop, mesh.loop):
            raise OutputError(path, f"has another mesh than {shape_name(rows[0].step)}")
        if not tilings or not np.array_equal(own.triangles, tilings[-1][1]):
            tilings.append((len(x), own.triangles))
        if not np.isfinite(shape.x).all():
            raise OutputError(path, "has positions that are not finite")
        x.append(shape.x)
    assert mesh is not None  # there are rows
    return mesh, np.array(x), tuple(tilings)


def _settle(runs: list[Run], mesh: int, loop: IntArray) -> None:
    """Replace the runs of one mesh by ones whose shapes follow each other.

    A curve follows on from the row it branches off from, a run from the first run.
    """
    alike = [place for place, run in enumerate(runs) if run.mesh == mesh]
    before: list[int | None] = []
    for place in alike:
        start = len(before)
        for curve in runs[place].series:
            origin = None if curve.origin is None else start + curve.origin
            first = origin if origin is not None or not before else 0
            before += [first, *range(start + curve.first, start + curve.last)]
    x = settled(np.concatenate([runs[place].shapes for place in alike]), before, loop)
    ends = np.cumsum([len(runs[place].rows) for place in alike])[:-1]
    for place, shapes in zip(alike, np.split(x, ends), strict=True):
        runs[place] = replace(runs[place], shapes=shapes)
