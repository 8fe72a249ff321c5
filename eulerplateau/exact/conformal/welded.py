"""Loops whose curvature jumps where a rod is welded, as trigonometric series with tails.

A rod that is curved by nature and was turned before its ends were welded, by no whole
number of turns, wants to be curved another way behind the weld than before it. There its
curvature jumps, at phi = 0. Beyond its harmonics the series goes on as a few powers of k
(tails.py), whose amplitudes are unknowns too: first k^-3, and then, the film being harmonic
and the rod not straight, powers with logarithms, which broken powers stand for. The grid is
dense at the weld:

    phi = v - 4/3 sin v + 1/6 sin 2 v,    dphi/dv = 2/3 (1 - cos v)^2,

v evenly spaced and never 0, so that what is integrated over v is smooth there. Derivatives
of loops at the grid are by v.
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from math import ceil, isinf, pi

import numpy as np
from scipy.special import zeta

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal.basis import LAST, Basis
from eulerplateau.exact.conformal.columns import Columns, Waves, waves
from eulerplateau.exact.conformal.families import Family
from eulerplateau.exact.conformal.tails import tail

POWERS = np.array([3.0, 4.0, 4.5, 5.0, 5.5])
_POINTS = 8
_TAILS = {"cos": "cos tail", "sin": "sin tail"}
# Where hyperbolic tangents are 1 to all digits.
_ONE = 20.0


class WeldedBasis(Basis):
    """Trigonometric polynomials of phi, and tails, that are smooth but for phi = 0."""

    @cached_property
    def grid(self) -> FloatArray:
        """The points (n,) in v, from 0 to pi and from -pi to 0."""
        n = _POINTS * self.harmonics
        places = np.arange(n) + 0.5
        return 2 * pi / n * np.where(places < n / 2, places, places - n)

    @cached_property
    def phi(self) -> FloatArray:
        """The grid (n,) in phi."""
        v = self.grid
        return v - 4 / 3 * np.sin(v) + np.sin(2 * v) / 6

    @cached_property
    def spacing(self) -> FloatArray:
        """The derivative (n,) of phi by v."""
        return 8 / 3 * np.sin(self.grid / 2) ** 4

    @cached_property
    def rate(self) -> FloatArray:
        """The derivative (n,) of the conformal angle by v."""
        return self.grading.rate(self.phi) * self.spacing

    @cached_property
    def columns(self) -> tuple[Columns, ...]:
        """For each coordinate its harmonics, then its tails with their powers."""
        return tuple(self.completed(part) for part in super().columns)

    def completed(self, columns: Columns) -> Columns:
        """Return harmonics with the tails of their kinds behind them."""
        kinds = [kind for kind in _TAILS if any(kind == own for own, _ in columns)]
        return *columns, *((_TAILS[kind], j) for kind in kinds for j in range(len(POWERS)))

    def waves_in(self, columns: Columns) -> FloatArray:
        """Return the k of columns, of tails that at which they begin."""
        numbers = [k if kind in _TAILS else self.harmonics for kind, k in columns]
        return np.array(numbers, dtype=np.float64)

    def waves(self, columns: Columns) -> Waves:
        """Return columns, their derivatives by v, and those by phi twice times dphi/dv^2.

        These are second derivatives by v but for a multiple of the first, on which no
        curvature depends, and which at the weld would drown the rest.
        """
        values, first, second = self.waves_at(columns, self.phi)
        by_v = self.spacing[:, None]
        return values, by_v * first, by_v**2 * second

    def waves_at(self, columns: Columns, phi: FloatArray) -> Waves:
        """Return columns and their two derivatives by phi at phi (n,)."""
        smooth = tuple(column for column in columns if column[0] in _TAILS)
        parts = [[wave] for wave in waves(smooth, phi)]
        for order, part in enumerate(parts):
            tails = self._tails(phi, order)
            for kind, j in columns[len(smooth) :]:
                part.append((tails.real if kind == "cos tail" else tails.imag)[:, j, None])
        values, first, second = (np.hstack(part) for part in parts)
        return values, first, second

    def _tails(self, phi: FloatArray, order: int) -> np.ndarray:
        """Return derivatives by phi (n, m) of the tails, mixed."""
        v = self.harmonics + 1
        sums = [(1j * v) ** order * tail(p - order, v, phi) for p in POWERS]
        mixed: np.ndarray = np.stack(sums, axis=1) @ self._mixing
        return mixed

    @cached_property
    def _mixing(self) -> FloatArray:
        """Mixtures (m, m) of powers, that are as stiff as harmonics and do not overlap."""
        v = self.harmonics + 1
        stiff = self._products(4.0)
        size = np.sqrt(np.diag(stiff))
        lower = np.linalg.cholesky(stiff / np.outer(size, size))
        mixed: FloatArray = v**2 / size[:, None] * np.linalg.inv(lower).T
        return mixed

    def _products(self, order: float) -> FloatArray:
        """Return the sums (m, m) over k > N of k^order times two powers of v / k."""
        v = self.harmonics + 1
        power = POWERS[:, None] + POWERS
        found: FloatArray = v**power * zeta(power - order, v)
        return found

    @cached_property
    def dirichlet(self) -> FloatArray:
        """Q (size, size), c^T Q c / 2 being the Dirichlet energy of the extension."""
        found = np.diag(pi * self.wavenumbers * self._depths)
        for part, columns in zip(self.slices, self.columns, strict=True):
            for kind in _TAILS.values():
                own = part.start + np.flatnonzero([kind == other for other, _ in columns])
                if len(own):
                    found[np.ix_(own, own)] = self._shared(kind)
        return found

    @cached_property
    def _depths(self) -> FloatArray:
        """By what depth slows the harmonics of every coefficient: tanh k h, or coth."""
        even = [kind.startswith("cos") for part in self.columns for kind, _ in part]
        slope = np.tanh(self.wavenumbers * self.grading.height)
        return np.where(even, slope, 1 / slope)

    def _shared(self, kind: str) -> FloatArray:
        """Return pi times the sums (m, m) over k > N of k tanh k h, or coth, of tails."""
        v, h, sums = self.harmonics + 1, self.grading.height, self._products(1.0)
        if not isinf(h):
            k = np.arange(v, v + ceil(_ONE / h))
            slope = np.tanh(k * h)
            off = (slope if kind == "cos tail" else 1 / slope) - 1
            powers = (v / k) ** POWERS[:, None]
            sums = sums + (powers * (k * off)) @ powers.T
        shared: FloatArray = pi * self._mixing.T @ sums @ self._mixing
        return shared

    @cached_property
    def _projectors(self) -> tuple[FloatArray, ...]:
        """What takes values (n,) of each coordinate to coefficients."""
        return tuple(self.projector(values) for values, _, _ in self.matrices)

    def projector(self, values: FloatArray) -> FloatArray:
        """Return what takes values (n,) to coefficients of columns (n, m): (m, n).

        It is that of least squares over phi.
        """
        share = np.sqrt(self.spacing)
        taken = np.linalg.pinv(share[:, None] * values, rcond=1e-12) * share
        return taken.astype(np.float64, copy=False)

    def project(self, x: FloatArray) -> FloatArray:
        """Return the coefficients (size, ...) of values (n, 3, ...), least squares."""
        taken = zip(self._projectors, range(3), strict=True)
        return np.concatenate(
            [np.tensordot(part, x[:, axis], axes=1) for part, axis in taken]
        )

    def sizes(self, columns: Columns, coefficients: FloatArray) -> tuple[float, float]:
        """Return how much k c_k lacks of the tails in the last tenth, and the largest.

        Harmonics before the tails fall as these do, if they are what is beyond.
        """
        k, kinds = self.waves_in(columns), np.array([kind for kind, _ in columns])
        last, largest = 0.0, 0.0
        for kind, beyond in _TAILS.items():
            own = (kinds == kind) & (k > 0)
            if not own.any():
                continue
            amplitudes = self._mixing @ coefficients[kinds == beyond]
            falling = ((self.harmonics + 1) / k[own, None]) ** POWERS @ amplitudes
            high = k[own] > (1 - LAST) * self.harmonics
            lacking = (k[own] * np.abs(coefficients[own] - falling))[high]
            last = max(last, float(lacking.max(initial=0.0)))
            largest = max(largest, float((k * np.abs(coefficients))[own].max(initial=0.0)))
        return last, largest

    def outwards(self, coefficients: FloatArray) -> FloatArray:
        """Return how a loop's film goes on across its edge, dX/dr (n, 3) on the disk.

        Of tails, whose harmonics are deep, the derivative of their conjugates.
        """
        tails = self._tails(self.phi, 1)
        found = np.empty((len(self.phi), 3))
        for axis, (part, columns) in enumerate(zip(self.slices, self.columns, strict=True)):
            slope = self.matrices[axis][0] * (self.wavenumbers * self._depths)[part]
            for place, (kind, j) in enumerate(columns):
                if kind not in _TAILS:
                    slope[:, place] = (
                        tails[:, j].imag if kind[0] == "c" else -tails[:, j].real
                    )
            found[:, axis] = slope @ coefficients[part]
        return found / self.grading.rate(self.phi)[:, None]

    @cached_property
    def slides(self) -> FloatArray:
        """By how much theta changes in the conformal maps that keep the weld: (2, n)."""
        return np.stack([2 * np.sin(self.theta / 2) ** 2, np.sin(self.theta)])

    def refinements(self) -> tuple[tuple[int, float], ...]:
        """Return harmonics and how much sharper gradings are: for the weld first."""
        more = 3 * self.harmonics // 2
        return (more, 1), (more, 4)

    def like(self, harmonics: int, family: Family, crowding: float) -> Basis:
        """Return the basis of its kind with other harmonics, symmetry or crowding."""
        return welded_basis(harmonics, family, crowding)


@lru_cache(maxsize=8)
def welded_basis(harmonics: int, family: Family, crowding: float = 1.0) -> WeldedBasis:
    """Return the basis; its arguments are those of `make_basis`."""
    return WeldedBasis(harmonics, family, crowding)
