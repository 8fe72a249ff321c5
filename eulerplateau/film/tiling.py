"""The area of a triangulated film, its gradient and its Hessian (eq. continuum-energy).

A triangle with the sides e_0, e_1, e_2 (e_j opposite corner j, counter-clockwise), area A
and unit normal n has

    dA/dx_i = n x e_i / 2,    d2A/dx_i dx_j = (e_i . e_j) n n^T / (4 A) + eps_ij [n]_x / 2,

eps_ij = 1 where j follows two after i, -1 where it follows one after, cyclically. The first
part is the cotangent matrix acting on normal displacements; the second cancels in sums over
a flat neighbourhood, where sliding inside the film costs nothing.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.sparse import csc_array

from eulerplateau.arrays import BoolArray, FloatArray, IntArray
from eulerplateau.film import area_kernels, hessian_kernels
from eulerplateau.film.dissection import LARGEST, Graph, dissect
from eulerplateau.film.elimination import Elimination, plan, summed
from eulerplateau.film.strip import NoStrip
from eulerplateau.mesh import neighbours


@dataclass(frozen=True)
class TriangleGeometry:
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

    @cached_property
    def smallest_angle(self) -> float:
        """The smallest angle of all triangles, degrees."""
        return float(np.degrees(np.arcsin(area_kernels.least_sine(self.edges, self.areas))))

    @cached_property
    def scale(self) -> float:
        """The largest part of a side along an axis."""
        return max(float(self.edges.max()), -float(self.edges.min()))

    @cached_property
    def cotangent(self) -> FloatArray:
        """(e_i . e_j) / (4 A) (n_t, 3, 3): half of Dirichlet's energy, corner by corner."""
        cotangent = np.empty_like(self.edges)
        area_kernels.cotangents(self.edges, self.areas, cotangent)
        return cotangent


@dataclass(frozen=True)
class TriangleLimits:
    """Which triangles are fit for what. Angles in degrees, turns as cosines.

    Attributes
    ----------
    thin : thinner ones are replaced where a film is made anew
    thinned : part of its worst angle at the start that a film may come to, if thin
    vanishing : thinner ones are on their way to collapse; a minimal surface has none
    folded : a triangle turned farther from its start may have folded over
    turned : no triangle turns farther in one step to a minimal surface
    carried : no triangle turns farther in one step of its loop
    area_kept, normal_kept : what a vertex that slides leaves of each triangle's area, and
        of the direction of its normal
    """

    thin: float = 12.0
    thinned: float = 0.7
    vanishing: float = 5.0
    folded: float = 0.3
    turned: float = 0.5
    carried: float = 0.5
    area_kept: float = 0.3
    normal_kept: float = 0.8


LIMITS = TriangleLimits()


@dataclass(frozen=True)
class Tiling:
    """The triangles of a film, and where the entries of its matrices go.

    Attributes
    ----------
    triangles : (n_t, 3) int
    loop, interior : (n_b,) and (n_v - n_b,) int
    """

    triangles: IntArray
    loop: IntArray
    interior: IntArray
    # Where the entries of the film and its loop go, once that is known (with_loop.py).
    with_loop: list[Elimination] = field(default_factory=list, init=False, repr=False)

    @property
    def n_v(self) -> int:
        """Number of vertices."""
        return len(self.loop) + len(self.interior)

    @cached_property
    def is_inside(self) -> BoolArray:
        """Whether each vertex (n_v,) is inside."""
        inside = np.zeros(self.n_v, dtype=bool)
        inside[self.interior] = True
        return inside

    @cached_property
    def numbers(self) -> IntArray:
        """The place of each vertex (n_v,) among those inside, then those of the loop."""
        number = np.empty(self.n_v, dtype=np.int64)
        number[np.concatenate([self.interior, self.loop])] = np.arange(self.n_v)
        return number

    def with_triangles(self, triangles: IntArray) -> Tiling:
        """Return the tiling of the same vertices by other triangles (n_t, 3)."""
        return replace(self, triangles=triangles)

    def sides(self, x: FloatArray) -> TriangleGeometry:
        """Return the triangles of the shape x (n_v, 3)."""
        arrays = self._unmeasured()
        area_kernels.measure(np.ascontiguousarray(x), self.triangles, *arrays)
        return TriangleGeometry(*arrays)

    def standing(
        self, x: FloatArray, normals: FloatArray, cosine: float
    ) -> tuple[TriangleGeometry, FloatArray] | None:
        """Return the triangles of a shape x (n_v, 3) and the gradient of its area (n_v, 3).

        None where one turns from these normals (n_t, 3) by that cosine, or has no area.
        """
        arrays, gradient = self._unmeasured(), np.zeros((self.n_v, 3))
        known = x, self.triangles, normals, cosine
        if not area_kernels.stand(*known, *arrays, gradient):
            return None
        return TriangleGeometry(*arrays), gradient

    def _unmeasured(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        n = len(self.triangles)
        return np.empty((n, 3, 3)), np.empty((n, 3)), np.empty(n)

    def gradient(self, sides: TriangleGeometry) -> FloatArray:
        """Return the gradient of the area (n_v, 3)."""
        gradient = np.zeros((self.n_v, 3))
        area_kernels.sum_gradient(self.triangles, sides.edges, sides.normals, gradient)
        return gradient

    def gather(self, corners: FloatArray) -> FloatArray:
        """Sum what the corners (n_t, 3, 3) hold at each vertex (n_v, 3)."""
        return summed(self.triangles.ravel(), corners.reshape(-1, 3), self.n_v)

    def change(self, x: FloatArray, after: FloatArray) -> float:
        """Return area(after) - area(x) with the relative precision of the difference."""
        first, second = np.ascontiguousarray(x), np.ascontiguousarray(after)
        return area_kernels.change(first, second, self.triangles)

    def vertex_normals(self, sides: TriangleGeometry) -> FloatArray:
        """Return unit normals (n_v, 3), the triangles' weighted by their areas."""
        found = np.empty((self.n_v, 3))
        area_kernels.sum_normals(self.triangles, sides.normals, sides.areas, found)
        return found

    def cotangent_laplacian(self, sides: TriangleGeometry) -> FloatArray:
        """Return L with area gradient = L x, an entry for each of `pairs` (m,).

        The film at rest is L x = 0.
        """
        return self.filled(sides.cotangent)

    def filled(self, blocks: FloatArray) -> FloatArray:
        """Return what couples corners by blocks (n_t, 3, 3), by `pairs` (m,)."""
        place = self._scalar.place.ravel()
        return summed(place, blocks.ravel(), len(self._scalar.indices))

    def matrix(self, entries: FloatArray) -> csc_array:
        """Return the matrix (n_v, n_v) with these entries (m,), one for each of `pairs`."""
        data = entries, self._scalar.indices, self._scalar.indptr
        return csc_array(data, shape=2 * (self.n_v,))

    def normal_hessian(self, sides: TriangleGeometry, directions: FloatArray) -> FloatArray:
        """Return the Hessian for displacements along `directions` (n_v, 3), by `pairs`."""
        entries = np.zeros(len(self._scalar.indices))
        parts = sides.cotangent, sides.normals, self.triangles
        hessian_kernels.sum_along(*parts, directions, self._scalar.place, entries)
        return entries

    def hessian(self, sides: TriangleGeometry) -> FloatArray:
        """Return the whole Hessian, a block (3, 3) for each of `pairs` (m, 3, 3)."""
        blocks = np.zeros((len(self._scalar.indices), 3, 3))
        parts = sides.cotangent, sides.normals, self._scalar.place
        hessian_kernels.sum_hessian(*parts, blocks)
        return blocks

    def pull(self, blocks: FloatArray, moved: FloatArray) -> FloatArray:
        """Return a `hessian` (m, 3, 3) times a displacement (n_v, 3)."""
        i, k = self.pairs
        found = np.zeros((self.n_v, 3))
        hessian_kernels.pull(blocks, i, k, np.ascontiguousarray(moved), found)
        return found

    @property
    def pairs(self) -> tuple[IntArray, IntArray]:
        """The vertices of every entry (m,) of a matrix (n_v, n_v): its row, its column."""
        return self._scalar.indices, self._scalar.columns

    @cached_property
    def bare(self) -> NoStrip:
        """The film with no strip of it following its loop."""
        return NoStrip(self.loop, self.interior, self.pairs)

    @cached_property
    def neighbours(self) -> IntArray:
        """The triangle (n_t, 3) beyond the side opposite each corner, -1 at the loop."""
        return neighbours(self.triangles)

    @cached_property
    def pieces(self) -> list[IntArray]:
        """The interior, numbered 0 ... n_i - 1, in pieces to be eliminated one by one."""
        return self._dissected(LARGEST)

    @cached_property
    def small_pieces(self) -> list[IntArray]:
        """The same in smaller ones, for three unknowns per vertex."""
        return self._dissected(LARGEST // 3)

    def _dissected(self, largest: int) -> list[IntArray]:
        if len(self.interior) <= largest:
            return [np.arange(len(self.interior))] if len(self.interior) else []
        pairs = Graph(self._scalar.indptr, self._scalar.indices)
        pieces = dissect(pairs, self.loop, self.interior, largest)
        return [np.searchsorted(self.interior, piece) for piece in pieces]

    @cached_property
    def inside(self) -> tuple[IntArray, Elimination]:
        """Which pairs couple two vertices inside, and their matrix's elimination."""
        row, column = self.pairs
        both = np.flatnonzero(self.is_inside[row] & self.is_inside[column])
        none = np.zeros(0, dtype=np.int64)
        place = self.numbers
        # Solved with more often than factorised: pieces of half the size are less to read.
        pieces = self._dissected(LARGEST // 2)
        return both, plan(place[row[both]], place[column[both]], pieces, none)

    @cached_property
    def coupled(self) -> tuple[IntArray, IntArray, IntArray]:
        """Which pairs couple a vertex inside to the loop, and the places of the two."""
        row, column = self.pairs
        chosen = np.flatnonzero(self.is_inside[row] & ~self.is_inside[column])
        inside, on_loop = self.numbers[row[chosen]], self.numbers[column[chosen]]
        return chosen, inside, on_loop - len(self.interior)

    @cached_property
    def elimination(self) -> Elimination:
        """Of the interior from a matrix (n_v, n_v) with an entry for each of `pairs`."""
        pieces = [self.interior[piece] for piece in self.pieces]
        return plan(*self.pairs, pieces, self.loop)

    @cached_property
    def _scalar(self) -> _Pattern:
        return _Pattern.of(self.triangles, self.n_v)


@dataclass(frozen=True)
class _Pattern:
    """Where the entries of element matrices go in a sparse one.

    Attributes
    ----------
    indices, indptr : the sparse matrix's, column by column
    place : (n_t, 3, 3) int, the entry for each pair of a triangle's corners
    """

    indices: IntArray
    indptr: IntArray
    place: IntArray

    @classmethod
    def of(cls, triangles: IntArray, n: int) -> _Pattern:
        """Find the pattern of triangles (n_t, 3), each coupling its corners."""
        row = np.repeat(triangles, 3, axis=1).ravel()
        column = np.tile(triangles, 3).ravel()
        entries, place = np.unique(column * n + row, return_inverse=True)
        indptr = np.searchsorted(entries, np.arange(n + 1) * n)
        return cls(entries % n, indptr, place.reshape(-1, 3, 3))

    @cached_property
    def columns(self) -> IntArray:
        """The column of every entry."""
        return np.repeat(np.arange(len(self.indptr) - 1), np.diff(self.indptr))
