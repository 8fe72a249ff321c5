"""A coarser loop for a rough start: far fewer vertices, nearly the same minimum.

A random displacement of each vertex of a fine loop is a crumple, with most of its energy in
wavelengths of an edge. Newton's method has to unfold them one by one; a coarse loop does
not see them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film import Stiffness
from eulerplateau.loop import (
    Bending,
    Loop,
    LoopEnergy,
    Term,
    close_with_lengths,
    free_motions,
    inextensible,
)

# A loop is rough if its energy is so many times that of the smooth one next to it.
_ROUGH = 2.0


@dataclass(frozen=True)
class CoarseLoop:
    """A loop of n_c of the n_b vertices, straight in between.

    Attributes
    ----------
    loop : its edges' lengths
    kept : (n_c,) int, places of its vertices in the fine one
    """

    loop: Loop
    kept: IntArray
    _fine: Loop
    _arc: FloatArray
    _nodes: FloatArray
    _hats: FloatArray

    def restrict(self, x: FloatArray) -> FloatArray:
        """Return the coarse loop (n_c, 3) nearest to x (n_b, 3) in mean square."""
        weighted = self._hats.T * self._fine.mean_lengths
        return np.asarray(np.linalg.solve(weighted @ self._hats, weighted @ x))

    def prolong(self, x: FloatArray) -> FloatArray:
        """Return the smooth loop (n_b, 3) through a coarse one (n_c, 3)."""
        from scipy.interpolate import CubicSpline

        closed = np.concatenate([x, x[:1]])
        fine: FloatArray = CubicSpline(self._nodes, closed, bc_type="periodic")(self._arc)
        return fine

    def start(self, x: FloatArray) -> FloatArray | None:
        """Return the coarse loop next to x (n_b, 3) that keeps its own lengths, if any."""
        return close_with_lengths(self.loop, self.restrict(x))

    def smooth(self, coarse: FloatArray) -> FloatArray | None:
        """Return the smooth loop (n_b, 3) that keeps all lengths, next to a coarse one."""
        return close_with_lengths(self._fine, self.prolong(coarse))

    def smoothed(self, x: FloatArray) -> FloatArray | None:
        """Return the smooth loop next to one (n_b, 3) that has been crumpled; else None."""
        start = self.start(x)
        smooth = None if start is None else self.smooth(start)
        if smooth is None or not is_rough(Bending(self._fine), x, smooth):
            return None
        return smooth

    def energy(self, fine: LoopEnergy) -> LoopEnergy:
        """Return its bending, and the energy of a film of fixed weights on it."""
        nowhere = np.zeros((len(self._arc), 3))
        film = self._hats.T @ fine.terms["film"].hessian(nowhere) @ self._hats
        # tr(x^T S x) has the second derivative 2 S.
        term = Stiffness(0.25 * (film + film.T), 1.0)
        motions = partial(free_motions, self.loop, slides=False)
        return inextensible(self.loop, term, motions)


def coarsen(fine: Loop, n_c: int) -> CoarseLoop:
    """Keep n_c vertices of a loop, evenly numbered."""
    s = fine.rest_lengths
    arc = np.concatenate([[0.0], np.cumsum(s)])
    kept = np.linspace(0, len(s), n_c + 1).astype(np.int64)
    nodes = arc[kept]
    loop = Loop(np.diff(nodes))
    hats = np.zeros((len(s), n_c))
    vertices = np.arange(len(s))
    behind = np.searchsorted(kept, vertices, side="right") - 1
    share = (arc[:-1] - nodes[behind]) / loop.rest_lengths[behind]
    hats[vertices, behind] = 1 - share
    hats[vertices, (behind + 1) % n_c] += share
    return CoarseLoop(loop, kept[:-1], fine, arc[:-1], nodes, hats)


def is_rough(energy: Term | LoopEnergy, x: FloatArray, smooth: FloatArray) -> bool:
    """Return whether a loop (n_b, 3) has most of an energy in its roughness.

    The energy is a quadratic form of the positions.
    """
    nowhere = np.zeros_like(x)
    return energy.change(nowhere, x) > _ROUGH * energy.change(nowhere, smooth)
