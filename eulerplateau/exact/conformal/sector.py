"""A loop with n lobes, by the part of it that its symmetry repeats.

The symmetry: n half-turns about axes in the plane, hence a turn by 2 pi / n about z; of two
lobes TWISTED. No rigid motion keeps it and no conformal map of the
disk, so that a loop's shape is all that is free.

Two lobes crowd their ends (grading.py). The grid's angle phi being elliptic, the disk is a
cylinder of height h = pi K' / (2 K), slit at its end and there glued phi to -phi. So the
harmonics stay orthogonal in the Dirichlet energy, whatever the crowding:

    D = sum_k pi k / 2 (tanh(k h) x_k^2 + coth(k h) y_k^2 + coth(k h) z_k^2)

with tanh and coth = (1 -+ q^k) / (1 +- q^k) of the nome q = exp(-2 h), 0 for no crowding;
q < 0 swaps x and y. A shape's energy is the less the better its grid is: q may be sought
with the shape.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import exp, log, pi

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.conformal.basis import Basis
from eulerplateau.exact.conformal.families import LOBED, TWISTED, Family

# Points per harmonic on the whole loop, and the fewest on half a lobe.
_POINTS, _FEWEST_POINTS = 6, 24
# Part of a start's square size that may lack the symmetry asked for.
_ASYMMETRY = 1e-8

Columns = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]


@dataclass(frozen=True)
class Sector:
    """Columns of loops with `lobes` lobes and their slopes on one half of a lobe.

    Two lobes have their x and y apart, cos k phi and sin k phi for odd k; n >= 3 share
    them, x + i y = sum_k c_k exp(i k phi) for k = 1 mod n, negative ones too. z = sum_k c_k
    sin k phi for k = 0 mod n.

    Attributes
    ----------
    wave, part : (m,) float and int
        k of every column, and 0 of x, 1 of y, 2 of z, 3 of x and y together.
    slopes : (n, 2, 3, size) float
        x' and x'' at n points.
    weights : (n,) float
        Of the points, for integrals over the whole loop; the first and the last lie beyond
        the half lobe and count nothing, so that bends at its ends are seen.
    """

    lobes: int
    harmonics: int
    wave: FloatArray
    part: IntArray
    slopes: FloatArray
    weights: FloatArray

    @property
    def size(self) -> int:
        """The number of coefficients."""
        return len(self.wave)

    @cached_property
    def k(self) -> FloatArray:
        """|k| of every column (size,)."""
        return np.abs(self.wave)

    @cached_property
    def columns(self) -> Columns:
        """What the kernels ask for: slopes, weights, k, sign and base of D."""
        sign = np.zeros(self.size)
        if self.lobes == 2:
            sign = np.where(self.part == 0, 1.0, -1.0)
        base = pi * self.k * np.where(self.part == 3, 2.0, 1.0)
        return self.slopes, self.weights, self.k, sign, base

    def stiffness(self, nome: float) -> FloatArray:
        """Return Q (size,), D being sum Q c^2 / 2."""
        _, _, k, sign, base = self.columns
        r = sign * nome**k
        stiffness: FloatArray = base * (1 - r) / (1 + r)
        return stiffness

    @property
    def family(self) -> Family:
        """The family of bases that holds these loops."""
        return LOBED if self.lobes > 2 else TWISTED

    def turned(self, c: FloatArray) -> FloatArray:
        """Return a loop (size,) with two lobes turned by a right angle about z."""
        swapped = np.empty_like(c)
        sine = np.sin(pi / 2 * self.wave)
        x, y, z = (self.part == part for part in range(3))
        swapped[x], swapped[y] = (sine * c)[y], (sine * c)[x]
        swapped[z] = np.cos(pi / 2 * self.wave[z]) * c[z]
        return swapped

    def waist(self, c: FloatArray) -> float:
        """Return the distance of the strands of a loop (size,) with two lobes along x."""
        across = self.part == 1
        return 2 * abs(float(np.sin(pi / 2 * self.wave[across]) @ c[across]))

    def into(self, basis: Basis, c: FloatArray) -> FloatArray:
        """Return a loop's coefficients (basis.size,) in a basis of `family`."""
        if self.lobes == 2:
            return c
        found = np.zeros(basis.size)
        at = [
            {column: start.start + i for i, column in enumerate(columns)}
            for start, columns in zip(basis.slices, basis.columns, strict=True)
        ]
        for wave, part, value in zip(self.wave.tolist(), self.part, c, strict=True):
            k = abs(int(wave))
            if part == 2:
                found[at[2][("sin", k)]] = value
            else:
                found[at[0][("cos", k)]] += value
                found[at[1][("sin", k)]] += np.sign(wave) * value
        return found

    def project(self, x: FloatArray) -> FloatArray:
        """Return the coefficients (size,) of a loop (points, 3), equidistant in phi.

        More than two points for each harmonic; the first is a tip, on the axis x > 0.
        Raises SpecError if the loop has not this symmetry.
        """
        points = len(x)
        top = (points - 1) // 2
        wave, part = _columns(self.lobes, top)
        series = 2 / points * np.fft.rfft(x, axis=0)[: top + 1]
        k = np.abs(wave).astype(int)
        along = np.where(part == 3, 0.5, 1.0) * series.real[k, 0]
        axis = np.where(part == 2, 2, 1)
        across = -np.where(part == 3, 0.5 * np.sign(wave), 1.0) * series.imag[k, axis]
        found = np.where(part == 0, along, np.where(part == 3, along + across, across))
        same = np.zeros_like(series)
        np.add.at(
            same.real,
            (k, np.zeros_like(k)),
            np.where((part == 0) | (part == 3), found, 0.0),
        )
        np.add.at(same.imag, (k, axis), np.where(part == 0, 0.0, -np.sign(wave) * found))
        rest = np.abs(series - same)[1:]
        if (rest**2).sum() > _ASYMMETRY * (np.abs(series[1:]) ** 2).sum():
            raise SpecError(
                "start",
                f"lacks a symmetry; should have {self.lobes} lobes alike, the first "
                "point at the tip on the axis of x",
            )
        kept_columns: FloatArray = found[k <= self.harmonics]
        return kept_columns

    def widen(self, other: Sector, c: FloatArray) -> FloatArray:
        """Return the coefficients here of a loop of a sector with fewer harmonics."""
        found = np.zeros(self.size)
        found[np.abs(self.wave) <= other.harmonics] = c
        return found


def make_sector(harmonics: int, lobes: int) -> Sector:
    """Return the sector; raises SpecError unless harmonics >= 4 and lobes >= 2."""
    if harmonics < 4:
        raise SpecError("harmonics", f"found {harmonics}; should be 4 or more")
    if lobes < 2:
        raise SpecError("lobes", f"found {lobes}; should be 2 or more")
    wave, part = _columns(lobes, harmonics)
    points = max(-(-_POINTS * harmonics // (2 * lobes)), _FEWEST_POINTS)
    phi = (np.arange(-1, points + 1) + 0.5) * pi / (lobes * points)
    angle = phi[:, None] * wave
    cosine, sine = np.cos(angle), np.sin(angle)
    slopes = np.zeros((len(phi), 2, 3, len(wave)))
    along, across, up = (part == 0) | (part == 3), (part == 1) | (part == 3), part == 2
    for axis, (first, on) in enumerate(((-sine, along), (cosine, across), (cosine, up))):
        second = -cosine if axis == 0 else -sine
        slopes[:, 0, axis, on] = (wave * first)[:, on]
        slopes[:, 1, axis, on] = (wave**2 * second)[:, on]
    weights = np.full(len(phi), 2 * pi / points)
    weights[[0, -1]] = 0.0
    return Sector(lobes, harmonics, wave, part, slopes, weights)


def _columns(lobes: int, harmonics: int) -> tuple[FloatArray, IntArray]:
    """Return the wave and the part (m,) of every column; see Sector."""
    k = np.arange(1, harmonics + 1)
    both = np.concatenate([-k[::-1], k])
    if lobes == 2:
        waves, parts = [k[k % 2 == 1], k[k % 2 == 1]], [0, 1]
    else:
        waves, parts = [both[both % lobes == 1]], [3]
    waves, parts = [*waves, k[k % lobes == 0]], [*parts, 2]
    part = np.concatenate(
        [np.full(len(w), number) for w, number in zip(waves, parts, strict=True)]
    )
    return np.concatenate(waves).astype(np.float64), part


def crowding_of(nome: float) -> float:
    """Return the crowding of a grid of this nome, 0 <= nome < 1.

    It is theta_2^2 / theta_3^2 of the complementary nome, or theta_4^2 / theta_3^2.
    """
    terms = range(1, 12)
    if nome < exp(-pi):
        theta_4 = 1 + 2 * sum((-1) ** n * nome ** (n * n) for n in terms)
        return float(theta_4 / (1 + 2 * sum(nome ** (n * n) for n in terms))) ** 2
    other = exp(pi**2 / log(nome))
    theta_2 = 2 * sum(other ** ((n - 0.5) ** 2) for n in terms)
    return float(theta_2 / (1 + 2 * sum(other ** (n * n) for n in terms))) ** 2
