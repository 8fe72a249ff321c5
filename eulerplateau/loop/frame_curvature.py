"""How far a loop bends the way its frame points: the integral of k1 = t' . d1.

At the vertex between two edges with tangents t, u and directors d, g the loop turns by the
angle theta, and it does so towards d, and towards g, by theta / sin(theta) times u . d, and
-t . g. Half of the sum of both is what the vertex adds:

    k1 <s> = f(t . u) (u . d - t . g) / 2,     f(cos theta) = theta / sin(theta).

That is theta times the mean cosine of the angles between directors and the plane of the
turn: of second order, the same when the loop is run through backwards, and in a plane,
the directors being its normals, just the angle: in sum 2 pi, whatever the loop. So a
natural curvature does nothing to polygons in a plane either.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.frames import Frame

# theta / sin(theta) is a power series in (1 - cos theta) / 2: sums for angles up to 60
# degrees are right to rounding, beyond that there is a formula.
_SERIES = np.cumprod([1.0, *(k / (k + 0.5) for k in range(1, 30))])
_SMALL = 0.25


@dataclass(frozen=True)
class FrameCurvature:
    """K = sum_v k1_v <s_v> of a frame, and its derivatives.

    By the edges e_i of the loop, the frame carried along without turning about them; and by
    the angles psi_i by which it is turned.
    """

    frame: Frame

    @cached_property
    def value(self) -> float:
        """K."""
        return 0.5 * float((self._turning[0] * self._seen).sum())

    @cached_property
    def pulls(self) -> tuple[FloatArray, FloatArray]:
        """What multiplies cos psi_i and sin psi_i (n,) in K, of a frame that is turned."""
        t, f = self.frame.tangents, self._turning[0][:, None]
        whole = 0.5 * (f * _after(t) - _before(f * t))
        cosines = (whole * self.frame.directors).sum(axis=1)
        return cosines, (whole * self.frame.second).sum(axis=1)

    def by_edges(self) -> FloatArray:
        """Return dK/de (n, 3)."""
        slope = self._by_tangents
        t = self.frame.tangents
        along = (slope * t).sum(axis=1)[:, None]
        across: FloatArray = (slope - along * t) / self._lengths[:, None]
        return across

    def by_edges_twice(self) -> tuple[FloatArray, FloatArray]:
        """Return d2K/de2: (n, 3, 3) of each edge with itself, and with the next."""
        own, beside = self._by_tangents_twice
        t, slope, s = self.frame.tangents, self._by_tangents, self._lengths
        across = np.eye(3) - _outer(t, t)
        along = (slope * t).sum(axis=1)[:, None, None]
        rest = _outer(t, self.by_edges()) * s[:, None, None]
        own = across @ own @ across - along * across - rest - rest.transpose(0, 2, 1)
        beside = across @ beside @ _after(across)
        return own / (s**2)[:, None, None], beside / (s * _after(s))[:, None, None]

    def by_angles_and_edges(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return d2K/dpsi_i de (n, 3), by the edge before, the edge i, and that after it."""
        f, slope, _ = (0.5 * part[:, None] for part in self._turning)
        t, u = self.frame.tangents, _after(self.frame.tangents)
        d, g = self.frame.second, _after(self.frame.second)
        c = (t * u).sum(axis=1)[:, None]
        seen, back = (u * d).sum(axis=1)[:, None], (t * g).sum(axis=1)[:, None]
        # Of the vertex after edge i, by it and by the next; of that before it likewise.
        here, after = slope * seen * u - f * c * d, slope * seen * t + f * d
        before, own = -slope * back * u - f * g, -slope * back * t + f * c * g
        parts = _before(before), here + _before(own), after
        across = _before(t), t, u
        lengths = _before(self._lengths), self._lengths, _after(self._lengths)
        return tuple(
            (part - (part * v).sum(axis=1)[:, None] * v) / s[:, None]
            for part, v, s in zip(parts, across, lengths, strict=True)
        )  # type: ignore[return-value]

    @cached_property
    def _lengths(self) -> FloatArray:
        """The length (n,) of each edge."""
        found: FloatArray = np.linalg.norm(_after(self.frame.x) - self.frame.x, axis=1)
        return found

    @cached_property
    def _turning(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The function f (n,) of t . u at each vertex, and its first two derivatives."""
        t = self.frame.tangents
        return turning(0.25 * ((_after(t) - t) ** 2).sum(axis=1))

    @cached_property
    def _seen(self) -> FloatArray:
        """The sum u . d - t . g (n,) at each vertex."""
        t, d = self.frame.tangents, self.frame.directors
        seen: FloatArray = (_after(t) * d - t * _after(d)).sum(axis=1)
        return seen

    @cached_property
    def _vertex_slopes(self) -> tuple[FloatArray, FloatArray]:
        """Derivatives (n, 3) of u . d - t . g by t and by u, frames carried along."""
        t, d = self.frame.tangents, self.frame.directors
        c = (t * _after(t)).sum(axis=1)[:, None]
        return -c * d - _after(d), d + c * _after(d)

    @cached_property
    def _by_tangents(self) -> FloatArray:
        """Derivative (n, 3) of K by the tangents, as if these were free vectors."""
        f, slope, _ = (0.5 * part[:, None] for part in self._turning)
        t, seen = self.frame.tangents, self._seen[:, None]
        by_t, by_u = self._vertex_slopes
        found: FloatArray = slope * seen * _after(t) + f * by_t
        found += _before(slope * seen * t + f * by_u)
        return found

    @cached_property
    def _by_tangents_twice(self) -> tuple[FloatArray, FloatArray]:
        """The same twice (n, 3, 3): own, and with the next; right across the tangents."""
        f, slope, bent = (0.5 * part[:, None, None] for part in self._turning)
        seen = self._seen[:, None, None]
        t, d = self.frame.tangents, self.frame.directors
        u, g = _after(t), _after(d)
        by_t, by_u = self._vertex_slopes
        here = bent * seen * _outer(u, u) + slope * _both(u, by_t) - 0.5 * f * _both(d, u)
        then = bent * seen * _outer(t, t) + slope * _both(t, by_u) + 0.5 * f * _both(g, t)
        beside = bent * seen * _outer(u, t) + f * (_outer(u, g) - _outer(d, t))
        beside += slope * (seen * np.eye(3) + _outer(u, by_u) + _outer(by_t, t))
        return here + _before(then), beside


def turning(half: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return theta / sin(theta) and its derivatives by cos(theta), first and second.

    half : float, (1 - cos theta) / 2
    """
    z = np.minimum(half, _SMALL)
    series = np.polynomial.Polynomial(_SERIES)
    f, slope, bent = series(z), -0.5 * series.deriv()(z), 0.25 * series.deriv(2)(z)
    wide = half > _SMALL
    if wide.any():
        c = 1 - 2 * half[wide]
        square = 1 - c * c
        f[wide] = np.arccos(c) / np.sqrt(square)
        slope[wide] = (c * f[wide] - 1) / square
        bent[wide] = (f[wide] + 3 * c * slope[wide]) / square
    return f, slope, bent


def _after(rows: FloatArray) -> FloatArray:
    return np.roll(rows, -1, axis=0)


def _before(rows: FloatArray) -> FloatArray:
    return np.roll(rows, 1, axis=0)


def _outer(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[:, :, None] * b[:, None, :]


def _both(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return a b^T + b a^T (n, 3, 3) of rows (n, 3)."""
    product = _outer(a, b)
    return product + product.transpose(0, 2, 1)
