"""A loop in contact with itself: its lengths are kept, and gaps that are closed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.energy import Constraint, LoopEnergy
from eulerplateau.loop.gaps import Between, Gaps
from eulerplateau.loop.strands import Strands
from eulerplateau.loop.term import summed
from eulerplateau.loop.turns import EdgeTurns

_STEPS = 30
_SMALL = 1e-12


@dataclass(frozen=True)
class HeldGaps:
    """Every edge keeps its length, and k gaps are closed: n + k equations.

    A gap's multiplier is minus the force f with which the strands push each other there.
    """

    lengths: Constraint
    strands: Strands
    gaps: Gaps
    _known: list[tuple[FloatArray, Between]] = field(default_factory=list, repr=False)

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Return the equations' derivatives (n + k, d n)."""
        return np.vstack([self.lengths.jacobian(x), self._between(x).jacobian()])

    def force(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return J^T tensions (n, d)."""
        n = len(x)
        push = tensions[n:] @ self._between(x).jacobian()
        return self.lengths.force(x, tensions[:n]) + push.reshape(x.shape)

    def stiffness(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the second derivative (d n, d n) of tensions . c."""
        n = len(x)
        shared = self.lengths.stiffness(x, tensions[:n])
        return summed([shared, self._between(x).hessian(tensions[n:], self.gaps.slides)], n)

    def turns(self, x: FloatArray) -> EdgeTurns | None:
        """Return the turns of the edges, with how they change the gaps."""
        turns = self.lengths.turns(x)
        if turns is None or not len(self.gaps):
            return turns
        return replace(turns, others=self._between(x).jacobian())

    def split_stiffness(
        self, x: FloatArray, tensions: FloatArray
    ) -> tuple[FloatArray | None, FloatArray]:
        """Return what the gaps add by positions, and tensions / s (n,) by edges."""
        n = len(x)
        _, by_edges = self.lengths.split_stiffness(x, tensions[:n])
        if not len(self.gaps):
            return None, by_edges
        return self._between(x).hessian(tensions[n:], self.gaps.slides), by_edges

    def _between(self, x: FloatArray) -> Between:
        """Return what is known between the places, followed to a loop x (n, d)."""
        if not (self._known and np.array_equal(self._known[0][0], x)):
            at, _ = self.strands.at(x, self.gaps)
            self._known[:] = [(x.copy(), self.strands.between(x, at))]
        return self._known[0][1]

    def project(self, x: FloatArray) -> FloatArray | None:
        """Return a loop near by that keeps lengths and gaps, to rounding; None if lost.

        Gauss-Newton in the norm sum_v <s_v> |dx_v|^2 + l^4 int |dx''|^2 ds.
        """
        if not len(self.gaps):
            return self.lengths.project(x)
        loop, error = self.strands.loop, np.inf
        for _ in range(_STEPS):
            try:
                at, gaps = self.strands.at(x, self.gaps)
                excess = np.concatenate([loop.constraint(x), gaps])
                size = np.concatenate([loop.rest_lengths, np.ones(len(gaps))])
                error, before = float(np.abs(excess / size).max()), error
                if error < 1e-15 or (error < _SMALL and error >= 0.25 * before):
                    return x
                rows = np.vstack(
                    [self.lengths.jacobian(x), self.strands.between(x, at).jacobian()]
                )
                x = x - self._closing(rows, excess, x.shape)
            except LinAlgError:
                return None
            if not np.isfinite(x).all():
                return None
        return x if error < _SMALL else None

    def tensions(self, x: FloatArray, force: FloatArray) -> FloatArray:
        """Return the tensions (n + k,) that balance a force (n, d) best in that norm.

        They tell what strands push with, wherever between vertices they touch.
        """
        rows = self.jacobian(x)
        moved = (self.strands.compliance @ force).ravel()
        moves = self.moves(rows, x.shape)
        found: FloatArray = -cho_solve(cho_factor(rows @ moves), rows @ moved)
        return found

    def _closing(
        self, rows: FloatArray, excess: FloatArray, shape: tuple[int, int]
    ) -> FloatArray:
        """Return the least displacement (n, d) that changes the equations by so much."""
        moves = self.moves(rows, shape)
        shares = cho_solve(cho_factor(rows @ moves), excess)
        closing: FloatArray = (moves @ shares).reshape(shape)
        return closing

    def moves(self, rows: FloatArray, shape: tuple[int, int]) -> FloatArray:
        """Return the displacements (n d, m) of that norm that rows (m, d n) are dual to."""
        n, d = shape
        by_vertex: FloatArray = np.ascontiguousarray(
            rows.reshape(-1, n, d).transpose(1, 0, 2)
        )
        moved: FloatArray = (self.strands.compliance @ by_vertex.reshape(n, -1)).reshape(
            by_vertex.shape
        )
        return moved.transpose(0, 2, 1).reshape(n * d, -1)


def with_gaps_held(energy: LoopEnergy, strands: Strands, gaps: Gaps) -> LoopEnergy:
    """Return an energy of a loop that has a diameter, with some gaps kept closed."""
    return replace(energy, constraint=HeldGaps(energy.constraint, strands, gaps))
