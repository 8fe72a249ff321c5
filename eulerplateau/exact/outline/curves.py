"""The curves that are fitted: films of n lobes, and a racket's head; size and place apart.

A curve is its centreline by arc length, in a unit of its own: a film's loop has length 1, a
racket's head the size (EI / sigma)^(1/3) = 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import pi, sqrt
from typing import Protocol, TypeVar

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.planar import PlanarFilm, planar_film, thresholds
from eulerplateau.exact.planar.contact import at_line_contact
from eulerplateau.exact.planar.halves import Points, TouchingHalf

# Of differences in the amplitude: films are exact to 1e-13.
_STEP = 1e-5
# A film of more than this times the load of buckling is one long line.
LARGEST = 60.0


class Curve(Protocol):
    """One curve, by arc length t."""

    def points(self, t: FloatArray) -> Points:
        """Return curvature, tangent angle and positions at the arc lengths t."""


class Curves(Protocol):
    """Curves by the numbers that make their shape, of which there may be none.

    A closed curve is periodic in t, with the period 1; -reach <= t <= reach.
    """

    @property
    def numbers(self) -> int:
        """How many."""

    @property
    def closed(self) -> bool:
        """Whether the curves are."""

    @property
    def reach(self) -> float:
        """How far they go."""

    def settled(self, unknowns: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the same curve by one of several unknowns (p,), and arc lengths on it.

        Unknowns are the shape, the logarithm of the size, the place and the angle.
        """

    def curve(self, shape: FloatArray) -> Curve:
        """Return the curve of a shape (numbers,)."""

    def slopes(self, shape: FloatArray, t: FloatArray) -> FloatArray:
        """Return the derivatives (numbers, n, 2) of the positions at t, t held."""


C = TypeVar("C", bound=Curves)


@dataclass(frozen=True)
class Lobes:
    """Films of n lobes by their amplitude a, sigma_hat = 16 pi^3 (n^2 - 1) (1 + a^2).

    The shape is smooth in a, the circle's a = 0 included, as it is not in the load. Loops
    of negative a are turned by half a lobe; they are the same.
    """

    n: int
    numbers: int = 1
    closed: bool = True
    reach: float = 0.5

    def load(self, amplitude: float) -> float:
        """Return sigma_hat; of no amplitude that at which the disk buckles."""
        return thresholds(self.n).sigma_buckling * (1 + amplitude * amplitude)

    def amplitude(self, load: float) -> float:
        """Return a at a load, 0 for a disk."""
        return sqrt(max(load / thresholds(self.n).sigma_buckling - 1, 0.0))

    def settled(self, unknowns: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the film with its amplitude positive: turned by half a lobe."""
        if unknowns[0] >= 0:
            return unknowns, t
        turned = unknowns + np.eye(5)[-1] * (pi / self.n)
        turned[0] = -unknowns[0]
        return turned, t - 0.5 / self.n

    def curve(self, shape: FloatArray) -> Curve:
        """Return the film's loop."""
        return _Lobed(_film(self.n, self.load(float(shape[0]))), bool(shape[0] < 0))

    def slopes(self, shape: FloatArray, t: FloatArray) -> FloatArray:
        """Return the derivative (1, n, 2) of the positions by the amplitude."""
        step = np.array([_STEP])
        ahead, behind = self.curve(shape + step), self.curve(shape - step)
        return np.asarray((ahead.points(t).x - behind.points(t).x)[None] / (2 * _STEP))


@dataclass(frozen=True)
class _Lobed:
    """The loop of a film, turned by half a lobe or not."""

    film: PlanarFilm
    turned: bool

    def points(self, t: FloatArray) -> Points:
        """Return curvature, tangent angle and positions at the arc lengths t."""
        if not self.turned:
            return self.film.points(t)
        n = self.film.lobes
        found = self.film.points(t - 0.5 / n)
        angle = pi / n
        return Points(found.kappa, found.angle + angle, found.x @ rotation(angle).T)


@lru_cache(maxsize=64)
def _film(n: int, load: float) -> PlanarFilm:
    return planar_film(n, load)


@dataclass(frozen=True)
class Racket:
    """The head of a racket with the two strands behind it, which lie along each other.

    The head's tip is at t = 0 on the positive x axis, and it ends at the origin. It is a
    lobe of a film in line contact (docs/planar.md), of which there is one shape.
    """

    numbers: int = 0
    closed: bool = False
    reach: float = 12.0

    def settled(self, unknowns: FloatArray, t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what is given: it is alone."""
        return unknowns, t

    def curve(self, shape: FloatArray) -> Curve:
        """Return the one curve."""
        return _HEAD

    def slopes(self, shape: FloatArray, t: FloatArray) -> FloatArray:
        """Return no derivatives (0, n, 2)."""
        return np.empty((0, len(t), 2))


class _Head:
    """Half a lobe, its mirror image, and a straight strand behind each."""

    @cached_property
    def _half(self) -> tuple[TouchingHalf, float, float]:
        """The half lobe, its length, and the size (EI / sigma)^(1/3) in its unit."""
        parts = at_line_contact(2)
        # alpha = L = 1: EI = 2.
        return (
            TouchingHalf(2, parts, 0.0),
            parts.lobe_length,
            (2 / parts.lobe.sigma) ** (1 / 3),
        )

    def points(self, t: FloatArray) -> Points:
        """Return curvature, tangent angle and positions at the arc lengths t."""
        half, length, size = self._half
        s = np.abs(t) * size
        side = np.where(t < 0, -1.0, 1.0)
        lobe = half.at(np.minimum(s, length))
        behind = np.maximum(s - length, 0.0)
        kappa = np.where(behind > 0, 0.0, lobe.kappa) * size
        angle = pi / 2 + side * (lobe.angle - pi / 2)
        x = np.stack([lobe.x[..., 0] - behind, side * lobe.x[..., 1]], -1) / size
        return Points(kappa, angle, x)


_HEAD = _Head()


def rotation(angle: float) -> FloatArray:
    """Return the rotation (2, 2) by an angle, of columns."""
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]])
