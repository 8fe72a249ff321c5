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
from eulerplateau.exact.conformal import Curve, gauge_modes


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
        frame = np.column_stack(
            [self._frame_motion(curve, x, moved) for moved in loops.T]
            or [np.zeros((len(u.frame_scale), 0))]
        )
        return np.vstack([loops, frame]) / u.scales[:, None]

    def _frame_motion(self, curve: Curve, x: FloatArray, moved: FloatArray) -> FloatArray:
        """Return how the frame's coefficients (m,) change in a motion of the loop.

        A motion that costs nothing turns the loop by omega and lets it slide by a x': it
        is found from the displacement, of which it is the only part along these.
        """
        basis, field = self.basis, self.basis.curve(moved).x
        theta, rate = basis.theta, basis.rate
        slide = curve.x1 / rate[:, None]
        factors = np.stack([np.ones(len(theta)), np.cos(theta), np.sin(theta)])
        known = [np.cross(axis, curve.x) for axis in np.eye(3)]
        known += [factor[:, None] * slide for factor in factors]
        columns = np.stack([(k - k.mean(axis=0)).ravel() for k in known], axis=1)
        share = np.linalg.lstsq(columns, field.ravel(), rcond=1e-9)[0]
        changed = self.frames.turned(curve, share[:3])
        _, turning = self.frames.angle(self.unknowns.others(x))
        changed = changed + (share[3:] @ factors) / rate * turning
        return self.frames.project(changed)
