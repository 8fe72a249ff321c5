"""A coarser loop for a rough start: far fewer vertices, nearly the same minimum.

A random displacement of each vertex of a fine loop is a crumple, with most of its energy in
wavelengths of an edge. Newton's method has to unfold them one by one; a coarse loop does
not see them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film import Stiffness
from eulerplateau.loop import Loop, LoopEnergy, free_motions, inextensible


@dataclass(frozen=True)
class CoarseLoop:
    """A loop of n_c of the n_b vertices, straight in between.

    Attributes
    ----------
    loop : its edges' lengths
    energy : its bending, and the film's energy of the straight-edged loop
    """

    loop: Loop
    energy: LoopEnergy
    _arc: FloatArray
    _nodes: FloatArray
    _hats: FloatArray
    _mass: FloatArray

    def restrict(self, x: FloatArray) -> FloatArray:
        """Return the coarse loop (n_c, 3) nearest to x (n_b, 3) in mean square."""
        weighted = self._hats.T * self._mass
        return np.asarray(np.linalg.solve(weighted @ self._hats, weighted @ x))

    def prolong(self, x: FloatArray) -> FloatArray:
        """Return the smooth loop (n_b, 3) through a coarse one (n_c, 3)."""
        from scipy.interpolate import CubicSpline

        closed = np.concatenate([x, x[:1]])
        fine: FloatArray = CubicSpline(self._nodes, closed, bc_type="periodic")(self._arc)
        return fine


def coarsen(fine_loop: Loop, energy: LoopEnergy, n_c: int) -> CoarseLoop:
    """Keep n_c vertices of a loop with a film of fixed weights, evenly numbered."""
    s = fine_loop.rest_lengths
    arc = np.concatenate([[0.0], np.cumsum(s)])
    kept = np.linspace(0, len(s), n_c + 1).astype(np.int64)
    nodes = arc[kept]
    loop = Loop(np.diff(nodes))
    hats = np.zeros((len(s), n_c))
    fine = np.arange(len(s))
    behind = np.searchsorted(kept, fine, side="right") - 1
    share = (arc[:-1] - nodes[behind]) / loop.rest_lengths[behind]
    hats[fine, behind] = 1 - share
    hats[fine, (behind + 1) % n_c] += share
    film = hats.T @ energy.terms["film"].hessian(np.zeros((len(s), 3))) @ hats
    # tr(x^T S x) has the second derivative 2 S.
    term = Stiffness(0.25 * (film + film.T), 1.0)
    coarse = inextensible(loop, term, partial(free_motions, loop, slides=False))
    return CoarseLoop(loop, coarse, arc[:-1], nodes, hats, fine_loop.mean_lengths)
