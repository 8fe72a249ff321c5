"""Loops as trigonometric polynomials, and what their symmetry leaves free."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import pi
from typing import NamedTuple

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.conformal.columns import Columns, Waves, waves
from eulerplateau.exact.conformal.families import HALF_TURNS, TWISTED, Family
from eulerplateau.exact.conformal.grading import Grading, dirichlet_form

# The bending's integrand is no trigonometric polynomial: points per harmonic.
_POINTS = 4
# Share of the harmonics, at the high end, whose size measures the error of truncation.
LAST = 0.1


class Curve(NamedTuple):
    """The loop at the grid's points: positions and derivatives by phi, each (n, 3)."""

    x: FloatArray
    x1: FloatArray
    x2: FloatArray

    def first(self, points: int) -> Curve:
        """Return the loop at the first points alone."""
        return Curve(self.x[:points], self.x1[:points], self.x2[:points])


@dataclass(frozen=True)
class Basis:
    """Trigonometric polynomials of degree `harmonics` in phi with the symmetry `family`.

    x_a(phi) = sum over the coordinate's columns of c_j cos(k_j phi) or c_j sin(k_j phi),
    k >= 1: the centre of the loop is at the origin. A loop is the vector (size,) of all
    c, of x, then y, then z. The grid has 4 points for each harmonic.

    What is integrated along a loop with all half-turns is the same in each quarter of it,
    and so are products of two displacements that keep the same half-turn: then the first
    quarter stands for all of the grid.
    """

    harmonics: int
    family: Family
    crowding: float

    @cached_property
    def grading(self) -> Grading:
        """The conformal angle as a function of phi."""
        return Grading(self.crowding)

    @cached_property
    def phi(self) -> FloatArray:
        """The grid (n,)."""
        n = _POINTS * self.harmonics
        return 2 * pi * np.arange(n) / n

    @cached_property
    def spacing(self) -> FloatArray:
        """How far points of the grid are apart in phi (n,), over the mean."""
        return np.ones(len(self.phi))

    @cached_property
    def theta(self) -> FloatArray:
        """The conformal angle (n,) at the points of the grid."""
        return self.grading.theta(self.phi)

    @cached_property
    def rate(self) -> FloatArray:
        """Its derivative (n,) by the grid's variable, which is phi."""
        return self.grading.rate(self.phi)

    @property
    def weight(self) -> float:
        """Integral weight of every point of the grid."""
        return 2 * pi / len(self.phi)

    @cached_property
    def is_quartered(self) -> bool:
        """Whether a quarter stands for all: displacements all keep the same half-turn."""
        return any(self.family.within(whole) for whole in HALF_TURNS)

    @cached_property
    def keeps_half_turns(self) -> bool:
        """Whether all its displacements keep all half-turns."""
        return self.family.within(TWISTED)

    @cached_property
    def points(self) -> int:
        """How many points of the grid, the first ones, stand for all of it."""
        n = len(self.phi)
        return n // 4 + 1 if self.is_quartered else n

    @cached_property
    def weights(self) -> FloatArray:
        """Their integral weights (points,), which count those they stand for."""
        if not self.is_quartered:
            return np.full(self.points, self.weight)
        weights = np.full(self.points, 4 * self.weight)
        weights[[0, -1]] /= 2  # ends of two quarters
        return weights

    @cached_property
    def columns(self) -> tuple[Columns, ...]:
        """For each coordinate its ("cos" or "sin", k)."""
        return tuple(
            tuple(
                (kind, k)
                for kind, parity in wanted
                for k in range(1, self.harmonics + 1)
                if k % 2 == parity
            )
            for wanted in self.family.harmonics
        )

    @cached_property
    def slices(self) -> tuple[slice, slice, slice]:
        """Where the coefficients of x, y and z are."""
        ends = self.starts.tolist()
        return slice(*ends[:2]), slice(*ends[1:3]), slice(*ends[2:])

    @property
    def size(self) -> int:
        """The number of coefficients."""
        return len(self.wavenumbers)

    @cached_property
    def wavenumbers(self) -> FloatArray:
        """The k of every coefficient (size,)."""
        return np.concatenate([self.waves_in(part) for part in self.columns])

    def waves_in(self, columns: Columns) -> FloatArray:
        """Return the k of columns."""
        return np.array([k for _, k in columns], dtype=np.float64)

    def completed(self, columns: Columns) -> Columns:
        """Return harmonics with what else the basis has of their kinds: nothing."""
        return columns

    @cached_property
    def matrices(self) -> tuple[Waves, ...]:
        """For each coordinate the values of its columns and of their two derivatives."""
        return tuple(self.waves(part) for part in self.columns)

    @cached_property
    def stacked(self) -> FloatArray:
        """Columns and their two derivatives at the first `points`: (3, points, size)."""
        n, parts = self.points, self.matrices
        orders = (np.hstack([part[order][:n] for part in parts]) for order in range(3))
        return np.stack(tuple(orders))

    @cached_property
    def starts(self) -> IntArray:
        """Where the coefficients of x, y and z begin, and their end (4,)."""
        return np.cumsum([0, *map(len, self.columns)])

    @cached_property
    def _signs(self) -> tuple[FloatArray, FloatArray]:
        """By what a loop is multiplied, (3, 1, 3), for phi -> pi - phi, and phi + pi."""
        kinds = [part[0] if part else ("cos", 0) for part in self.family.harmonics]
        turned = np.array([1 - 2 * parity for _, parity in kinds])
        even = np.array([1 if kind == "cos" else -1 for kind, _ in kinds])
        mirrored = np.array([1, -1, 1])[:, None, None] * (turned * even)
        return mirrored, np.broadcast_to(turned, (3, 1, 3))

    @cached_property
    def dirichlet(self) -> FloatArray:
        """Q (size, size), c^T Q c / 2 being the Dirichlet energy of the extension.

        Diagonal: on the cylinder that the disk is to phi, its slit glued phi to -phi, the
        extension of cos k phi has no slope at the slit and that of sin k phi no value.
        """
        even = [kind == "cos" for part in self.columns for kind, _ in part]
        slope = np.tanh(self.wavenumbers * self.grading.height)
        return np.diag(pi * self.wavenumbers * np.where(even, slope, 1 / slope))

    def curve(self, coefficients: FloatArray) -> Curve:
        """Return the loop at the points of the grid."""
        quarter = np.stack(self.part(coefficients))
        if not self.is_quartered:
            return Curve(*quarter)
        mirrored, turned = self._signs
        half = np.concatenate([quarter, mirrored * quarter[:, -2:0:-1]], axis=1)
        return Curve(*np.concatenate([half, turned * half], axis=1))

    def part(self, coefficients: FloatArray) -> Curve:
        """Return the loop at the first `points` of the grid."""
        found = np.empty((3, self.points, 3))
        for axis, part in enumerate(self.slices):
            found[:, :, axis] = self.stacked[:, :, part] @ coefficients[part]
        return Curve(*found)

    def at(self, coefficients: FloatArray, phi: FloatArray) -> Curve:
        """Return the loop at any phi (n,)."""
        parts = [
            [values @ coefficients[part] for values in self.waves_at(columns, phi)]
            for columns, part in zip(self.columns, self.slices, strict=True)
        ]
        x, x1, x2 = (np.stack(order, axis=-1) for order in zip(*parts, strict=True))
        return Curve(x, x1, x2)

    def project(self, x: FloatArray) -> FloatArray:
        """Return the coefficients (size, ...) of values (n, 3, ...), least squares.

        The values are at the points of the grid.
        """
        scale = 2 / len(self.phi)
        columns = zip(self.matrices, range(3), strict=True)
        return np.concatenate([scale * (m[0].T @ x[:, axis]) for m, axis in columns])

    def projector(self, values: FloatArray) -> FloatArray:
        """Return what takes values (n,) to coefficients of columns (n, m): (m, n)."""
        taken: FloatArray = (values / (values**2).sum(axis=0)).T
        return taken

    def transfer(self, other: Basis, coefficients: FloatArray) -> FloatArray:
        """Return the coefficients here of a loop of another basis, theta kept."""
        return self.project(other.at(coefficients, self.phi_of(other)).x)

    def phi_of(self, other: Basis) -> FloatArray:
        """Return another basis's phi (n,) at the points of the grid here."""
        sn, cn, _ = self.grading.functions(self.grading.stretch * (self.phi - pi / 2))
        return other.grading.phi(sn, cn)

    def embed(self, other: Basis, coefficients: FloatArray) -> FloatArray:
        """Return the coefficients here of a loop of the same grid, harmonic by harmonic."""
        found = np.zeros(self.size)
        for axis in range(3):
            there = dict(
                zip(other.columns[axis], coefficients[other.slices[axis]], strict=True)
            )
            here = self.columns[axis]
            found[self.slices[axis]] = [there.get(column, 0.0) for column in here]
        return found

    def tail(self, coefficients: FloatArray) -> float:
        """Return the largest k |c_k| in the last tenth of the harmonics over the largest.

        The relative error that truncation leaves in the loop's tangent, roughly.
        """
        parts = zip(self.columns, self.slices, strict=True)
        sizes = [self.sizes(columns, coefficients[part]) for columns, part in parts]
        high, every = np.max(sizes, axis=0)
        return float(high / every)

    def sizes(self, columns: Columns, coefficients: FloatArray) -> tuple[float, float]:
        """Return the largest k |c_k| in the last tenth of the harmonics, and of all."""
        k = self.waves_in(columns)
        sizes = k * np.abs(coefficients)
        high = sizes[k > (1 - LAST) * self.harmonics]
        return float(high.max(initial=0.0)), float(sizes.max(initial=0.0))

    def waves(self, columns: Columns) -> Waves:
        """Return columns and their two derivatives at the points of the grid."""
        return self.waves_at(columns, self.phi)

    def waves_at(self, columns: Columns, phi: FloatArray) -> Waves:
        """Return columns and their two derivatives by phi at any phi (n,)."""
        return waves(columns, phi)

    def outwards(self, coefficients: FloatArray) -> FloatArray:
        """Return how a loop's film goes on across its edge, dX/dr (n, 3) on the disk."""
        form = dirichlet_form(self.grading, len(self.phi))
        pull: FloatArray = form @ self.curve(coefficients).x
        return pull / (self.weight * self.rate[:, None])

    @cached_property
    def slides(self) -> FloatArray:
        """By how much theta changes in the conformal maps: (3, n), 1, cos and sin."""
        theta = self.theta
        return np.stack([np.ones(len(theta)), np.cos(theta), np.sin(theta)])

    def refinements(self) -> tuple[tuple[int, float], ...]:
        """Return harmonics and how much sharper gradings are: first what costs nothing."""
        more = 8 * round(self.harmonics / 6)
        return (self.harmonics, 3), (self.harmonics, 10), (more, 1), (more, 4)

    def like(self, harmonics: int, family: Family, crowding: float) -> Basis:
        """Return the basis of its kind with other harmonics, symmetry or crowding."""
        return make_basis(harmonics, family, crowding)


@lru_cache(maxsize=24)
def make_basis(harmonics: int, family: Family, crowding: float = 1.0) -> Basis:
    """Return the basis; raises SpecError unless harmonics >= 4 and 0 < crowding <= 1."""
    if harmonics < 4:
        raise SpecError("harmonics", f"found {harmonics}; should be 4 or more")
    if not 0 < crowding <= 1:
        raise SpecError("crowding", f"found {crowding}; should be above 0 and at most 1")
    return Basis(harmonics, family, crowding)
