"""Which vertices of a film follow its loop, and where the entries of its Hessian go then.

In the continuum the second variation with the interior relaxed is the same however the
interior follows its loop, as long as it does so smoothly. On a mesh it differs by what the
area depends on the places of its vertices: by O(h^2) where a strip of fixed width follows,
by O(h) where none does, by nothing where the film is flat. In a strip each vertex has few
neighbours that follow others: matrices stay sparse.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray

# Width of the strip, in L: a circle's radius is 0.16. Where it reaches the middle between
# two strands those on either side follow different ones, the less the better.
_WIDTH = 0.1


@dataclass(frozen=True)
class NoStrip:
    """No vertex inside follows the loop: all this depends on the triangles alone.

    Attributes
    ----------
    loop, interior : (n_b,) and (n_i,) int, the vertices
    pairs : (m,) int each, of the Hessian's blocks the vertices, row and column
    """

    loop: IntArray
    interior: IntArray
    pairs: tuple[IntArray, IntArray]

    @cached_property
    def leader(self) -> IntArray:
        """The number on the loop of the vertex that each (n_v,) follows, itself there.

        Of vertices that follow none it is no matter.
        """
        leader = np.zeros(len(self.loop) + len(self.interior), dtype=np.int64)
        leader[self.loop] = np.arange(len(self.loop))
        return leader

    @cached_property
    def weight(self) -> FloatArray:
        """By which part each (n_v,) follows: 1 on the loop, 0 inside."""
        weight = np.ones(len(self.loop) + len(self.interior))
        weight[self.interior] = 0.0
        return weight

    @cached_property
    def chosen(self) -> tuple[IntArray, IntArray, IntArray]:
        """Which pairs couple heights, a height and the loop, the loop and the loop."""
        i, k = self.pairs
        inside = np.zeros(len(self.weight), dtype=bool)
        inside[self.interior] = True
        follows = self.weight > 0
        return (
            np.flatnonzero(inside[i] & inside[k]),
            np.flatnonzero(inside[i] & follows[k]),
            np.flatnonzero(follows[i] & follows[k]),
        )

    @cached_property
    def places(self) -> tuple[tuple[IntArray, IntArray], ...]:
        """Rows and columns of the entries: heights, then three for a loop vertex."""
        (heights, coupling, loop), (i, k) = self.chosen, self.pairs
        number = np.empty(len(self.leader), dtype=np.int64)
        number[self.interior] = np.arange(len(self.interior))
        on_loop = len(self.interior) + 3 * self.leader[:, None] + np.arange(3)
        return (
            (number[i[heights]], number[k[heights]]),
            (np.repeat(number[i[coupling]], 3), on_loop[k[coupling]].ravel()),
            (
                np.repeat(on_loop[i[loop]], 3, axis=1).ravel(),
                np.tile(on_loop[k[loop]], 3).ravel(),
            ),
        )


@dataclass(frozen=True)
class Strip(NoStrip):
    """Vertices of a shape x (n_v, 3) near its loop follow that: found where it is asked."""

    x: FloatArray

    @cached_property
    def leader(self) -> IntArray:
        """The nearest vertex of the loop."""
        return self._followed[0]

    @cached_property
    def weight(self) -> FloatArray:
        """It falls to 0 smoothly across the strip."""
        return self._followed[1]

    @cached_property
    def _followed(self) -> tuple[IntArray, FloatArray]:
        from scipy.spatial import cKDTree  # slow to load, and flat films do not need it

        loop, inside = self.loop, self.interior
        bare = NoStrip(loop, inside, self.pairs)
        distance, nearest = cKDTree(self.x[loop]).query(self.x[inside])
        leader, weight = bare.leader, bare.weight
        leader[inside] = nearest
        weight[inside] = np.square(np.maximum(1 - distance / _WIDTH, 0.0))
        return leader, weight
