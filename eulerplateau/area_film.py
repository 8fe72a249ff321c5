"""The true soap film: energy sigma times the area of the triangles, eq. continuum-energy.

A triangle with the sides e_0, e_1, e_2 (e_j opposite corner j, counter-clockwise), area A
and unit normal n has

    dA/dx_i = n x e_i / 2,    d2A/dx_i dx_j = (e_i . e_j) n n^T / (4 A) + eps_ij [n]_x / 2,

eps_ij = 1 where j follows two after i, -1 where it follows one after, cyclically. The first
part is the cotangent matrix acting on normal displacements; the second cancels in sums over
a flat neighbourhood, where sliding inside the film costs nothing.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import csc_array, csr_array

from eulerplateau.curvature import unit
from eulerplateau.dissection import dissect
from eulerplateau.mesh import DiskMesh, FloatArray, IntArray

_FOLLOWS = np.array([[0.0, -1.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 1.0, 0.0]])


@dataclass(frozen=True)
class Sides:
    """The triangles of a shape.

    Attributes
    ----------
    edges : (n_t, 3, 3) float, the side opposite each corner
    normals : (n_t, 3) float, unit
    areas : (n_t,) float
    """

    edges: FloatArray
    normals: FloatArray
    areas: FloatArray

    @property
    def smallest_angle(self) -> float:
        """The smallest angle of all triangles, degrees."""
        return smallest_angle(self.edges, self.areas)

    @cached_property
    def cotangent(self) -> FloatArray:
        """(e_i . e_j) / (4 A) (n_t, 3, 3): half of Dirichlet's energy, corner by corner."""
        dots = self.edges @ self.edges.transpose(0, 2, 1)
        # A triangle without an area pulls at nothing.
        areas = np.where(self.areas > 0.0, self.areas, np.inf)
        cotangent: FloatArray = dots / (4 * areas[:, None, None])
        return cotangent


@dataclass(frozen=True)
class AreaFilm:
    """A film whose energy is load * area, load = sigma L^3 / alpha.

    Attributes
    ----------
    triangles : (n_t, 3) int
    loop, interior : (n_b,) and (n_v - n_b,) int
    rest : (n_v, 3) float, the mesh as it was given
    tension_per_load : float
        sigma L^3 / alpha per unit of load: 1.
    """

    triangles: IntArray
    loop: IntArray
    interior: IntArray
    rest: FloatArray
    tension_per_load: float = 1.0

    @property
    def n_v(self) -> int:
        """Number of vertices."""
        return len(self.loop) + len(self.interior)

    def retiled(self, triangles: IntArray) -> AreaFilm:
        """Return the film with other triangles (n_t, 3)."""
        return replace(self, triangles=triangles)

    def sides(self, x: FloatArray) -> Sides:
        """Return the triangles of the shape x (n_v, 3)."""
        corner = x[self.triangles]
        edges = np.roll(corner, 1, axis=1) - np.roll(corner, -1, axis=1)
        doubled = np.cross(edges[:, 0], edges[:, 1])
        size = np.linalg.norm(doubled, axis=1)
        return Sides(edges, unit(doubled), 0.5 * size)

    def energy_gradient(self, x: FloatArray, load: float) -> tuple[float, FloatArray]:
        """Return load * area and its gradient (n_v, 3)."""
        sides = self.sides(x)
        return load * float(sides.areas.sum()), load * self.gradient(sides)

    def gradient(self, sides: Sides) -> FloatArray:
        """Return the gradient of the area (n_v, 3)."""
        return self.gather(0.5 * np.cross(sides.normals[:, None, :], sides.edges))

    def gather(self, corners: FloatArray) -> FloatArray:
        """Sum what the corners (n_t, 3, 3) hold at each vertex (n_v, 3)."""
        place = self.triangles.ravel()
        columns = [
            np.bincount(place, corners[:, :, d].ravel(), minlength=self.n_v)
            for d in range(3)
        ]
        return np.stack(columns, axis=1)

    def change(self, x: FloatArray, after: FloatArray) -> float:
        """Return area(after) - area(x) with the relative precision of the difference.

        Triangle by triangle, |c'| - |c| = (c' - c) . (c' + c) / (|c'| + |c|) for c twice
        the vector area.
        """
        first, second = self._doubled(x), self._doubled(after)
        corner, moved = x[self.triangles], (after - x)[self.triangles]
        side = corner[:, 1:] - corner[:, :1]
        shift = moved[:, 1:] - moved[:, :1]
        difference = np.cross(shift[:, 0], side[:, 1] + shift[:, 1])
        difference += np.cross(side[:, 0], shift[:, 1])
        total = np.linalg.norm(first, axis=1) + np.linalg.norm(second, axis=1)
        return 0.5 * float(((difference * (first + second)).sum(axis=1) / total).sum())

    def _doubled(self, x: FloatArray) -> FloatArray:
        corner = x[self.triangles]
        return np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])

    def vertex_normals(self, sides: Sides) -> FloatArray:
        """Return unit normals (n_v, 3), the triangles' weighted by their areas."""
        weighted = np.repeat((sides.normals * sides.areas[:, None])[:, None], 3, axis=1)
        total = self.gather(weighted)
        return unit(total)

    def cotangent_laplacian(self, sides: Sides) -> csc_array:
        """Return L (n_v, n_v) with area gradient = L x; the film at rest is L x = 0."""
        return self._scalar.fill(sides.cotangent)

    def normal_hessian(self, sides: Sides, directions: FloatArray) -> csc_array:
        """Return the Hessian (n_v, n_v) for displacements along `directions` (n_v, 3)."""
        along = directions[self.triangles]
        across = (along * sides.normals[:, None, :]).sum(axis=2)
        slide = _FOLLOWS * (
            along @ np.cross(sides.normals[:, None], along).transpose(0, 2, 1)
        )
        bend = sides.cotangent * (across[:, :, None] * across[:, None, :])
        return self._scalar.fill(bend + 0.5 * slide)

    def hessian(self, sides: Sides) -> csc_array:
        """Return the whole Hessian (3 n_v, 3 n_v); vertex v has rows 3 v ... 3 v + 2."""
        n = sides.normals
        across = n[:, :, None] * n[:, None, :]
        turn = np.cross(n[:, None, :], np.eye(3)).transpose(0, 2, 1)
        blocks = sides.cotangent[:, :, :, None, None] * across[:, None, None]
        blocks += 0.5 * _FOLLOWS[:, :, None, None] * turn[:, None, None]
        return self._vector.fill(blocks.transpose(0, 1, 3, 2, 4))

    @cached_property
    def pieces(self) -> list[IntArray]:
        """The interior, numbered 0 ... n_i - 1, in pieces to be eliminated one by one."""
        pattern = self._scalar
        entries = (np.ones(len(pattern.indices)), pattern.indices, pattern.indptr)
        graph = csr_array(entries, shape=(self.n_v, self.n_v))
        return [
            np.searchsorted(self.interior, piece)
            for piece in dissect(graph, self.loop, self.interior)
        ]

    @cached_property
    def _scalar(self) -> _Pattern:
        return _Pattern.of(self.triangles, self.n_v)

    @cached_property
    def _vector(self) -> _Pattern:
        corners = (3 * self.triangles[:, :, None] + np.arange(3)).reshape(-1, 9)
        return _Pattern.of(corners, 3 * self.n_v)


@dataclass(frozen=True)
class _Pattern:
    """Where the entries of element matrices go in a sparse one; found once, then filled."""

    indices: IntArray
    indptr: IntArray
    place: IntArray

    @classmethod
    def of(cls, elements: IntArray, n: int) -> _Pattern:
        """Find the pattern of elements (n_t, m), each coupling its m unknowns."""
        row = np.repeat(elements, elements.shape[1], axis=1).ravel()
        column = np.tile(elements, elements.shape[1]).ravel()
        entries, place = np.unique(column * n + row, return_inverse=True)
        indptr = np.searchsorted(entries, np.arange(n + 1) * n)
        return cls(entries % n, indptr, place)

    def fill(self, blocks: FloatArray) -> csc_array:
        """Return the matrix with the element matrices (n_t, m, m) summed into it."""
        n = len(self.indptr) - 1
        data = np.bincount(self.place, blocks.ravel(), minlength=len(self.indices))
        return csc_array((data, self.indices, self.indptr), shape=(n, n))


def smallest_angle(edges: FloatArray, areas: FloatArray) -> float:
    """Return the smallest angle of triangles with sides (n_t, 3, 3), degrees.

    60 at best, 0 for a triangle without area.
    """
    # Opposite the shortest side, so acute.
    length = np.sort(np.linalg.norm(edges, axis=2), axis=1)
    span = length[:, 1] * length[:, 2]
    sine = np.divide(2 * areas, span, out=np.zeros_like(span), where=span > 0)
    return float(np.degrees(np.arcsin(np.minimum(sine, 1.0)).min()))


def area(mesh: DiskMesh) -> AreaFilm:
    """Return the true soap film on a mesh."""
    return AreaFilm(mesh.triangles, mesh.loop, mesh.interior, mesh.x)
