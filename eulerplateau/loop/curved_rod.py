"""The energy of a rod that is curved by nature, beside that of its bending.

In units alpha = L = 1, with the frame d1, d2 = t x d1 of the rod along the loop t,

    E = oint (k1 - k0)^2 + k2^2 + (gamma / 2) Omega^2 ds,    k1 = t' . d1,   k2 = t' . d2,

k0 = 2 pi q, gamma = 2 C / B and Omega = d2 . d1'. Of this oint kappa^2 is the bending; the
rest depends on the frame, which takes its least for the loop that is given: a function of
the loop then. There C Omega' = -2 k0 k2, so that twist and moment are not even.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.framed import FramedEnergy
from eulerplateau.loop.frames import Frame
from eulerplateau.loop.loop import Loop
from eulerplateau.loop.term import OwnTerm
from eulerplateau.loop.twist import passes, polygon_writhe, writhe_gained

# Loops whose frames are kept: where a step begins, and where it may end.
_KEPT = 4
# How far tangents may be apart for frames to be carried over.
_NEAR = 0.5
# Of the energy's size: what a frame sets free that snaps, and quadrature does not miss.
_SNAPPED = 1e-6
# Gauss's rule from 0 to 1: places and shares.
_GAUSS = 0.5 * (np.polynomial.legendre.leggauss(5) + np.array([[1.0], [0.0]]))


@dataclass(frozen=True)
class CurvedRod(OwnTerm):
    """A rod's energy beside its bending, on a welded loop x (n, 3), in units of alpha / L.

    The weld is at the first vertex: there the frame turns by what `link` is beyond whole
    turns.

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

    @cached_property
    def framed(self) -> FramedEnergy:
        """The energy of the rod with its frame."""
        length = float(self.loop.rest_lengths.sum())
        springs = 2 * self.ratio / np.roll(self.loop.mean_lengths, -1)
        return FramedEnergy(2 * math.pi * self.curvature / length, springs, length)

    @property
    def is_handed(self) -> bool:
        """Whether a loop and its mirror image differ in energy: if it was turned."""
        return self.link != 0.0

    @property
    def parameters(self) -> Mapping[str, float]:
        """The link, C / B and q."""
        ratios = {"twist_ratio": self.ratio, "rest_curvature": self.curvature}
        return {"link": self.link, **ratios}

    def reaches(self, x: FloatArray, other: FloatArray) -> bool:
        """Return whether the writhe changes by as much as it does locally."""
        gained = polygon_writhe(other) - polygon_writhe(x)
        return not passes(gained, writhe_gained(x, other))

    @property
    def slides(self) -> bool:
        """Whether the loop slides along itself for nothing: not where a weld is seen."""
        return self.link == round(self.link)

    @property
    def _size(self) -> float:
        """About the energy of a ring that was turned."""
        turns = 2 * self.ratio * (2 * math.pi) ** 2 * (abs(self.link) + 1)
        return turns + 4 * math.pi * abs(self.framed.natural)

    @property
    def rounding(self) -> float:
        """What rounding alone leaves of the force, per unit of position."""
        shortest = float(self.loop.rest_lengths.min())
        return float(np.finfo(np.float64).eps) * self._size * 4 / shortest**2

    def frame(self, x: FloatArray) -> Frame:
        """Return the frame at rest on a loop: that to which the one known next leads.

        Far from all known the one with the same twist everywhere leads there, turned as a
        whole to cost least. Raises LinAlgError if there is none.
        """
        for known in self._known:
            if np.array_equal(known.x, x):
                return known
        even = self._even(x)
        starts = (*self._known, *self._near)
        near = min(starts, key=lambda start: _away(start, even), default=None)
        if near is None or _away(near, even) > _NEAR:
            found = self.framed.best_turned(even)
        else:
            found = self.framed.settled(even, even.angles_to(near))
        self._keep(found)
        return found

    def _even(self, x: FloatArray) -> Frame:
        """Return the frame of a loop whose twist is the same everywhere."""
        return Frame.even(x, self.link - polygon_writhe(x))

    def _keep(self, *frames: Frame) -> None:
        """Keep frames in place of those that were known of the same loops."""
        others = [
            known
            for known in self._known
            if not any(np.array_equal(known.x, frame.x) for frame in frames)
        ]
        self._known[:] = [*frames, *others][:_KEPT]

    def moments(self, x: FloatArray) -> FloatArray:
        """Return the twisting moment C Omega (n,) at the vertex after each edge."""
        moments: FloatArray = self.framed.springs * self.frame(x).twists
        return moments

    def twist_energy(self, x: FloatArray) -> float:
        """Return the part of the energy that is twist's."""
        return 0.5 * float(self.moments(x) @ self.frame(x).twists)

    def energy(self, x: FloatArray) -> float:
        """Return the energy, of bending against the natural curvature and of twist.

        At the weld two natural curvatures meet, 2 pi Lk apart, and the vertex there bends
        against their mean, which is less by cos(pi Lk): k0^2 is less by its square.
        """
        lacking = self._at_weld * math.sin(math.pi * self.link) ** 2
        return self.framed.energy(self.frame(x)) - lacking

    @property
    def _at_weld(self) -> float:
        """k0^2 of the first vertex."""
        return self.framed.natural**2 * float(self.loop.mean_lengths[0])

    def moment(self, x: FloatArray) -> float:
        """Return the twisting moment at the weld, where turns go in: dE/dLk = 2 pi M."""
        lacking = 0.5 * self._at_weld * math.sin(2 * math.pi * self.link)
        return float(self.moments(x)[-1]) - lacking

    def columns(self, x: FloatArray) -> Mapping[str, float]:
        """Return what a table says of the rod; the moment is that at the weld."""
        return {
            "twist_energy": self.twist_energy(x),
            "writhe": self.link - self.frame(x).turns,
            "link": self.link,
            "twist_moment": self.moment(x),
            "rest_curvature": self.curvature,
        }

    def fields(self, x: FloatArray) -> Mapping[str, FloatArray]:
        """Return d1, at each vertex that of the edge behind it."""
        return {"director": self.frame(x).directors}

    def pinched(self, x: FloatArray) -> bool:
        """Return whether strands meet: without thickness no twist is held beyond that."""
        return self.loop.strands_meet(x)

    def force(self, x: FloatArray) -> FloatArray:
        """Return the gradient (n, 3)."""
        return self.framed.force(self.frame(x))

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return the second derivative (3 n, 3 n)."""
        return self.framed.hessian(self.frame(x))

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return the energy at x + step less that at x, as precise as the difference.

        It is the work of the force on the way, along which the frame is followed; where
        that snaps, the energy falls by more. Raises LinAlgError where a strand would pass
        through another.
        """
        before = self.frame(x)
        frame, work = before, 0.0
        for place, share in zip(*_GAUSS, strict=True):
            frame = self.framed.at_rest(frame.carried(x + place * step))
            work += share * float(np.vdot(step, self.framed.force(frame)))
        even = self._even(x + step)
        if passes(before.turns - even.turns, writhe_gained(x, even.x)):
            raise LinAlgError("a strand of the loop would pass through another")
        then = self.framed.settled(even, even.angles_to(frame))
        self._keep(then, before)
        difference = self.framed.energy(then) - self.framed.energy(before)
        return difference if abs(difference - work) > _SNAPPED * self._size else work

    def rate(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return the derivative of the force (n, 3) by one of the rod's numbers.

        They are "link", "twist_ratio" and "rest_curvature".
        """
        frame, framed = self.frame(x), self.framed
        match parameter:
            case "link":
                weld = np.zeros(len(x))
                weld[-1] = 2 * math.pi * framed.springs[-1]
                return framed.rate_of_moments(frame, weld)
            case "twist_ratio":
                return framed.rate_of_moments(frame, self.moments(x) / self.ratio)
            case "rest_curvature":
                return framed.rate_of_curvature(frame, 2 * math.pi / framed.length)
        return None

    def on_edges(self, rest_lengths: FloatArray) -> CurvedRod:
        """Return the rod with other edges, so long (n,); of its frames none is known."""
        loop = replace(self.loop, rest_lengths=rest_lengths)
        return replace(self, loop=loop, _known=[], _near=())

    def with_value(self, parameter: str, value: float) -> CurvedRod:
        """Return the rod with another value of a parameter; itself if it has none such."""
        names = {"link": "link", "twist_ratio": "ratio", "rest_curvature": "curvature"}
        if parameter not in names:
            return self
        changed: dict[str, Any] = {names[parameter]: value}
        near = tuple(self._known[:1]) or self._near
        return replace(self, **changed, _known=[], _near=near)


def _away(known: Frame, other: Frame) -> float:
    """Return how far the tangents of two loops are apart, at most."""
    return float(np.abs(known.tangents - other.tangents).max())
