"""Shapes as .vtp files, for ParaView and pyvista.

A shape holds the loop as one closed polyline (cell 0) and the film as triangles (cells
1 ... n_t). Quantities of the loop are NaN inside the film and those of the film NaN on the
loop, so that neither is mistaken for 0. The loop has a file by itself, with its own
quantities and nothing that is NaN: what colours and arrows of the loop are drawn from.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError, OutputError
from eulerplateau.film import Load
from eulerplateau.mesh import (
    Curvatures,
    Disk,
    Shape,
    VtpFile,
    read_vtp,
    write_vtp,
)
from eulerplateau.runs.parameters import LOOP_PARAMETERS
from eulerplateau.runs.rows import Record, Row

# Field data of a shape file: of its row, and the SHA-256 of the mesh at rest in bytes.
_OF_ITS_ROW = "step", "kL3_alpha", "sigma_hat", "energy"
_OF_SOME_ROWS = "branch", "n_unstable"
_REST_MESH = "rest_mesh_sha256"
_END = b"</VTKFile>\n"
_LOOP_FIELDS = ("kappa", "kappa_n", "kappa_g", "contact_angle", "tangent", "normal")


@dataclass(frozen=True, eq=False)
class StoredShape(Shape):
    """A shape read back from the file that a run has written.

    Attributes
    ----------
    step, kL3_alpha, sigma_hat, energy :
        Of the row of sweep.csv or branches.csv it belongs to.
    rest_mesh : str
        SHA-256 of the mesh at rest, as in run.json; empty if the file does not say.
    parameters : what the run varied in place of the load, by its column; or empty
    """

    step: int
    kL3_alpha: float  # noqa: N815 - the column's name
    sigma_hat: float
    energy: float
    rest_mesh: str = ""
    parameters: Mapping[str, float] = field(default_factory=dict)

    def load(self, film: Load) -> float:
        """Return the load it was found at, in that of a film."""
        return float(getattr(self, film.column))


@dataclass(frozen=True)
class ShapeSequence:
    """The shapes of a run, on one set of vertices.

    Attributes
    ----------
    x : (n, n_v, 3) float, lengths in units of L
        As many vertices as the largest has; those behind a smaller one's belong to none of
        its triangles, and lie where its last one does.
    loop : (n_b,) int, cyclic: the vertices that the loops of all of them have
    tilings : where triangles change: the shape from which on, and (n_t, 3) int
        The first is from shape 0 on; only a soap film that was repaired has others.
    """

    x: FloatArray
    loop: IntArray
    tilings: tuple[tuple[int, IntArray], ...]

    def triangles(self, place: int) -> IntArray:
        """Return the triangles (n_t, 3) of a shape."""
        return next(tiles for first, tiles in self.tilings[::-1] if first <= place)


def write_shape(
    path: Path,
    mesh: Disk,
    x: FloatArray,
    row: Row,
    modes: Mapping[str, FloatArray] | None = None,
    rest_mesh: str | None = None,
    state: Mapping[str, NDArray[Any]] | None = None,
    curvatures: Curvatures | None = None,
) -> None:
    """Write the film at positions `x` (n_v, 3) to `path` (.vtp), exactly and whole.

    Point fields on the loop: kappa, kappa_n, kappa_g, contact_angle, tangent, normal (of
    the film); inside: angle_defect; everywhere: on_loop (1 or 0) and the vectors `modes`,
    (n_v, 3) each, under their names. Field data: what `of_row` has of its `row`, and the
    SHA-256 of the mesh at rest, `rest_mesh`, by default that of `mesh`; and of the solver's
    `state` what it needs to go on from here. `curvatures` are those of the shape, found
    here if they are not known. Raises OutputError if the file cannot be written.
    """
    digest = bytes.fromhex(mesh.digest if rest_mesh is None else rest_mesh)
    write_vtp(
        path,
        x,
        mesh.triangles,
        loop=mesh.loop,
        point_fields=_point_fields(mesh, curvatures or Curvatures.of(mesh, x))
        | dict(modes or {}),
        field_data={
            **_about(row),
            _REST_MESH: np.frombuffer(digest, dtype=np.uint8),
            **(state or {}),
        },
    )


def write_loop(
    path: Path,
    mesh: Disk,
    x: FloatArray,
    row: Row,
    vectors: Mapping[str, FloatArray],
    curvatures: Curvatures,
) -> None:
    """Write the loop of a film at positions `x` (n_v, 3) to `path` (.vtp), by itself.

    Point fields as those of the shape on the loop, of `vectors` (n_v, 3) too; field data of
    its `row`. Raises OutputError if the file cannot be written.
    """
    write_vtp(
        path,
        x[mesh.loop],
        np.empty((0, 3), dtype=np.int64),
        loop=np.arange(mesh.n_b),
        point_fields={
            **{name: getattr(curvatures.frame, name) for name in _LOOP_FIELDS},
            **{name: values[mesh.loop] for name, values in vectors.items()},
        },
        field_data=_about(row),
    )


def _about(row: Row) -> dict[str, NDArray[Any]]:
    """Return the field data of a film's row: its step, loads, energy, what is varied ..."""
    return of_row(row, *dict.fromkeys((*_OF_ITS_ROW, row.load_name.column)))


def of_row(row: Record, *names: str) -> dict[str, NDArray[Any]]:
    """Return field data: these numbers of a row, and its status.

    And its branch and the number of its unstable modes, where it knows them.
    """
    about = {name: np.array([getattr(row, name)]) for name in names}
    for name in _OF_SOME_ROWS:
        value = getattr(row, name, None)
        if value is not None:
            about[name] = np.array([value])
    return {**about, "status": np.array([row.status.value])}


def read_shape(path: str | Path) -> StoredShape:
    """Read what a run wrote; raises OutputError if the file is anything else.

    A sweep or a branch can be started from it: solve(problem, load, read_shape(path)).
    """
    path = Path(path)
    found = _read(path, _OF_ITS_ROW)
    about = found.field_data
    digest = about.get(_REST_MESH, np.empty(0))
    return StoredShape(
        x=found.points,
        triangles=found.triangles,
        loop=found.lines[0][:-1],
        step=int(about["step"][0]),
        kL3_alpha=float(about["kL3_alpha"][0]),
        sigma_hat=float(about["sigma_hat"][0]),
        energy=float(about["energy"][0]),
        rest_mesh=digest.astype(np.uint8).tobytes().hex(),
        parameters={n: float(about[n][0]) for n in LOOP_PARAMETERS if n in about},
    )


def ends_as_shape(path: Path) -> bool:
    """Return whether a file ends as a shape does: a glance, where there are thousands."""
    try:
        with path.open("rb") as file:
            file.seek(-len(_END), os.SEEK_END)
            return file.read() == _END
    except OSError:
        return False


def is_whole_shape(path: Path) -> bool:
    """Return whether a file is a shape of a run that can be read."""
    try:
        _read(path, ("step",))
    except OutputError:
        return False
    return True


def read_state(path: Path) -> tuple[Shape, Mapping[str, NDArray[Any]]]:
    """Return a shape of a run and the field data with it; OutputError if it is none."""
    found = _read(path, ("step",))
    shape = Shape(found.points, found.triangles, found.lines[0][:-1])
    return shape, found.field_data


def read_shapes(paths: Sequence[Path]) -> ShapeSequence:
    """Read the shapes of a run, at least one.

    Raises OutputError naming the file that cannot be read, is of another mesh at rest than
    the first or, if they do not say of which, has another loop, or positions that are not
    finite.
    """
    x: list[FloatArray] = []
    loops: list[IntArray] = []
    tilings: list[tuple[int, IntArray]] = []
    first: VtpFile | None = None
    for path in paths:
        shape = _read(path, ("step",))
        first = shape if first is None else first
        if not _of_one_mesh(first, shape):
            raise OutputError(path, f"has another mesh than {paths[0].name}")
        if not tilings or not np.array_equal(shape.triangles, tilings[-1][1]):
            tilings.append((len(x), shape.triangles))
        if not np.isfinite(shape.points).all():
            raise OutputError(path, "has positions that are not finite")
        x.append(shape.points)
        loops.append(shape.lines[0][:-1])
    assert first is not None  # there are paths
    most = max(len(points) for points in x)
    full = [np.pad(points, ((0, most - len(points)), (0, 0)), "edge") for points in x]
    shared = loops[0]
    for loop in loops[1:]:
        shared = shared[np.isin(shared, loop)]
    return ShapeSequence(np.array(full), shared, tuple(tilings))


def _of_one_mesh(first: VtpFile, other: VtpFile) -> bool:
    """Return whether two shapes have, but for refinement, one mesh."""
    none = np.empty(0)
    one, another = (shape.field_data.get(_REST_MESH, none) for shape in (first, other))
    if len(one) and np.array_equal(one, another):
        return True
    same = np.array_equal(first.lines[0], other.lines[0])
    return same and len(first.points) == len(other.points)


def _read(path: Path, of_its_row: tuple[str, ...]) -> VtpFile:
    """Read a file with one closed line, and these fields of its row; else OutputError."""
    try:
        found = read_vtp(path)
    except MeshError:
        raise _not_a_shape(path) from None
    if len(found.lines) != 1 or not set(of_its_row) <= found.field_data.keys():
        raise _not_a_shape(path)
    return found


def _not_a_shape(path: Path) -> OutputError:
    return OutputError(path, "is not a whole shape file of a run")


def _point_fields(mesh: Disk, curvatures: Curvatures) -> dict[str, NDArray[Any]]:
    fields: dict[str, NDArray[Any]] = {}
    for name in _LOOP_FIELDS:
        on_loop = getattr(curvatures.frame, name)
        fields[name] = np.full((mesh.n_v, *on_loop.shape[1:]), np.nan)
        fields[name][mesh.loop] = on_loop
    fields["angle_defect"] = curvatures.defects.copy()
    fields["angle_defect"][mesh.loop] = np.nan
    fields["on_loop"] = np.zeros(mesh.n_v, dtype=np.uint8)
    fields["on_loop"][mesh.loop] = 1
    return fields
