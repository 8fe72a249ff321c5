"""The displacements by which a film is varied, and what its second variation is by them.

Of its interior they are the heights along normals (`NormalHeights`), or all there are
(free_moves.py); of its loop all. What is inside is eliminated.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film import hessian_kernels
from eulerplateau.film.condensation import Condensation, factorise
from eulerplateau.film.elimination import Elimination, plan, summed
from eulerplateau.film.indefinite import IndefiniteFactor, factorise_indefinite
from eulerplateau.film.tiling import Tiling, TriangleGeometry
from eulerplateau.film.with_loop import FilmWithLoop, LoopStiffness

# Width of the strip, in L: a circle's radius is 0.16. Where it reaches the middle between
# two strands those on either side follow different ones, the less the better.
_WIDTH = 0.1


class InteriorUnknowns(Protocol):
    """How the interior of a film may move: n_u unknowns."""

    @property
    def size(self) -> int:
        """n_u."""

    def displaced(self, u: FloatArray) -> FloatArray:
        """Return the displacement (n_i, 3) of unknowns (n_u,)."""

    def work(self, gradient: FloatArray) -> FloatArray:
        """Return what a gradient (n_v, 3) is by the unknowns (n_u,)."""

    def condense(self, blocks: FloatArray) -> Condensation:
        """Eliminate the unknowns of a Hessian, given by its blocks (m, 3, 3) of pairs.

        What remains is 3 n_b x 3 n_b. Raises LinAlgError unless the area resists them.
        """

    def with_loop(
        self, blocks: FloatArray, load: float, loop: LoopStiffness, strip: bool
    ) -> IndefiniteFactor:
        """Factorise a Hessian, `load` times, with what the film's loop adds.

        strip : whether a strip of the film follows the loop. Raises LinAlgError if a pivot
        vanishes, or where nothing but condensing will do.
        """

    def followed(self, moved: FloatArray) -> FloatArray:
        """Return how the film (n_v, 3) follows its loop (n_b, 3) while they are kept."""

    def carried(self, forces: FloatArray) -> FloatArray:
        """Return what forces (n_v, 3) then come to on the loop (n_b, 3): the adjoint."""


@dataclass(frozen=True)
class NormalHeights:
    """Displacements dx_v = n_v u_v + w_v dx_b, u the heights inside, b the leader of v.

    A strip of the film follows the loop. In the continuum the second variation with the
    interior relaxed is the same however the interior follows its loop, as long as it does
    so smoothly. On a mesh it differs by what the area depends on the places of its
    vertices: by O(h^2) where a strip of fixed width follows, by O(h) where none does, by
    nothing where the film is flat. In a strip each vertex has few neighbours that follow
    others: matrices stay sparse.

    Attributes
    ----------
    film : the film
    normals : (n_v, 3) float, unit inside, zero on the loop
    leader : (n_v,) int
        The number on the loop of the vertex that v follows: of the nearest, or itself.
    weight : (n_v,) float
        w: 1 on the loop, falling to 0 smoothly across the strip.
    """

    tiling: Tiling
    normals: FloatArray
    leader: IntArray
    weight: FloatArray

    @property
    def size(self) -> int:
        """One for each vertex inside."""
        return len(self.tiling.interior)

    def displaced(self, u: FloatArray) -> FloatArray:
        """Return n u (n_i, 3)."""
        return u[:, None] * self._inside

    def work(self, gradient: FloatArray) -> FloatArray:
        """Return n . g (n_i,)."""
        along: FloatArray = np.vecdot(gradient[self.tiling.interior], self._inside)
        return along

    @cached_property
    def _inside(self) -> FloatArray:
        """The normals inside (n_i, 3)."""
        return self.normals[self.tiling.interior]

    def stiffness(self, sides: TriangleGeometry) -> Condensation:
        """Factorise n . H n (n_i, n_i); LinAlgError unless it is positive definite."""
        entries = self.tiling.normal_hessian(sides, self.normals)
        pairs, elimination = self.tiling.inside
        return factorise(elimination, entries[pairs])

    def condense(self, blocks: FloatArray) -> Condensation:
        """Eliminate the heights."""
        up, across, kept = self._entries(blocks)
        return factorise(self._elimination, np.concatenate([up, across, kept]))

    def with_loop(
        self, blocks: FloatArray, load: float, loop: LoopStiffness, strip: bool
    ) -> IndefiniteFactor:
        """Factorise the film's Hessian, `load` times, with what its loop adds."""
        moves = self if strip else self.bare
        up, across, kept = moves._entries(blocks)
        film = load * np.concatenate([up, across, across, kept])
        return factorise_indefinite(*moves._whole.assemble(film, loop))

    @cached_property
    def bare(self) -> NormalHeights:
        """The variations in which no strip of the film follows the loop."""
        weight = np.where(self.tiling.is_inside, 0.0, 1.0)
        return replace(self, weight=weight)

    def _entries(self, blocks: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the Hessian's entries, flat, in the order of `_chosen`."""
        heights, coupling, loop = self._chosen
        up, across = np.empty(len(heights)), np.empty((len(coupling), 3))
        kept = np.empty((len(loop), 3, 3))
        i, k = self.tiling.pairs
        hessian_kernels.rise(blocks, heights, i, k, self.normals, up)
        hessian_kernels.rise_and_follow(
            blocks, coupling, i, k, self.normals, self.weight, across
        )
        hessian_kernels.follow(blocks, loop, i, k, self.weight, kept)
        return up, across.ravel(), kept.ravel()

    def followed(self, moved: FloatArray) -> FloatArray:
        """Return w dx_b (n_v, 3) of a displacement dx (n_b, 3)."""
        return self.weight[:, None] * moved[self.leader]

    def carried(self, forces: FloatArray) -> FloatArray:
        """Return the sums of w f (n_b, 3) over all that follow a vertex."""
        return summed(self.leader, self.weight[:, None] * forces, len(self.tiling.loop))

    @cached_property
    def _chosen(self) -> tuple[IntArray, IntArray, IntArray]:
        """Which pairs couple heights, a height and the loop, the loop and the loop."""
        i, k = self.tiling.pairs
        inside = self.tiling.is_inside
        follows = self.weight > 0
        return (
            np.flatnonzero(inside[i] & inside[k]),
            np.flatnonzero(inside[i] & follows[k]),
            np.flatnonzero(follows[i] & follows[k]),
        )

    def _places(self) -> tuple[tuple[IntArray, IntArray], ...]:
        """Rows and columns of `_entries`: heights, then three for a loop vertex."""
        number, (heights, coupling, loop) = self.tiling.numbers, self._chosen
        i, k = self.tiling.pairs
        on_loop = len(self.tiling.interior) + 3 * self.leader[:, None] + np.arange(3)
        return (
            (number[i[heights]], number[k[heights]]),
            (np.repeat(number[i[coupling]], 3), on_loop[k[coupling]].ravel()),
            (
                np.repeat(on_loop[i[loop]], 3, axis=1).ravel(),
                np.tile(on_loop[k[loop]], 3).ravel(),
            ),
        )

    @cached_property
    def _elimination(self) -> Elimination:
        row, column = (np.concatenate(parts) for parts in zip(*self._places(), strict=True))
        n_i = len(self.tiling.interior)
        kept = np.arange(n_i, n_i + 3 * len(self.tiling.loop))
        return plan(row, column, self.tiling.pieces, kept)

    @cached_property
    def _whole(self) -> FilmWithLoop:
        up, (inside, on_loop), kept = self._places()
        row = np.concatenate([up[0], inside, on_loop, kept[0]])
        column = np.concatenate([up[1], on_loop, inside, kept[1]])
        n_i, n_b = len(self.tiling.interior), len(self.tiling.loop)
        # Without a strip it depends on the triangles alone.
        bare = not (self.weight[self.tiling.interior] > 0).any()
        return FilmWithLoop(n_i, n_b, row, column, self.tiling.with_loop if bare else [])


def normal_heights(tiling: Tiling, x: FloatArray, normals: FloatArray) -> NormalHeights:
    """Return the variations of a shape x (n_v, 3) with normals inside (n_i, 3)."""
    from scipy.spatial import cKDTree  # slow to load, and only soap films need it

    loop, inside = tiling.loop, tiling.interior
    distance, nearest = cKDTree(x[loop]).query(x[inside])
    directions, weight = np.zeros((tiling.n_v, 3)), np.ones(tiling.n_v)
    directions[inside] = normals
    leader = np.zeros(tiling.n_v, dtype=np.int64)
    leader[loop], leader[inside] = np.arange(len(loop)), nearest
    weight[inside] = np.square(np.maximum(1 - distance / _WIDTH, 0.0))
    return NormalHeights(tiling, directions, leader, weight)
