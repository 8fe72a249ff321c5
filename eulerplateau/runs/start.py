"""What a run minimises, and where it starts: at its mesh, or at another run's shape."""

from __future__ import annotations

from eulerplateau.errors import SpecError
from eulerplateau.mesh import Disk, Shape
from eulerplateau.runs.shape_files import StoredShape, read_shape
from eulerplateau.runs.spec import RunSpec
from eulerplateau.solvers import Problem, displaced


def make_problem(spec: RunSpec, disk: Disk, *, refine: bool = False) -> Problem:
    """Return what a run minimises; raises SpecError, MeshError.

    refine : whether soap films may be finer than their mesh at contacts, as Problem has it
    """
    return Problem(
        disk,
        spec.film.model,
        in_plane=spec.film.plane,
        twist_ratio=spec.twist_ratio,
        link=spec.loop.link or 0.0,
        rest_curvature=spec.loop.rest_curvature or 0.0,
        diameter=spec.diameter,
        refine=refine,
    )


def start_shape(spec: RunSpec, disk: Disk) -> Shape:
    """Return the first shape of a run: the disk, or a stored shape, displaced.

    Raises SpecError if the stored shape belongs to another mesh at rest.
    """
    x = displaced(disk, spec.start.displacement, spec.start.seed)
    stored = stored_start(spec, disk)
    if stored is None:
        return disk.shape.moved(x)
    moved = stored.x.copy()
    moved[: disk.n_v] += x - disk.x  # one that was refined has more vertices behind these
    return stored.moved(moved)


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
