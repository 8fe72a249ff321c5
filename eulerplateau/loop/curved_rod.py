"""The energy of a rod that is curved by nature, beside that of its bending.

In units alpha = L = 1, with the frame d1, d2 = t x d1 of the rod along the loop t,

    E = oint (k1 - k0)^2 + k2^2 + (gamma / 2) Omega^2 ds,    k1 = t' . d1,   k2 = t' . d2,

k0 = 2 pi q, gamma = 2 C / B and Omega = d2 . d1'. Of this oint kappa^2 is the bending; the
rest depends on the frame, which takes its least for the loop that is given: a function of
the loop then, whose force is what is felt with the frame held, and which is softer by what
the frame gives way. There C Omega' = -2 k0 k2, so that twist and moment are not even.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from scipy.linalg import LinAlgError, cholesky, solve_triangular

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.bend_kernels import bend, bend_twice
from eulerplateau.loop.frame_kernels import settle
from eulerplateau.loop.frames import Frame
from eulerplateau.loop.loop import Loop, backward_differences, differences
from eulerplateau.loop.term import OwnTerm
from eulerplateau.loop.writhe_kernels import (
    add_edge_blocks,
    tangent_area,
    writhe,
    writhe_by_edges,
    writhe_second,
)

# Two strands that pass through each other change the writhe by 2.
_PASSED = 0.5
# Loops whose frames are kept: where a step begins, and where it may end.
_KEPT = 4
# The cosine of the angle up to which tangents are turned for frames to be carried over.
_NEAR = 0.8
# A frame's last digits do not depend on where it came from: it settles from these angles.
_GRID = 2.0**-13
# Of the energy's size: what a frame gains that jumps, and quadrature along a step cannot.
_JUMPED = 1e-6


@dataclass(frozen=True)
class CurvedRod(OwnTerm):
    """A rod's energy beside its bending, on a welded loop x (n, 3), in units of alpha / L.

    The weld is at the first vertex: there the frame is turned by what `link` is beyond
    whole turns.

    Attributes
    ----------
    loop : its edges' lengths
    ratio : float, C / B
    link : float, Lk, in turns; right-handed turns count positive
    curvature : float, q, the natural curvature over that of a circle
    """

    loop: Loop
    ratio: float
    link: float
    curvature: float
    _known: list[Frame] = field(default_factory=list, repr=False)
    _near: tuple[Frame, ...] = field(default=(), repr=False)

    @property
    def gamma(self) -> float:
        """C / alpha."""
        return 2 * self.ratio

    @cached_property
    def natural(self) -> float:
        """The natural curvature k0."""
        return 2 * math.pi * self.curvature / float(self.loop.rest_lengths.sum())

    @cached_property
    def springs(self) -> FloatArray:
        """What a unit of twist (n,) at the vertex after each edge has for a moment."""
        return self.gamma / np.roll(self.loop.mean_lengths, -1)

    @property
    def is_handed(self) -> bool:
        """Whether a loop and its mirror image differ in energy: if it was turned."""
        return self.link != 0.0

    @property
    def slides(self) -> bool:
        """Whether the loop slides along itself for nothing: not where a weld is seen."""
        return self.link == round(self.link)

    @property
    def rounding(self) -> float:
        """What rounding alone leaves of the force, per unit of position."""
        shortest = float(self.loop.rest_lengths.min())
        stiffness = self.gamma * (2 * math.pi) ** 2 * (abs(self.link) + 1)
        eps = float(np.finfo(np.float64).eps)
        return eps * (stiffness + abs(self.natural)) * 4 / shortest**2

    def frame(self, x: FloatArray) -> Frame:
        """Return the frame at rest on a loop, that which those known near by lead to.

        Raises LinAlgError if there is none.
        """
        for known in self._known:
            if np.array_equal(known.x, x):
                return known
        even = Frame.even(x, self.link - writhe(np.ascontiguousarray(x)))
        starts = (*self._known, *self._near)
        near = min(starts, key=lambda start: _away(start, even), default=None)
        if near is None or _away(near, even) > 1 - _NEAR:
            found = self._settled(even, self._best_turn(even))
        else:
            found = self._settled(even, even.angles_to(near))
        self._known[:] = [found, *self._known[: _KEPT - 1]]
        return found

    def _best_turn(self, even: Frame) -> FloatArray:
        """Return the angle by which a frame is best turned as a whole, for each edge."""
        _, cosines, sines, _ = bend(even.tangents, even.lengths, even.directors)
        turn = math.atan2(self.natural * sines.sum(), self.natural * cosines.sum())
        return np.full(len(even.x), turn)

    def _settled(self, even: Frame, angles: FloatArray) -> Frame:
        """Return the frame at rest that turning an even one by angles (n,) leads to."""
        pulls = self._pulls(even)
        rough = self._lowered(pulls, even.twists, angles)
        rough -= 2 * math.pi * round(rough[0] / (2 * math.pi))
        return even.turned(
            self._lowered(pulls, even.twists, _GRID * np.round(rough / _GRID))
        )

    def _pulls(self, frame: Frame) -> tuple[FloatArray, FloatArray]:
        """Return what multiplies cosines and sines (n,) of its turns in the energy."""
        _, cosines, sines, _ = bend(frame.tangents, frame.lengths, frame.directors)
        return -2 * self.natural * cosines, -2 * self.natural * sines

    def _lowered(
        self, pulls: tuple[FloatArray, FloatArray], twists: FloatArray, angles: FloatArray
    ) -> FloatArray:
        """Return the angles (n,) of least energy that these lead down to."""
        found = angles.copy()
        if settle(*pulls, self.springs, twists, found):
            return found
        # At rest, and yet on a pass: either way down will do.
        curvature = -pulls[0] * np.cos(found) - pulls[1] * np.sin(found)
        found += 0.1 * np.linalg.eigh(self._chain(curvature))[1][:, 0]
        if not settle(*pulls, self.springs, twists, found):
            raise LinAlgError("the rod's frame does not come to rest")
        return found

    def _chain(self, own: FloatArray) -> FloatArray:
        """Return diag(own) (n, n) and the closed chain of springs."""
        matrix = np.diag(own + self.springs + np.roll(self.springs, 1))
        i = np.arange(len(own))
        np.subtract.at(matrix, (i, (i + 1) % len(i)), self.springs)
        np.subtract.at(matrix, ((i + 1) % len(i), i), self.springs)
        return matrix

    def moments(self, x: FloatArray) -> FloatArray:
        """Return the twisting moment C Omega (n,) at the vertex after each edge."""
        moments: FloatArray = self.springs * self.frame(x).twists
        return moments

    def twist_energy(self, x: FloatArray) -> float:
        """Return the part of the energy that is twist's."""
        return 0.5 * float(self.moments(x) @ self.frame(x).twists)

    def energy(self, x: FloatArray) -> float:
        """Return the energy, of bending against the natural curvature and of twist."""
        return self._energy(self.frame(x))

    def _energy(self, frame: Frame) -> float:
        length = float(self.loop.rest_lengths.sum())
        bent = bend(frame.tangents, frame.lengths, frame.directors)[0]
        bending = self.natural * (self.natural * length - 2 * bent)
        return bending + 0.5 * float(self.springs @ frame.twists**2)

    def columns(self, x: FloatArray) -> Mapping[str, float]:
        """Return what a table says of the twist of a loop; the moment is that at the weld.

        There the work of a turn more is done, dE/dLk = 2 pi M.
        """
        return {
            "twist_energy": self.twist_energy(x),
            "writhe": self.link - self.frame(x).turns,
            "link": self.link,
            "twist_moment": float(self.moments(x)[-1]),
            "rest_curvature": self.curvature,
        }

    def fields(self, x: FloatArray) -> Mapping[str, FloatArray]:
        """Return d1, at each vertex that of the edge behind it."""
        return {"director": self.frame(x).directors}

    def pinched(self, x: FloatArray) -> bool:
        """Return whether strands meet: without thickness no twist is held beyond that."""
        return self.loop.strands_meet(x)

    def force(self, x: FloatArray) -> FloatArray:
        """Return the gradient (n, 3), the frame held: at rest it adds nothing."""
        return self._force(self.frame(x))

    def _force(self, frame: Frame) -> FloatArray:
        bent = bend(frame.tangents, frame.lengths, frame.directors)[3]
        twist = writhe_by_edges(differences(frame.x), self.springs * frame.twists)
        return backward_differences(2 * self.natural * bent + 2 * math.pi * twist)

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return E_xx - E_xpsi E_psipsi^-1 E_psix (3 n, 3 n), psi the frame's angles."""
        frame, n = self.frame(x), len(x)
        own, beside, *_ = self._second(frame)
        shares = -2 * math.pi * self.springs * frame.twists
        of_twist = writhe_second(differences(x), shares)
        first, then = _twist_slopes(frame)
        stiff = self.springs[:, None, None]
        own += 0.5 * (of_twist[0] + of_twist[0].transpose(0, 2, 1))
        own += stiff * _outer(first, first) + np.roll(stiff * _outer(then, then), 1, axis=0)
        beside += of_twist[1] + stiff * _outer(first, then)
        matrix = np.zeros((n, 3, n, 3))
        add_edge_blocks(own, beside, 1.0, matrix)
        whole = matrix.reshape(3 * n, 3 * n)
        given = solve_triangular(self._root(frame), self._mixed(frame), lower=True)
        whole -= given.T @ given
        return whole

    def _second(self, frame: Frame) -> list[FloatArray]:
        """Return what the natural curvature adds to second derivatives: see bend_twice."""
        parts = bend_twice(frame.tangents, frame.lengths, frame.directors)
        return [-2 * self.natural * part for part in parts]

    def _root(self, frame: Frame) -> FloatArray:
        """Return a lower triangular R (n, n) with R R^T the frame's own stiffness."""
        matrix = self._chain(-self._pulls(frame)[0])
        try:
            root: FloatArray = cholesky(matrix, lower=True)
        except LinAlgError:
            # Of a frame that turns for nothing, as that of a ring may.
            matrix += 1e-12 * float(self.springs.max()) * np.eye(len(matrix))
            root = cholesky(matrix, lower=True)
        return root

    def _mixed(self, frame: Frame) -> FloatArray:
        """Return the second derivative (n, 3 n) by the frame's angles and positions."""
        n = len(frame.x)
        *_, before, own, after = self._second(frame)
        first, then = (self.springs[:, None] * part for part in _twist_slopes(frame))
        i = np.arange(n)
        by_edges = np.zeros((n, n, 3))
        by_edges[i, i - 1] += before + np.roll(first, 1, axis=0)
        by_edges[i, i] += own + np.roll(then, 1, axis=0) - first
        by_edges[i, (i + 1) % n] += after - then
        by_x: FloatArray = np.roll(by_edges, 1, axis=1) - by_edges
        return by_x.reshape(n, 3 * n)

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return the energy at x + step less that at x, as precise as the difference.

        By the work of the force. Raises LinAlgError where a strand would pass through
        another, or the frame would jump.
        """
        before, then = self.frame(x), self.frame(x + step)
        gained = tangent_area(differences(x), differences(then.x)) / (2 * math.pi)
        if abs(before.turns - then.turns - gained) > _PASSED:
            raise LinAlgError("a strand of the loop would pass through another")
        frame, work = before, 0.0
        for place, share in zip(*np.polynomial.legendre.leggauss(8), strict=True):
            frame = self._at_rest(frame.carried(x + 0.5 * (1 + place) * step))
            work += 0.5 * share * float(np.vdot(step, self._force(frame)))
        size = self.gamma * (2 * math.pi) ** 2 + 4 * math.pi * abs(self.natural)
        if abs(self._energy(then) - self._energy(before) - work) > _JUMPED * size:
            raise LinAlgError("the rod's frame would jump")
        return work

    def _at_rest(self, frame: Frame) -> Frame:
        """Return the frame that this one leads down to, but for its last digits."""
        start = np.zeros(len(frame.x))
        return frame.turned(self._lowered(self._pulls(frame), frame.twists, start))

    def rate(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return the derivative of the force (n, 3) by one of the rod's numbers.

        They are "link", "twist_ratio" and "rest_curvature".
        """
        frame = self.frame(x)
        match parameter:
            case "link":
                weld = np.zeros(len(x))
                weld[-1] = 2 * math.pi * self.springs[-1]
                held, turned = self._of_moments(frame, weld)
            case "twist_ratio":
                held, turned = self._of_moments(
                    frame, self.springs * frame.twists / self.ratio
                )
            case "rest_curvature":
                rate = -4 * math.pi / float(self.loop.rest_lengths.sum())
                parts = bend(frame.tangents, frame.lengths, frame.directors)
                held, turned = -backward_differences(rate * parts[3]), rate * parts[2]
            case _:
                return None
        root, mixed = self._root(frame), self._mixed(frame)
        given = solve_triangular(root, turned, lower=True)
        back = solve_triangular(root, given, lower=True, trans=1)
        return held - (back @ mixed).reshape(x.shape)

    def _of_moments(
        self, frame: Frame, moments: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return what moments (n,) at the vertices do to positions (n, 3), and angles."""
        twist = writhe_by_edges(differences(frame.x), moments)
        by_x = 2 * math.pi * backward_differences(twist)
        return by_x, np.roll(moments, 1) - moments

    def with_value(self, parameter: str, value: float) -> CurvedRod:
        """Return the rod with another of its numbers, itself if it has none of that name."""
        names = {"link": "link", "twist_ratio": "ratio", "rest_curvature": "curvature"}
        if parameter not in names:
            return self
        near = tuple(self._known[:1]) or self._near
        return replace(self, **{names[parameter]: value}, _known=[], _near=near)


def _twist_slopes(frame: Frame) -> tuple[FloatArray, FloatArray]:
    """Return how each twist (n, 3) changes with the edge before it, and with that after."""
    t, u = frame.tangents, np.roll(frame.tangents, -1, axis=0)
    lengths = frame.lengths[:, None]
    binormals = np.cross(t, u) / (1 + (t * u).sum(axis=1))[:, None]
    return binormals / lengths, binormals / np.roll(lengths, -1, axis=0)


def _outer(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[:, :, None] * b[:, None, :]


def _away(known: Frame, other: Frame) -> float:
    """Return 1 less the cosine of the largest angle between two loops' tangents."""
    return 1 - float((known.tangents * other.tangents).sum(axis=1).min())
