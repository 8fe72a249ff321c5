"""The energy of a curved rod with its frame: how that comes to rest, and gives way.

A function of the loop x (n, 3) and of angles psi (n,) by which the frame is turned about
the edges. At rest the frame takes what it can have least, and the loop feels

    force E_x,    stiffness E_xx - E_xpsi E_psipsi^-1 E_psix.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cholesky, solve_triangular

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.bend_kernels import bend, bend_twice
from eulerplateau.loop.frame_kernels import settle
from eulerplateau.loop.frames import Frame
from eulerplateau.loop.loop import backward_differences, differences
from eulerplateau.loop.writhe_kernels import (
    add_edge_blocks,
    writhe_by_edges,
    writhe_second,
)

# The last digits of a frame do not depend on where it came from: it settles anew from
# angles on this grid.
_GRID = 2.0**-13
# Radians by which a frame leaves a pass, and what of the springs holds one that is free.
_PUSHED = 0.1
_HELD = 1e-12


@dataclass(frozen=True)
class FramedEnergy:
    """sum_v -2 k0 k1_v <s_v> + k0^2 <s_v> + (1/2) c_v m_v^2, m_v the twist at a vertex.

    Attributes
    ----------
    natural : float, k0
    springs : (n,) float, c_v, of the vertex after each edge
    length : float, of the loop
    """

    natural: float
    springs: FloatArray
    length: float

    def energy(self, frame: Frame) -> float:
        """Return the energy."""
        bent = bend(frame.tangents, frame.lengths, frame.directors)[0]
        bending = self.natural * (self.natural * self.length - 2 * bent)
        return bending + 0.5 * float(self.springs @ frame.twists**2)

    def force(self, frame: Frame) -> FloatArray:
        """Return E_x (n, 3)."""
        bent = bend(frame.tangents, frame.lengths, frame.directors)[3]
        twist = writhe_by_edges(differences(frame.x), self.springs * frame.twists)
        return backward_differences(2 * self.natural * bent + 2 * math.pi * twist)

    def best_turned(self, frame: Frame) -> Frame:
        """Return a frame turned as a whole to where it costs least, and come to rest."""
        cosines, sines = self._pulls(frame)
        turn = math.atan2(-sines.sum(), -cosines.sum())
        return self.settled(frame, np.full(len(sines), turn))

    def settled(self, frame: Frame, angles: FloatArray) -> Frame:
        """Return the frame at rest that turning one by angles (n,) leads to.

        Raises LinAlgError if there is none.
        """
        rough = self._lowered(frame, angles)
        rough -= 2 * math.pi * round(rough[0] / (2 * math.pi))
        return frame.turned(self._lowered(frame, _GRID * np.round(rough / _GRID)))

    def at_rest(self, frame: Frame) -> Frame:
        """Return the frame that one near by leads to, but for its last digits."""
        return frame.turned(self._lowered(frame, np.zeros(len(frame.x))))

    def _lowered(self, frame: Frame, angles: FloatArray) -> FloatArray:
        """Return the angles (n,) of least energy that these lead down to."""
        found, pulls = angles.copy(), self._pulls(frame)
        if settle(*pulls, self.springs, frame.twists, found):
            return found
        # At rest, and yet on a pass: either way down will do.
        own = -pulls[0] * np.cos(found) - pulls[1] * np.sin(found)
        found += _PUSHED * np.linalg.eigh(self._chain(own))[1][:, 0]
        if not settle(*pulls, self.springs, frame.twists, found):
            raise LinAlgError("the rod's frame does not come to rest")
        return found

    def _pulls(self, frame: Frame) -> tuple[FloatArray, FloatArray]:
        """Return what multiplies cosines and sines (n,) of its angles in the energy."""
        _, cosines, sines, _ = bend(frame.tangents, frame.lengths, frame.directors)
        return -2 * self.natural * cosines, -2 * self.natural * sines

    def _chain(self, own: FloatArray) -> FloatArray:
        """Return diag(own) (n, n) and the closed chain of springs."""
        matrix = np.diag(own + self.springs + np.roll(self.springs, 1))
        i = np.arange(len(own))
        np.subtract.at(matrix, (i, (i + 1) % len(i)), self.springs)
        np.subtract.at(matrix, ((i + 1) % len(i), i), self.springs)
        return matrix

    def hessian(self, frame: Frame) -> FloatArray:
        """Return the stiffness of the loop (3 n, 3 n), its frame at rest all the time."""
        n = len(frame.x)
        own, beside, *mixed = self._second(frame)
        twist = -2 * math.pi * self.springs * frame.twists
        of_twist = writhe_second(differences(frame.x), twist)
        first, then = _twist_slopes(frame)
        stiff = self.springs[:, None, None]
        own += 0.5 * (of_twist[0] + of_twist[0].transpose(0, 2, 1))
        own += stiff * _outer(first, first) + np.roll(stiff * _outer(then, then), 1, axis=0)
        beside += of_twist[1] + stiff * _outer(first, then)
        matrix = np.zeros((n, 3, n, 3))
        add_edge_blocks(own, beside, 1.0, matrix)
        whole = matrix.reshape(3 * n, 3 * n)
        given = _solve(self._root(frame), self._mixed(frame, mixed))
        whole -= given.T @ given
        return whole

    def rate_of_curvature(self, frame: Frame, rate: float) -> FloatArray:
        """Return what the force (n, 3) gains as k0 grows at a rate."""
        _, _, sines, bent = bend(frame.tangents, frame.lengths, frame.directors)
        held = 2 * rate * backward_differences(bent)
        return self._with_frame(frame, held, -2 * rate * sines)

    def rate_of_moments(self, frame: Frame, rates: FloatArray) -> FloatArray:
        """Return what the force (n, 3) gains as moments grow at rates (n,).

        The moment c_v m_v at the vertex after each edge, the frame held.
        """
        twist = writhe_by_edges(differences(frame.x), rates)
        held = 2 * math.pi * backward_differences(twist)
        return self._with_frame(frame, held, np.roll(rates, 1) - rates)

    def _with_frame(self, frame: Frame, held: FloatArray, angles: FloatArray) -> FloatArray:
        """Return a change of force (n, 3), with what the frame's own (n,) leads to."""
        root = self._root(frame)
        mixed = self._mixed(frame, self._second(frame)[2:])
        moved = _solve(root, _solve(root, angles), trans=1)
        found: FloatArray = held - (moved @ mixed).reshape(held.shape)
        return found

    def _second(self, frame: Frame) -> list[FloatArray]:
        """Return what the natural curvature adds to second derivatives: see bend_twice."""
        parts = bend_twice(frame.tangents, frame.lengths, frame.directors)
        return [-2 * self.natural * part for part in parts]

    def _root(self, frame: Frame) -> FloatArray:
        """Return a lower triangular R (n, n), R R^T = E_psipsi."""
        matrix = self._chain(-self._pulls(frame)[0])
        try:
            root: FloatArray = cholesky(matrix, lower=True, check_finite=False)
        except LinAlgError:
            # Of a frame that turns for nothing, as that of a ring may.
            held = _HELD * float(self.springs.max()) * np.eye(len(matrix))
            root = cholesky(matrix + held, lower=True)
        return root

    def _mixed(self, frame: Frame, of_bending: list[FloatArray]) -> FloatArray:
        """Return E_psix (n, 3 n); `of_bending`: the last three parts of `_second`."""
        n = len(frame.x)
        before, own, after = of_bending
        first, then = (self.springs[:, None] * part for part in _twist_slopes(frame))
        i = np.arange(n)
        by_edges = np.zeros((n, n, 3))
        by_edges[i, i - 1] += before + np.roll(first, 1, axis=0)
        by_edges[i, i] += own + np.roll(then, 1, axis=0) - first
        by_edges[i, (i + 1) % n] += after - then
        by_x: FloatArray = np.roll(by_edges, 1, axis=1) - by_edges
        return by_x.reshape(n, 3 * n)


def _twist_slopes(frame: Frame) -> tuple[FloatArray, FloatArray]:
    """Return how each twist (n, 3) changes with the edge before it, and with that after."""
    t, u = frame.tangents, np.roll(frame.tangents, -1, axis=0)
    lengths = frame.lengths[:, None]
    binormals = np.cross(t, u) / (1 + (t * u).sum(axis=1))[:, None]
    return binormals / lengths, binormals / np.roll(lengths, -1, axis=0)


def _solve(root: FloatArray, rhs: FloatArray, trans: int = 0) -> FloatArray:
    """Return R^-1 rhs, or R^-T rhs, of a lower triangular R."""
    found: FloatArray = solve_triangular(
        root, rhs, lower=True, trans=trans, check_finite=False
    )
    return found


def _outer(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[:, :, None] * b[:, None, :]
