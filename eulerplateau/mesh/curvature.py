"""Curvature of a shape: the loop's Darboux frame and the film's angle defects.

Sign conventions, here and nowhere else. The film's normal N points to the side from which
its triangles run counter-clockwise. The loop runs with the film on its left, so that with
t its tangent the conormal T = N x t points into the film. The curvature vector of the
loop splits into kappa_n N + kappa_g T: a flat convex film has kappa_g > 0 and
kappa_n = 0. Turning the film over (triangles and loop reversed) changes the sign of
kappa_n, not of kappa_g.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray, cross
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.triangles import area_vectors, corner_angles, unit

# Added to the normal equations of the quadric fit, whose entries are of order 1: keeps
# them solvable where too few or too special neighbours leave a coefficient open.
_RIDGE = 1e-10
# Softens the weight 1/distance^2 of a neighbour that has come to lie on the loop vertex.
_NEAR = 1e-6


@dataclass(frozen=True)
class LoopFrame:
    """Darboux frame and curvatures at the n_b loop vertices, in the order of `mesh.loop`.

    Lengths are in units of L, curvatures in units of 1/L.

    Attributes
    ----------
    tangent : (n_b, 3) float
        t, along the sum of the unit vectors of the two loop edges. At an exact cusp, where
        that sum vanishes, tangent and conormal are zero.
    normal : (n_b, 3) float
        N, the film's unit normal, perpendicular to t.
    conormal : (n_b, 3) float
        T = N x t, pointing into the film.
    kappa_vec : (n_b, 3) float
        Curvature vector (t_v - t_{v-1}) / <s_v>, perpendicular to t.
    kappa, kappa_n, kappa_g : (n_b,) float
        Its length and its components along N and T.
    contact_angle : (n_b,) float
        Angle in [0, pi] between curve normal and film normal, cos = kappa_n / kappa;
        pi/2 where the loop is straight.
    mean_lengths : (n_b,) float
        <s_v> = (s_v + s_{v-1}) / 2 of the rest lengths: the weight ds of vertex v.
    """

    tangent: FloatArray
    normal: FloatArray
    conormal: FloatArray
    kappa_vec: FloatArray
    kappa: FloatArray
    kappa_n: FloatArray
    kappa_g: FloatArray
    contact_angle: FloatArray
    mean_lengths: FloatArray


@dataclass(frozen=True)
class Curvatures:
    """The loop's frame and the angle defects (n_v,) of a shape, which several ask for."""

    frame: LoopFrame
    defects: FloatArray

    @classmethod
    def of(cls, mesh: Disk, x: FloatArray) -> Curvatures:
        """Return those of the shape `x` (n_v, 3) of a mesh, in units of L."""
        vectors = area_vectors(mesh.triangles, x)
        return cls.known(mesh, x, vectors, corner_angles(x[mesh.triangles], vectors))

    @classmethod
    def known(
        cls, mesh: Disk, x: FloatArray, vectors: FloatArray, angles: FloatArray
    ) -> Curvatures:
        """Return the same by the triangles' known area vectors and angles (n_t, 3)."""
        return cls(_loop_frame(mesh, x, vectors), _defects(mesh, angles))


def loop_frame(mesh: Disk, x: FloatArray) -> LoopFrame:
    """Return the frame and curvatures of the loop of the shape `x` (n_v, 3), in units of L.

    Curvature as in eq. discrete-energy; kappa_n, kappa_g and the contact angle as in
    section "Notation". The normal is that of a quadric through the second ring of
    neighbours: the triangles' own normals belong to points inside the film, and no
    weighting of those around a loop vertex makes the contour integrals of kappa_n and
    kappa_g better than first order in the edge length; with the quadric they are second.
    """
    return _loop_frame(mesh, x, area_vectors(mesh.triangles, x))


def _loop_frame(mesh: Disk, x: FloatArray, vectors: FloatArray) -> LoopFrame:
    edges = unit(x[np.roll(mesh.loop, -1)] - x[mesh.loop])
    before = np.roll(edges, 1, axis=0)
    tangent = unit(edges + before)
    mean_lengths = 0.5 * (mesh.rest_lengths + np.roll(mesh.rest_lengths, 1))
    kappa_vec = (edges - before) / mean_lengths[:, None]
    normal = _loop_normals(mesh, x, tangent, vectors)
    conormal = cross(normal, tangent)
    kappa_n = (kappa_vec * normal).sum(axis=1)
    kappa_g = (kappa_vec * conormal).sum(axis=1)
    return LoopFrame(
        tangent=tangent,
        normal=normal,
        conormal=conormal,
        kappa_vec=kappa_vec,
        kappa=np.linalg.norm(kappa_vec, axis=1),
        kappa_n=kappa_n,
        kappa_g=kappa_g,
        contact_angle=np.pi / 2 - np.arctan2(kappa_n, np.abs(kappa_g)),
        mean_lengths=mean_lengths,
    )


def angle_defects(mesh: Disk, x: FloatArray) -> FloatArray:
    """Return (n_v,) 2 pi - (sum of the angles at an interior vertex); on the loop pi - sum.

    They sum to 2 pi on every shape, however crumpled: discrete Gauss-Bonnet.
    """
    vectors = area_vectors(mesh.triangles, x)
    return _defects(mesh, corner_angles(x[mesh.triangles], vectors))


def _defects(mesh: Disk, angles: FloatArray) -> FloatArray:
    full = np.full(mesh.n_v, 2.0 * np.pi)
    full[mesh.loop] = np.pi
    return full - np.bincount(mesh.triangles.ravel(), angles.ravel(), minlength=mesh.n_v)


def total_gauss_curvature(mesh: Disk, x: FloatArray) -> float:
    """Return <K>, the integral of K dA: the sum of the interior angle defects."""
    return float(angle_defects(mesh, x)[mesh.interior].sum())


def gauss_curvature_from_loop(mesh: Disk, x: FloatArray) -> float:
    """Return 2 pi minus the contour integral of kappa_g: <K> as seen from the loop alone.

    Its error is of second order in the edge length; that of `total_gauss_curvature` is of
    first, because the angle defects leave out the outermost half row of triangles.
    """
    frame = loop_frame(mesh, x)
    return float(2.0 * np.pi - frame.kappa_g @ frame.mean_lengths)


def _loop_normals(
    mesh: Disk, x: FloatArray, tangent: FloatArray, vectors: FloatArray
) -> FloatArray:
    """Return the film's unit normals (n_b, 3) on the loop, perpendicular to `tangent`.

    Over the plane of the area-weighted mean normal of the incident triangles, heights of
    the neighbours are fitted by a quadric; its slope across the loop tilts that normal.
    Where the neighbourhood is no graph over the plane the result is rough, but stays
    within a right angle of the mean normal.
    """
    areas = vectors.repeat(3, axis=0)
    corners = mesh.triangles.ravel()
    summed = np.empty((mesh.n_v, 3))
    for axis in range(3):
        summed[:, axis] = np.bincount(corners, areas[:, axis], minlength=mesh.n_v)
    mean = summed[mesh.loop]
    mean = unit(mean - (mean * tangent).sum(axis=1, keepdims=True) * tangent)
    across = cross(mean, tangent)

    first, neighbours = mesh.second_ring
    count = np.diff(first, append=len(neighbours))
    offset = x[neighbours] - np.repeat(x[mesh.loop], count, axis=0)
    reach = np.add.reduceat(np.linalg.norm(offset, axis=1), first) / count
    offset /= np.repeat(np.where(reach > 0.0, reach, 1.0), count)[:, None]
    u, v, height = (
        (offset * np.repeat(direction, count, axis=0)).sum(axis=1)
        for direction in (tangent, across, mean)
    )
    weight = 1.0 / ((offset * offset).sum(axis=1) + _NEAR)
    terms = np.stack([u, v, u * u, u * v, v * v], axis=1)
    weighted = weight[:, None] * terms
    matrix = np.add.reduceat(weighted[:, :, None] * terms[:, None, :], first)
    right = np.add.reduceat(weighted * height[:, None], first)
    quadric = np.linalg.solve(matrix + _RIDGE * np.eye(5), right[:, :, None])[:, :, 0]
    return unit(mean - quadric[:, 1:2] * across)
