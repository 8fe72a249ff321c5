"""Where the two strands that pass a loop's waist are nearest, and how far apart.

Their distance is the least over both arc lengths. Where these are eliminated it depends on
the loop alone: its first derivative is that at given points, and its second has what the
points yield by sliding along their strands. Films of PLANAR and TWISTED have their lobes
along x; the points are then phi = pi/2 and 3 pi/2, and others near by in displaced loops.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import degrees, pi

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal.basis import Basis, Curve
from eulerplateau.exact.conformal.columns import waves

_CORRECTIONS, _SETTLED = 20, 1e-14
# Strands of a tube of this radius of curvature or more, in diameters, turn in so many.
_APART = pi / 2


@dataclass(frozen=True)
class Crossing:
    """The nearest points of both strands.

    Attributes
    ----------
    columns : (2, 3, 3, size) float
        At each point the basis's columns and their two derivatives by phi, by coordinate.
    strands : (2, 3, 3) float
        At each point position, x' and x''.
    """

    columns: FloatArray
    strands: FloatArray

    @cached_property
    def distance(self) -> float:
        """How far they are apart, in L."""
        return float(np.linalg.norm(self.strands[0, 0] - self.strands[1, 0]))

    @cached_property
    def normal(self) -> FloatArray:
        """The unit vector (3,) from the second to the first."""
        across: FloatArray = (self.strands[0, 0] - self.strands[1, 0]) / self.distance
        return across

    @property
    def speeds(self) -> FloatArray:
        """Arc length per phi (2,)."""
        speeds: FloatArray = np.linalg.norm(self.strands[:, 1], axis=1)
        return speeds

    @property
    def angle(self) -> float:
        """The acute angle between the tangents, in degrees."""
        first, second = self.strands[:, 1] / self.speeds[:, None]
        sine = np.linalg.norm(np.cross(first, second))
        return degrees(np.arctan2(sine, abs(first @ second)))

    @cached_property
    def form(self) -> FloatArray:
        """The second derivative (2, 2) of the distance by both phi."""
        first, second = self.strands
        mixed = -first[1] @ second[1] / self.distance
        return np.array(
            [
                [first[1] @ first[1] / self.distance + self.normal @ first[2], mixed],
                [mixed, second[1] @ second[1] / self.distance - self.normal @ second[2]],
            ]
        )

    @property
    def slope(self) -> FloatArray:
        """The derivative (size,) of the distance by the loop's coefficients."""
        slope: FloatArray = self.normal @ (self.columns[0, 0] - self.columns[1, 0])
        return slope

    @property
    def curvature(self) -> FloatArray:
        """Its second derivative (size, size), the points sliding along."""
        apart = self.columns[0, 0] - self.columns[1, 0]
        turned = self.strands[:, 1] @ apart / self.distance
        slid = turned + self.normal @ self.columns[:, 1]
        slid[1] *= -1
        swung = (apart.T @ apart - np.outer(self.slope, self.slope)) / self.distance
        curvature: FloatArray = swung - slid.T @ np.linalg.solve(self.form, slid)
        return curvature


def crossing(basis: Basis, coefficients: FloatArray) -> Crossing:
    """Return where a loop's strands are nearest, by Newton's method from the waist."""
    phi = np.array([pi / 2, 3 * pi / 2])
    for _ in range(_CORRECTIONS):
        found = _at(basis, coefficients, phi)
        pull = found.strands[:, 1] @ found.normal * [1, -1]
        shift = np.linalg.solve(found.form, pull)
        if np.abs(shift).max() < _SETTLED:
            break
        phi = phi - shift
    return found


def nearest_strands(curve: Curve, diameter: float) -> float:
    """Return the least distance of points of a loop that a tube keeps apart, in L.

    curve : at points that lie close where strands are near, the nearest ones among them.
    Neighbours, up to half a turn of a tube about its own edge apart, do not count.
    """
    pieces = np.linalg.norm(curve.x1, axis=1) * 2 * pi / len(curve.x)
    along = np.concatenate([[0.0], np.cumsum((pieces + np.roll(pieces, -1))[:-1] / 2)])
    separate = np.abs(along[:, None] - along)
    separate = np.minimum(separate, pieces.sum() - separate)
    apart = np.linalg.norm(curve.x[:, None] - curve.x, axis=2)
    return float(apart[separate >= _APART * diameter].min())


def _at(basis: Basis, coefficients: FloatArray, phi: FloatArray) -> Crossing:
    columns = np.zeros((2, 3, 3, basis.size))
    for axis, part in enumerate(basis.slices):
        for order, values in enumerate(waves(basis.columns[axis], phi)):
            columns[:, order, axis, part] = values
    return Crossing(columns, columns @ coefficients)
