"""From a mesh specification to a triangulated disk, by Gmsh."""

from __future__ import annotations

from types import ModuleType

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError, SpecError
from eulerplateau.interruption import heed
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.gmsh_library import started_gmsh
from eulerplateau.mesh.polygon import perimeter, polygon_area, subdivide, to_unit_scale
from eulerplateau.mesh.spec import MeshSpec

_PAPER_VERTICES = 474
_TARGET_TOLERANCE = 0.02
_MOST_VERTICES = 1_000_000

# How fast edges lengthen with the distance from the loop in a graded mesh, length per
# length: slow enough for well-shaped triangles.
_GROWTH = 0.3

# Gmsh's algorithm 8 orders triangles of equal size by their addresses in memory, so a
# mirror-symmetric polygon gives another mesh from run to run. At an odd angle no two
# sizes are equal. The others gave the same mesh in each of 8 runs or more.
_ANGLES = {8: 0.1234567}

_OPTIONS = {
    "Mesh.MeshSizeExtendFromBoundary": 0,
    "Mesh.MeshSizeFromPoints": 0,
    "Mesh.MeshSizeFromCurvature": 0,
}


def generate(spec: MeshSpec) -> Disk:
    """Triangulate `spec.polygon`; equal specs give equal meshes, bit for bit.

    The loop's vertices come first, counter-clockwise, evenly spaced along each side.
    Positions are in the polygon's units before Disk scales them.

    Raises SpecError if the size asked for cannot be had, MeshError if Gmsh fails, and
    MissingLibraryError if Gmsh cannot be loaded.
    """
    with started_gmsh() as gmsh:
        for name, value in _OPTIONS.items():
            gmsh.option.setNumber(name, value)
        if spec.edge_length is not None:
            _refuse_huge(spec, spec.edge_length, "edge_length")
            points, triangles = _triangulate(gmsh, spec, spec.edge_length, spec.edge_length)
        else:
            points, triangles = _meet_target(gmsh, spec, spec.vertices or _PAPER_VERTICES)
    mesh = Disk.from_triangles(points, triangles)
    if len(mesh.interior) == 0:
        key = "vertices" if spec.edge_length is None else "edge_length"
        raise SpecError(key, "leaves no vertex inside the loop: ask for a finer mesh")
    return mesh


def _meet_target(
    gmsh: ModuleType, spec: MeshSpec, target: int
) -> tuple[FloatArray, IntArray]:
    """Search the edge length whose mesh has `target` vertices within 2 % or one."""
    if target > _MOST_VERTICES:
        raise SpecError("vertices", f"found {target}; should be at most {_MOST_VERTICES}")
    corners = len(spec.polygon.corners(np.inf))
    if corners > (1 + _TARGET_TOLERANCE) * target:
        raise SpecError("vertices", f"found {target}; the polygon alone has {corners}")
    at_loop = _lattice_edge_length(spec, target)
    for _ in range(6 if spec.grading > 1 else 0):
        points, triangles = _triangulate(gmsh, spec, at_loop, at_loop)
        at_loop *= np.sqrt(len(points) / target)
    counts = set()
    # While the loop keeps its edges, the number of vertices mostly follows the edge length
    # inside; where it jumps across the target, another number of loop edges helps.
    for stretch in (1.0, 0.96, 1.04, 0.92, 1.08, 0.88, 1.12):
        inside = at_loop
        for _ in range(10):
            points, triangles = _triangulate(gmsh, spec, at_loop * stretch, inside)
            counts.add(len(points))
            if abs(len(points) - target) <= max(_TARGET_TOLERANCE * target, 1):
                return points, triangles
            inside *= np.sqrt(len(points) / target)
    nearest = min(counts, key=lambda count: abs(count - target))
    raise SpecError("vertices", f"found {target}; Gmsh comes no nearer than {nearest}")


def _lattice_edge_length(spec: MeshSpec, vertices: int) -> float:
    """Edge length h of a triangular lattice: N = A / (sqrt(3)/2 h^2) + P / 2h + 1."""
    rough = spec.polygon.corners(0.1)
    half, whole = perimeter(rough) / 4, polygon_area(rough) * 2 / np.sqrt(3)
    inverse = (np.sqrt(half**2 + whole * (vertices - 1)) - half) / whole
    return float(1 / inverse)


def _refuse_huge(spec: MeshSpec, edge_length: float, key: str) -> None:
    shortest = _lattice_edge_length(spec, _MOST_VERTICES)
    if edge_length * spec.grading < shortest:
        raise SpecError(
            key,
            f"found {edge_length:g}; should be at least {shortest:.2g}, "
            f"which gives {_MOST_VERTICES} vertices",
        )


def _triangulate(
    gmsh: ModuleType, spec: MeshSpec, at_loop: float, inside: float
) -> tuple[FloatArray, IntArray]:
    """Return points (n_v, 3) and triangles (n_t, 3).

    The loop's edges are near `at_loop`, those behind them `inside`, and grading applies.
    """
    loop = subdivide(spec.polygon.corners(at_loop), at_loop)
    unit, size = to_unit_scale(loop)
    angle = _ANGLES.get(spec.algorithm, 0.0)
    # Twelve digits: a change of units, or another libm, must not change the mesh.
    finest = float(f"{inside / size:.12g}")
    heed()
    gmsh.clear()
    gmsh.option.setNumber("Mesh.Algorithm", spec.algorithm)
    gmsh.option.setNumber("Mesh.MeshSizeMin", finest)
    gmsh.option.setNumber("Mesh.MeshSizeMax", finest * spec.grading)
    curves = _add_region(gmsh, unit.round(12) @ _rotation(-angle))
    if spec.grading > 1:
        _grade(gmsh, curves, finest, finest * spec.grading)
    try:
        gmsh.model.mesh.generate(2)
    except Exception as error:  # Gmsh raises nothing more specific.
        raise MeshError("mesh", None, f"Gmsh failed: {error}") from None
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, corners = gmsh.model.mesh.getElementsByType(2)
    order = np.argsort(tags)
    plane = coordinates.reshape(-1, 3)[order, :2] @ _rotation(angle)
    plane[: len(unit)] = unit
    points = np.pad(plane * size, ((0, 0), (0, 1)))
    triangles = np.searchsorted(tags[order], corners).reshape(-1, 3).astype(np.int64)
    return points, triangles


def _rotation(angle: float) -> FloatArray:
    """Return the matrix R (2, 2) for which `points @ R` turns points clockwise."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


def _add_region(gmsh: ModuleType, loop: FloatArray) -> list[int]:
    """Hand Gmsh the region inside `loop` (n_b, 2); return the tags of its edges."""
    shape = gmsh.model.geo
    corners = [shape.addPoint(x, y, 0.0) for x, y in loop]
    ends = zip(corners, corners[1:] + corners[:1], strict=True)
    curves = [shape.addLine(start, end) for start, end in ends]
    for curve in curves:
        shape.mesh.setTransfiniteCurve(curve, 2)
    shape.addPlaneSurface([shape.addCurveLoop(curves)])
    shape.synchronize()
    return curves


def _grade(gmsh: ModuleType, curves: list[int], finest: float, coarsest: float) -> None:
    """Let the edge length grow with the distance from the loop."""
    field = gmsh.model.mesh.field
    distance = field.add("Distance")
    field.setNumbers(distance, "CurvesList", curves)
    field.setNumber(distance, "Sampling", 20)
    threshold = field.add("Threshold")
    field.setNumber(threshold, "InField", distance)
    field.setNumber(threshold, "SizeMin", finest)
    field.setNumber(threshold, "SizeMax", coarsest)
    field.setNumber(threshold, "DistMin", 0.0)
    field.setNumber(threshold, "DistMax", (coarsest - finest) / _GROWTH)
    field.setAsBackgroundMesh(threshold)
