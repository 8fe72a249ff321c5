"""The displacements by which a film is varied, and what its second variation is by them.

Of its interior they are the heights along normals (`NormalHeights`), or all there are
(free_moves.py); of its loop all. What is inside is eliminated.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film import hessian_kernels
from eulerplateau.film.condensation import Condensation, factorise
from eulerplateau.film.elimination import Elimination, plan, summed
from eulerplateau.film.indefinite import IndefiniteFactor, factorise_indefinite
from eulerplateau.film.strip import NoStrip, Strip
from eulerplateau.film.tiling import Tiling, TriangleGeometry
from eulerplateau.film.with_loop import FilmWithLoop, LoopStiffness


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

    A strip of the film follows the loop, or none does (strip.py).

    Attributes
    ----------
    tiling : of the film
    normals : (n_v, 3) float, unit inside, zero on the loop
    strip : which vertices follow the loop
    """

    tiling: Tiling
    normals: FloatArray
    strip: NoStrip

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
        return replace(self, strip=self.tiling.bare)

    def _entries(self, blocks: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the Hessian's entries, flat, in the order of the strip's `chosen`."""
        heights, coupling, loop = self.strip.chosen
        up, across = np.empty(len(heights)), np.empty((len(coupling), 3))
        kept = np.empty((len(loop), 3, 3))
        i, k = self.tiling.pairs
        hessian_kernels.rise(blocks, heights, i, k, self.normals, up)
        hessian_kernels.rise_and_follow(
            blocks, coupling, i, k, self.normals, self.strip.weight, across
        )
        hessian_kernels.follow(blocks, loop, i, k, self.strip.weight, kept)
        return up, across.ravel(), kept.ravel()

    def followed(self, moved: FloatArray) -> FloatArray:
        """Return w dx_b (n_v, 3) of a displacement dx (n_b, 3)."""
        return self.strip.weight[:, None] * moved[self.strip.leader]

    def carried(self, forces: FloatArray) -> FloatArray:
        """Return the sums of w f (n_b, 3) over all that follow a vertex."""
        strip, n_b = self.strip, len(self.tiling.loop)
        return summed(strip.leader, strip.weight[:, None] * forces, n_b)

    @cached_property
    def _elimination(self) -> Elimination:
        """Where entries go while the heights are eliminated."""
        places = self.strip.places
        row, column = (np.concatenate(parts) for parts in zip(*places, strict=True))
        n_i = self.size
        kept = np.arange(n_i, n_i + 3 * len(self.tiling.loop))
        return plan(row, column, self.tiling.pieces, kept)

    @cached_property
    def _whole(self) -> FilmWithLoop:
        """The same where nothing is: without a strip it depends on triangles alone."""
        bare = self.strip is self.tiling.bare
        return FilmWithLoop(self.strip, self.tiling.with_loop if bare else [])


def normal_heights(tiling: Tiling, x: FloatArray, normals: FloatArray) -> NormalHeights:
    """Return the variations of a shape x (n_v, 3) with normals inside (n_i, 3)."""
    directions = np.zeros((tiling.n_v, 3))
    directions[tiling.interior] = normals
    strip = Strip(tiling.loop, tiling.interior, tiling.pairs, x)
    return NormalHeights(tiling, directions, strip)
