"""The film as a surface, and its edge's curvatures, from the harmonic extension.

The normals are those of the surface; forces on the rod are not taken from the energy's
gradient, so that their balance along the loop is a test.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal.equilibrium import ConformalFilm

_FEWEST, _MOST = 256, 1 << 16
# The last tenth of the harmonics k |c_k| over the largest, at which a series is complete.
_COMPLETE = 1e-12
_FINER = 16  # refinement of |kappa_n|, which has kinks


@dataclass(frozen=True)
class Surface:
    """The harmonic extension of a loop, as Fourier coefficients (n/2 + 1, 3) in theta."""

    series: np.ndarray

    @property
    def points(self) -> int:
        """How many equidistant theta the edge is sampled at."""
        return 2 * (len(self.series) - 1)

    def at(self, radius: float, points: int) -> FloatArray:
        """Return the surface (points, 3) at equidistant theta on a circle of the disk."""
        k = np.arange(len(self.series))
        scaled = self.series * (radius**k)[:, None]
        if points <= self.points:
            return _values(scaled)[:: self.points // points]
        padded = np.zeros((points // 2 + 1, 3), dtype=complex)
        padded[: len(scaled)] = scaled * points / self.points
        return _values(padded)


def surface(film: ConformalFilm) -> Surface:
    """Return the film's surface, sampled as finely as its crowding asks for."""
    grading, points = film.basis.grading, _FEWEST
    while True:
        theta = 2 * pi * np.arange(points) / points
        phi = grading.phi(np.sin(theta - pi / 2), np.cos(theta - pi / 2))
        series = np.fft.rfft(film.basis.at(film.coefficients, phi).x, axis=0)
        sizes = np.abs(series).max(axis=1) * np.arange(len(series))
        if sizes[-len(sizes) // 10 :].max() < _COMPLETE * sizes.max() or points >= _MOST:
            return Surface(series)
        points *= 2


@dataclass(frozen=True)
class Edge:
    """The loop and the film along it, at the n points of the basis's grid in phi.

    `weights` (n,) integrate over arc length. The frame: tangent t, conormal T into the
    film, normal N with T = N x t, each (n, 3). The curvature vector is dt/ds,
    `speed` is ds/dphi, `conformality` the largest departure from |X_r| = |X_theta| and
    X_r . X_theta = 0, relative.
    """

    x: FloatArray
    tangent: FloatArray
    conormal: FloatArray
    curvature: FloatArray
    speed: FloatArray
    conformality: float

    @property
    def weights(self) -> FloatArray:
        """Arc length per point (n,)."""
        return 2 * pi / len(self.x) * self.speed

    @property
    def normal(self) -> FloatArray:
        """N (n, 3)."""
        return np.cross(self.tangent, self.conormal)

    @cached_property
    def kappa_n(self) -> FloatArray:
        """Normal curvature (n,)."""
        return _dot(self.curvature, self.normal)

    @cached_property
    def kappa_g(self) -> FloatArray:
        """Geodesic curvature (n,), positive where the loop is convex."""
        return _dot(self.curvature, self.conormal)

    @property
    def abs_kappa_n(self) -> float:
        """<|kappa_n|>, the integral of |kappa_n| over arc length (eq. order-parameter)."""
        series = np.fft.rfft(self.kappa_n * self.speed)
        finer = _FINER * len(self.x)
        return 2 * pi / len(self.x) * float(np.abs(np.fft.irfft(series, n=finer)).sum())

    @property
    def total_gauss_curvature(self) -> float:
        """<K> = 2 pi - oint kappa_g ds (Gauss-Bonnet)."""
        return float(2 * pi - self.kappa_g @ self.weights)

    def force_balance(self, load: float, beta: float, moment: float = 0.0) -> float:
        """Return the largest |F' + sigma_hat T| over sigma_hat: 0 in equilibrium.

        F = (beta - 3 kappa^2) t - 2 (kappa n)' + M kappa b is the rod's stress resultant,
        tension positive, M its twisting moment; primes are derivatives by arc length.
        """
        kappa2 = _dot(self.curvature, self.curvature)[:, None]
        bent = _derivative(self.curvature) / self.speed[:, None]
        force = (beta - 3 * kappa2) * self.tangent - 2 * bent
        force += moment * np.cross(self.tangent, self.curvature)
        off = _derivative(force) / self.speed[:, None] + load * self.conormal
        return float(np.linalg.norm(off, axis=1).max() / load)


def edge(film: ConformalFilm) -> Edge:
    """Return the frame and the curvatures of the film's edge."""
    x, x1, x2 = film.curve
    rate, speed = film.basis.rate, np.linalg.norm(x1, axis=1)
    outwards = film.basis.outwards(film.coefficients)
    tangent = x1 / speed[:, None]
    # Conformal: |X_r| = |X_theta| and X_r . X_theta = 0 at r = 1.
    pull = np.linalg.norm(outwards, axis=1)
    stretched = pull * rate / speed - 1
    sheared = _dot(outwards, tangent) * rate / speed
    curvature = (x2 - _dot(x2, tangent)[:, None] * tangent) / speed[:, None] ** 2
    return Edge(
        x=x,
        tangent=tangent,
        conormal=-outwards / pull[:, None],
        curvature=curvature,
        speed=speed,
        conformality=float(np.hypot(stretched, sheared).max()),
    )


def waist(film: ConformalFilm) -> float:
    """Return the distance between the loop's two strands at phi = pi/2 and 3 pi/2, in L.

    For films of PLANAR and TWISTED whose lobes lie along x: there it is the shortest.
    """
    x = film.basis.at(film.coefficients, np.array([0.5 * pi, 1.5 * pi])).x
    return float(np.linalg.norm(x[0] - x[1]))


def _derivative(values: FloatArray) -> FloatArray:
    """Return the derivatives by phi (n, 3) of periodic values (n, 3)."""
    series = np.fft.rfft(values, axis=0)
    k = np.arange(len(series), dtype=np.float64)
    k[-1] = 0.0  # the highest cosine's derivative vanishes at every point
    return _values(1j * k[:, None] * series)


def _values(series: np.ndarray) -> FloatArray:
    values: FloatArray = np.fft.irfft(series, n=2 * (len(series) - 1), axis=0)
    return values


def _dot(a: FloatArray, b: FloatArray) -> FloatArray:
    product: FloatArray = (a * b).sum(axis=1)
    return product
