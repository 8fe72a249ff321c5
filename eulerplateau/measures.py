"""The numbers a sweep records about a shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import pdist

from eulerplateau.curvature import (
    area_vectors,
    loop_frame,
    total_gauss_curvature,
    unit,
)
from eulerplateau.intersections import self_intersections
from eulerplateau.mesh import DiskMesh, FloatArray, IntArray

# Lengths, in units of L, that count as zero when the rest polygon is cut by a line.
_ON_LINE = 1e-9


@dataclass(frozen=True)
class Measures:
    """What is measured on a shape; the fields are columns of sweep.csv. Angles in degrees.

    Attributes
    ----------
    abs_kappa_n : float
        Contour integral of |kappa_n|; the mean of |kappa_n| times L.
    total_gauss_curvature : float
        Integral of K dA, the sum of the interior angle defects (radians, as 2 pi is).
    area : float
        Area of the triangles, in units of L^2.
    max_turning : float
        Largest angle between consecutive edges of the loop, degrees.
    waist_twist : float
        See `waist_twist`; degrees.
    self_intersections : int
        See `intersections.self_intersections`.
    aspect : float
        See `aspect`.
    """

    abs_kappa_n: float
    total_gauss_curvature: float
    area: float
    max_turning: float
    waist_twist: float
    self_intersections: int
    aspect: float


@dataclass(frozen=True)
class WaistPath:
    """The straight line between the two loop vertices farthest apart in the rest mesh.

    The line crosses n triangles. Attributes:

    corners : (n, 3) int
        Vertices of the triangles, in the order in which the line crosses them.
    weights : (n, 2, 3) float
        Barycentric coordinates of the points where it enters and leaves each of them.
    """

    corners: IntArray
    weights: FloatArray


def measure(mesh: DiskMesh, x: FloatArray, path: WaistPath | None) -> Measures:
    """Measure the shape `x` (n_v, 3), in units of L.

    `path` is `waist_path(mesh)`, found once for a mesh. Raises MeshError of kind "vertex"
    if a coordinate is not finite.
    """
    crossings = self_intersections(x, mesh.triangles)
    frame = loop_frame(mesh, x)
    sines = np.minimum(0.5 * frame.kappa * frame.mean_lengths, 1.0)
    return Measures(
        abs_kappa_n=float(np.abs(frame.kappa_n) @ frame.mean_lengths),
        total_gauss_curvature=total_gauss_curvature(mesh, x),
        area=float(np.linalg.norm(area_vectors(mesh.triangles, x), axis=1).sum()),
        max_turning=float(np.degrees(2.0 * np.arcsin(sines.max()))),
        waist_twist=waist_twist(path, x),
        self_intersections=crossings,
        aspect=aspect(mesh, x),
    )


def aspect(mesh: DiskMesh, x: FloatArray) -> float:
    """Return the short over the long axis, in [0, 1], of the ellipse the film resembles.

    That is the square root of the ratio of the two largest second moments of the film's
    area about its centroid. It is b/a for an ellipse and for every polygon that is the
    affine image of a regular one, however its boundary is sampled, and 1 for a regular
    polygon, whose extents would depend on the choice among equivalent axes.
    """
    corner = x[mesh.triangles]
    areas = np.linalg.norm(area_vectors(mesh.triangles, x), axis=1)
    centre = areas @ corner.mean(axis=1) / areas.sum()
    corner = corner - centre
    # A quadratic form integrates over a triangle exactly by the midpoints of its edges.
    middle = 0.5 * (corner + np.roll(corner, -1, axis=1))
    moments = np.einsum("t,tki,tkj->ij", areas, middle, middle, optimize=True)
    _, middling, largest = np.linalg.eigvalsh(moments)
    return float(np.sqrt(max(middling, 0.0) / largest))


def waist_twist(path: WaistPath | None, x: FloatArray) -> float:
    """Return by how many degrees the film's normal turns along the waist path of `x`.

    The path runs straight through each triangle it crosses. From one triangle to the next
    the normal is carried along by the smallest rotation that takes one segment's direction
    to the other's; the angle from there to the next triangle's normal, about the path, is
    summed. Positive when the film winds as a right-handed screw, whichever way the path
    runs and whichever side of the film is up; a mirror image has the opposite twist. The
    surface of eq. eight has 4 arctan(t). Full turns count. NaN without a path.
    """
    if path is None:
        return float("nan")
    ends = np.einsum("npc,ncd->npd", path.weights, x[path.corners])
    along = unit(ends[:, 1] - ends[:, 0])
    normals = unit(area_vectors(path.corners, x))
    before, after = normals[:-1], normals[1:]
    turn = along[:-1] + along[1:]
    fall = (before * along[1:]).sum(axis=1)
    # 1 + cos of the bend; a path that doubles back has no smallest rotation, only a floor.
    bend = np.maximum(0.5 * (turn * turn).sum(axis=1), 1e-12)
    carried = before - (fall / bend)[:, None] * turn
    sine = (along[1:] * np.cross(carried, after)).sum(axis=1)
    cosine = (carried * after).sum(axis=1)
    return float(np.degrees(np.arctan2(sine, cosine).sum()))


def waist_path(mesh: DiskMesh) -> WaistPath | None:
    """Return the path for `waist_twist`, or None if the rest mesh has none.

    It has none if it is not planar, or if the line does not run inside the polygon. Where
    the line runs along an edge the triangle on its right is taken. Where several pairs of
    loop vertices are equally far apart, as in a regular hexagon, the first in the order of
    `mesh.loop` is taken: the twist is then that of one axis among equivalent ones.
    """
    start, end = _farthest_pair(mesh)
    up = unit(area_vectors(mesh.triangles, mesh.x).sum(axis=0))
    offset = mesh.x - mesh.x[start]
    along = unit(offset[end])
    span = float(np.linalg.norm(offset[end]))
    if float(np.abs(offset @ up).max()) > _ON_LINE:
        return None
    side = offset @ np.cross(up, along)
    # Vertices on the line are counted to its left, so that no case is special.
    side[np.abs(side) < _ON_LINE] = 0.0
    corners = _crossed(mesh.triangles, side < 0.0)
    weights = _crossings(side[corners])
    place = (weights * (offset @ along)[corners][:, None, :]).sum(axis=2)
    forward = np.argsort(place, axis=1)
    place = np.take_along_axis(place, forward, axis=1)
    weights = np.take_along_axis(weights, forward[:, :, None], axis=1)
    # Triangles met in a point only, around a vertex on the line, have no segment.
    order = np.argsort(place[:, 0])
    order = order[place[order, 1] - place[order, 0] > _ON_LINE]
    stops = place[order]
    reached = np.concatenate([[0.0], stops[:, 1]])
    wanted = np.concatenate([stops[:, 0], [span]])
    if not np.allclose(reached, wanted, rtol=0.0, atol=10.0 * _ON_LINE):
        return None
    return WaistPath(corners[order], weights[order])


def _farthest_pair(mesh: DiskMesh) -> tuple[int, int]:
    """Return the two loop vertices farthest apart, the first pair among equals."""
    distances = pdist(mesh.x[mesh.loop])
    first = int(np.flatnonzero(distances >= distances.max() - _ON_LINE)[0])
    rows, columns = np.triu_indices(mesh.n_b, 1)
    return int(mesh.loop[rows[first]]), int(mesh.loop[columns[first]])


def _crossed(triangles: IntArray, right: np.ndarray) -> IntArray:
    """Return the triangles (n, 3) with corners on both sides, the lone one first."""
    corners = right[triangles]
    number = corners.sum(axis=1)
    mixed = (number == 1) | (number == 2)
    lone = np.argmax(corners[mixed] == (number[mixed] == 1)[:, None], axis=1)
    shift = (lone[:, None] + np.arange(3)) % 3
    return np.take_along_axis(triangles[mixed], shift, axis=1)


def _crossings(side: FloatArray) -> FloatArray:
    """Barycentric (n, 2, 3) of the line's crossings with edges 0-1 and 0-2.

    `side` (n, 3) is the signed distance of the corners from the line.
    """
    weights = np.zeros((len(side), 2, 3))
    for edge, other in enumerate((1, 2)):
        share = side[:, 0] / (side[:, 0] - side[:, other])
        weights[:, edge, 0] = 1.0 - share
        weights[:, edge, other] = share
    return weights
