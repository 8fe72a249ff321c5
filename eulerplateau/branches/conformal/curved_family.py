"""Soap films without a mesh whose rod is curved by nature: its frame is an unknown too."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.conformal.family import SmoothFamily
from eulerplateau.branches.conformal.frames import Frames
from eulerplateau.branches.conformal.rod_term import SmoothRod
from eulerplateau.branches.conformal.terms import Unknowns
from eulerplateau.branches.point import BranchPoint
from eulerplateau.exact.conformal import (
    Curve,
    gauge_fields,
    gauge_modes,
    slides,
)
from eulerplateau.solvers import Stability


@dataclass(frozen=True)
class CurvedFamily(SmoothFamily):
    """The same, with "rest_curvature" among the values; the link is 0."""

    @cached_property
    def frames(self) -> Frames:
        """What stands for the frame."""
        return Frames(self.basis)

    @cached_property
    def unknowns(self) -> Unknowns:
        """What stands for a loop and its frame."""
        return Unknowns.of(self.basis, self.frames.wavenumbers)

    def twist(self, value: float) -> SmoothRod:
        """Return what the rod's energy has beside its bending at a value."""
        values = self._values(value)
        ratio, curvature = values["twist_ratio"], values["rest_curvature"]
        return SmoothRod(self.unknowns, self.frames, ratio, curvature)

    def tail(self, x: FloatArray) -> float:
        """Return the relative error of truncation, roughly: the loop's, or the frame's."""
        return max(super().tail(x), self.frames.tail(self.unknowns.others(x)))

    def in_space(self, point: BranchPoint) -> Stability:
        """Return the spectrum among all loops and frames."""
        return self.at_once(point)

    def carried(self, other: SmoothFamily, x: FloatArray) -> FloatArray:
        """Return what stands here for a film of another family, of the same grid."""
        coefficients = other.unknowns.loop(x).coefficients
        angles = other.unknowns.others(x)
        frame = self.frames.embed(Frames(other.basis), angles)
        return self.unknowns.x(self.basis.embed(other.basis, coefficients), frame)

    def framed(self, x: FloatArray) -> FloatArray:
        """Return a loop x (size, 1) without a frame with one that is twisted evenly."""
        coefficients = self.unknowns.scale * x[:, 0]
        frame = self.frames.even(self.basis.curve(coefficients))
        return self.unknowns.x(coefficients, frame)

    def transferred(self, other: SmoothFamily, x: FloatArray) -> FloatArray:
        """Return what stands here for a film of another family, theta kept."""
        coefficients = other.unknowns.loop(x).coefficients
        frame = self.frames.transfer(Frames(other.basis), other.unknowns.others(x))
        return self.unknowns.x(self.basis.transfer(other.basis, coefficients), frame)

    def _free_motions(self, x: FloatArray) -> FloatArray:
        u, curve = self.unknowns, self.unknowns.loop(x).curve
        loops = gauge_modes(u.basis, curve)
        frame = self.frames.project(self._turning(curve, x, loops))
        return np.vstack([loops, frame]) / u.scales[:, None]

    def _turning(self, curve: Curve, x: FloatArray, loops: FloatArray) -> FloatArray:
        """Return how psi (n, m) changes in motions of the loop (size, m) that cost nothing.

        Each turns the loop by omega and lets it slide by a x': both are found from the
        displacement, which is a sum of these.
        """
        basis = self.basis
        fields = gauge_fields(basis, curve)
        inside = (fields - fields.mean(axis=0)).reshape(-1, fields.shape[2])
        moved = np.array([basis.curve(c).x.ravel() for c in loops.T])
        moved = moved.reshape(loops.shape[1], len(inside)).T
        share = np.linalg.lstsq(inside, moved, rcond=1e-9)[0]
        turned = np.column_stack([self.frames.turned(curve, e) for e in np.eye(3)])
        _, turning = self.frames.angle(self.unknowns.others(x))
        slid = (slides(basis) / basis.rate * turning).T
        changed: FloatArray = np.column_stack([turned, slid]) @ share
        return changed
