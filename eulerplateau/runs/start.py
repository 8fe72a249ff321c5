"""Where a run starts: at its mesh, or at a shape that another run has written."""

from __future__ import annotations

from eulerplateau.errors import SpecError
from eulerplateau.mesh import Disk, Shape
from eulerplateau.runs.shape_files import StoredShape, read_shape
from eulerplateau.runs.spec import RunSpec
from eulerplateau.solvers import displaced


def start_shape(spec: RunSpec, disk: Disk) -> Shape:
    """Return the first shape of a run: the disk, or a stored shape, displaced.

    Raises SpecError if the stored shape belongs to another mesh at rest.
    """
    x = displaced(disk, spec.start.displacement, spec.start.seed)
    stored = stored_start(spec, disk)
    if stored is None:
        return disk.shape.moved(x)
    return stored.moved(stored.x + (x - disk.x))


def stored_start(spec: RunSpec, disk: Disk) -> StoredShape | None:
    """Return the shape that start.file names, None without one; raises SpecError."""
    if spec.start.file is None:
        return None
    stored = read_shape(spec.start.file)
    if stored.rest_mesh != disk.digest:
        found = stored.rest_mesh[:8] or "none: it was written before shapes said so"
        problem = f"{spec.start.file} belongs to another mesh at rest (SHA-256 {found}"
        raise SpecError("start.file", f"{problem}, here {disk.digest[:8]})")
    return stored
