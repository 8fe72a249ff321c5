"""Half a lobe as a plane curve, from its tip to the middle between two lobes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import NamedTuple, Protocol

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.planar.contact import Touching
from eulerplateau.exact.planar.elastica import Elastica


class Points(NamedTuple):
    """Points of the loop: curvature and tangent angle (...), positions (..., 2)."""

    kappa: FloatArray
    angle: FloatArray
    x: FloatArray


class HalfLobe(Protocol):
    """The loop from s = 0, a tip on the positive x axis, to s = 1/(2n)."""

    def at(self, s: FloatArray) -> Points:
        """Return the points at the arc lengths `s`, 0 <= s <= 1/(2n)."""

    @property
    def ends(self) -> tuple[float, ...]:
        """Arc lengths between which kappa is analytic, from 0 to 1/(2n)."""


@dataclass(frozen=True)
class CircleHalf:
    """The circle of length 1."""

    n: int

    @property
    def ends(self) -> tuple[float, ...]:
        """Arc lengths between which kappa is analytic."""
        return 0.0, 1 / (2 * self.n)

    def at(self, s: FloatArray) -> Points:
        """Return the points at the arc lengths `s`."""
        angle = 2 * pi * s
        x = np.stack([np.cos(angle), np.sin(angle)], -1) / (2 * pi)
        return Points(np.full_like(s, 2 * pi), angle + pi / 2, x)


@dataclass(frozen=True)
class BuckledHalf:
    """A lobe without contact; the centre of its force is the loop's own."""

    n: int
    shape: Elastica

    @property
    def ends(self) -> tuple[float, ...]:
        """Arc lengths between which kappa is analytic."""
        return 0.0, 1 / (2 * self.n)

    def at(self, s: FloatArray) -> Points:
        """Return the points at the arc lengths `s`."""
        angle = self.shape.turning(s) + pi / 2
        return Points(self.shape.curvature(s), angle, self.shape.position(s, angle))


@dataclass(frozen=True)
class TouchingHalf:
    """A lobe closed by contact, a straight line of contact, an arc of the central loop.

    `line` is the length of the line, 0 in point contact.
    """

    n: int
    parts: Touching
    line: float

    @property
    def ends(self) -> tuple[float, ...]:
        """Arc lengths between which kappa is analytic."""
        tip_to_contact = self.parts.lobe_length
        half = 1 / (2 * self.n)
        inner = [] if self.parts.neck is None else [half]
        outer = [0.0, tip_to_contact if inner or self.line else half]
        line = [half - self.parts.neck_length] if self.line else []
        return (*outer, *line, *inner)

    @cached_property
    def _neck_radius(self) -> float:
        """Distance of the contact nearest to the loop's centre from it."""
        neck = self.parts.neck
        if neck is None:
            return 0.0
        # The tangent points to the centre: eq. guven-parametrization with kappa^2 = beta.
        contact = neck.half_period - self.parts.neck_length
        return float(-2 * neck.slope(contact) / neck.sigma)

    def at(self, s: FloatArray) -> Points:
        """Return the points at the arc lengths `s`."""
        points = self._on_lobe(np.minimum(s, self.parts.lobe_length))
        beyond = s - self.parts.lobe_length
        straight = np.clip(beyond, 0.0, self.line)
        points.x[..., 0] -= straight
        if self.line:
            points.kappa[beyond > 0] = 0.0
        neck, inside = self.parts.neck, beyond > self.line
        if neck is not None:
            for whole, part in zip(points, self._on_neck(neck, s[inside]), strict=True):
                whole[inside] = part
        return points

    def _on_lobe(self, s: FloatArray) -> Points:
        lobe, length = self.parts.lobe, self.parts.lobe_length
        angle = lobe.turning(s) + pi / 2
        x = lobe.position(s, angle)
        # The force's centre lies on the axis, where the end of the line fixes it.
        x[..., 0] += self._neck_radius + self.line + 2 * lobe.slope(length) / lobe.sigma
        return Points(lobe.curvature(s), angle, x)

    def _on_neck(self, neck: Elastica, s: FloatArray) -> Points:
        along = s - 1 / (2 * self.n) + neck.half_period
        middle = pi / 2 + pi / self.n
        angle = middle + neck.turning(along) - neck.turning(neck.half_period)
        return Points(neck.curvature(along), angle, neck.position(along, angle))
