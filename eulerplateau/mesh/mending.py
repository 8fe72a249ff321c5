"""From the triangles of a file to a `Disk`: turned over and merged where they must be."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError
from eulerplateau.mesh.cleaning import merged, oriented, pieces
from eulerplateau.mesh.disk import Disk, trace_disk

# Vertices this near to each other, in units of the mesh's size, are one: what is left of
# equal places where a file holds six or seven digits.
_NEAR = 1e-6


def as_disk(
    points: FloatArray, triangles: IntArray, source: str, soup: bool = False
) -> tuple[Disk, list[str]]:
    """Return the disk that triangles are, and a line for each thing done to make it one.

    Raises MeshError, which names what is wrong in `source`.

    Parameters
    ----------
    points : (n, 3) float
    triangles : (n_t, 3) int, all of them below n
    source : str
        The file, for messages.
    soup : bool
        The format shares no vertices: that equal ones are merged is no line.
    """
    try:
        return _attempt(points, triangles, source)
    except MeshError as error:
        problem = error
    scattered = pieces(triangles)
    used = points[np.unique(triangles)]
    with np.errstate(over="ignore", invalid="ignore"):
        size = float(np.ptp(used, axis=0).max())
    for tolerance in (0.0, _NEAR * size):
        if not np.isfinite(size) or (tolerance and _is_disk(triangles)):
            break  # of a wrong place or a sliver only: near vertices are not to blame
        joined, kept = merged(points, triangles, tolerance)
        count = len(used) - len(np.unique(joined))
        if not count or not len(joined):
            continue
        lines = [_merging(count, tolerance)] if tolerance or not soup else []
        if lost := len(triangles) - len(kept):
            what = counted(
                lost, "triangle without an area is", "triangles without an area are"
            )
            lines.append(f"{what} left out")
        try:
            disk, more = _attempt(points, joined, source)
        except MeshError as error:
            # What is wrong with triangles that share no vertices is not that.
            problem = error if pieces(joined) < scattered else problem
            continue
        return disk, [*lines, *more]
    raise problem


def _attempt(
    points: FloatArray, triangles: IntArray, source: str
) -> tuple[Disk, list[str]]:
    used, renumbered = np.unique(triangles, return_inverse=True)
    lines = []
    try:
        alike, turned = oriented(renumbered.reshape(-1, 3))
        if count := int(turned.sum()):
            of = f"{count} of {len(turned)} triangles {'is' if count == 1 else 'are'}"
            lines.append(f"{of} turned over to agree with the others")
        return Disk.from_triangles(points[used], alike), lines
    except MeshError as error:
        raise _named_as_in_file(error, used, source) from None


def _is_disk(triangles: IntArray) -> bool:
    used, renumbered = np.unique(triangles, return_inverse=True)
    try:
        trace_disk(len(used), oriented(renumbered.reshape(-1, 3))[0])
    except MeshError:
        return False
    return True


def _merging(count: int, tolerance: float) -> str:
    where = f"within {_NEAR:g} of the size" if tolerance else "at the same places"
    return f"{counted(count, 'vertex is', 'vertices are')} merged with others {where}"


def counted(count: int, one: str, many: str) -> str:
    """Return the count with the word for one or for many."""
    return f"{count} {one if count == 1 else many}"


def _named_as_in_file(error: MeshError, used: IntArray, source: str) -> MeshError:
    index = error.index
    if error.kind == "vertex" and isinstance(index, int):
        index = int(used[index])
    elif isinstance(index, tuple):
        index = (int(used[index[0]]), int(used[index[1]]))
    problem = str(error).partition(": ")[2]
    return MeshError(error.kind, index, f"{problem} (in {source})")
