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
    gauge_fields,
    independent,
    kept_fields,
)
from eulerplateau.solvers import Stability


@dataclass(frozen=True)
class CurvedFamily(SmoothFamily):
    """The same, with "rest_curvature" among the values; the link is not varied."""

    @cached_property
    def frames(self) -> Frames:
        """What stands for the frame."""
        return Frames(self.basis, self.values["link"])

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

    def framed(self, other: SmoothFamily, x: FloatArray) -> FloatArray:
        """Return a film of a family without frames with one that is twisted evenly."""
        there = other.unknowns.loop(x).coefficients
        coefficients = self.basis.transfer(other.basis, there)
        frame = self.frames.even(self.basis.curve(coefficients))
        return self.unknowns.x(coefficients, frame)

    def transferred(self, other: SmoothFamily, x: FloatArray) -> FloatArray:
        """Return what stands here for a film of another family, theta kept."""
        coefficients = other.unknowns.loop(x).coefficients
        frame = self.frames.transfer(Frames(other.basis), other.unknowns.others(x))
        return self.unknowns.x(self.basis.transfer(other.basis, coefficients), frame)

    def _free_motions(self, x: FloatArray) -> FloatArray:
        """Return what costs nothing: turning with its frame, and sliding along itself."""
        u, basis, frames = self.unknowns, self.basis, self.frames
        if basis.keeps_half_turns:
            return np.zeros((len(u.scales), 0))
        curve = u.loop(x).curve
        fields = gauge_fields(basis, curve)
        inside = basis.project(fields)
        _, turning = frames.angle(u.others(x))
        turned = [frames.turned(curve, axis) for axis in np.eye(3)]
        slid = basis.slides / basis.rate * turning
        motions = np.vstack([inside, frames.project(np.vstack([turned, slid]).T)])
        kept = kept_fields(basis, fields, inside)
        return independent(motions[:, kept] / u.scales[:, None])
