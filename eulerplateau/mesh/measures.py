"""The numbers a sweep records about a shape."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import largest_turning
from eulerplateau.mesh.crossings import self_intersections
from eulerplateau.mesh.curvature import Curvatures
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.shape import Shape
from eulerplateau.mesh.triangles import area_vectors, corner_angles
from eulerplateau.mesh.waist import waist_path, waist_twist


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
        See `crossings.self_intersections`.
    aspect : float
        See `aspect`.
    min_angle : float
        The smallest angle of the film's triangles, degrees.
    """

    abs_kappa_n: float
    total_gauss_curvature: float
    area: float
    max_turning: float
    waist_twist: float
    self_intersections: int
    aspect: float
    min_angle: float


class Measurer:
    """Measures one shape of a disk after another.

    What depends on the triangles alone, the path across the waist, is found again only
    where a shape has others than the one before.
    """

    def __init__(self, disk: Disk) -> None:
        self._rest = self._disk = disk
        self._path = waist_path(disk)

    def disk_of(self, shape: Shape) -> Disk:
        """Return the disk with a shape's loop and triangles."""
        if shape.triangles is not self._disk.triangles:
            self._disk = self._rest.with_loop(shape.loop).with_triangles(shape.triangles)
            self._path = waist_path(self._disk)
        return self._disk

    def measure(self, shape: Shape) -> Measures:
        """Measure a shape of the disk, in units of L.

        Raises MeshError of kind "vertex" if a coordinate is not finite.
        """
        return self.measured(shape)[0]

    def measured(self, shape: Shape) -> tuple[Measures, Curvatures]:
        """Return also the curvatures it has; raises what `measure` raises."""
        disk, x = self.disk_of(shape), shape.x
        crossings = self_intersections(x, disk.triangles)
        vectors = area_vectors(disk.triangles, x)
        corner = x[disk.triangles]
        angles = corner_angles(corner, vectors)
        curvatures = Curvatures.known(disk, x, vectors, angles)
        frame = curvatures.frame
        areas = np.linalg.norm(vectors, axis=1)
        found = Measures(
            abs_kappa_n=float(np.abs(frame.kappa_n) @ frame.mean_lengths),
            total_gauss_curvature=float(curvatures.defects[disk.interior].sum()),
            area=float(areas.sum()),
            max_turning=largest_turning(shape.x_loop),
            waist_twist=waist_twist(self._path, x),
            self_intersections=crossings,
            aspect=_aspect(corner, areas),
            min_angle=float(np.degrees(angles.min())),
        )
        return found, curvatures


def measure(disk: Disk, shape: Shape) -> Measures:
    """Measure a shape of a disk, in units of L.

    Raises MeshError of kind "vertex" if a coordinate is not finite.
    """
    return Measurer(disk).measure(shape)


def aspect(mesh: Disk, x: FloatArray) -> float:
    """Return the short over the long axis, in [0, 1], of the ellipse the film resembles.

    That is the square root of the ratio of the two largest second moments of the film's
    area about its centroid. It is b/a for an ellipse and for every polygon that is the
    affine image of a regular one, however its boundary is sampled, and 1 for a regular
    polygon, whose extents would depend on the choice among equivalent axes; NaN for a
    film without area.
    """
    areas = np.linalg.norm(area_vectors(mesh.triangles, x), axis=1)
    return _aspect(x[mesh.triangles], areas)


def _aspect(corner: FloatArray, areas: FloatArray) -> float:
    """Return `aspect` by the corners (n_t, 3, 3) of the triangles, and their areas."""
    if areas.sum() == 0.0:
        return float("nan")
    centre = areas @ corner.mean(axis=1) / areas.sum()
    corner = corner - centre
    # A quadratic form integrates over a triangle exactly by the midpoints of its edges.
    middle = 0.5 * (corner.sum(axis=1, keepdims=True) - corner).reshape(-1, 3)
    moments = (middle.T * areas.repeat(3)) @ middle
    _, middling, largest = np.linalg.eigvalsh(moments)
    return float(np.sqrt(max(middling, 0.0) / largest))
