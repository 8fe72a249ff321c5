"""A film kept in its plane as the angles of its loop's edges: one point, and its steps."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Loop, slide_kernels
from eulerplateau.mesh import polygon_gradient
from eulerplateau.solvers.equilibrium import Stability
from eulerplateau.solvers.in_plane import kernels as plane_kernels, turn_kernels

# Weight of the closed chain against its energy, per 1 + load: large enough for the pivots
# to count as the Hessian of closed chains does, and small against 1 / eps.
_WEIGHT = 1e4
# Directions among which the lowest eigenvalue is sought; Krylov's converge in fewer.
_DIRECTIONS = 6


@dataclass(frozen=True)
class Point:
    """The second-order model at one chain.

    Attributes
    ----------
    angles : (n,) of the edges t_v = (cos, sin)
    units, points : (n, 2) t_v and (n + 1, 2) vertices from the origin, the last the gap
    gradient : (n,) of the energy
    sliding : (n,) of the loop's sliding along itself; zero for a circle
    """

    angles: FloatArray
    energy: float
    units: FloatArray
    points: FloatArray
    gradient: FloatArray
    sliding: FloatArray


@dataclass(frozen=True)
class Factors:
    """The factorised Hessian at a point; `negative` of its eigenvalues are not positive."""

    chain: Chain
    point: Point
    gains: FloatArray
    negative: int

    @cached_property
    def held(self) -> tuple[FloatArray, FloatArray]:
        """What forces on the closed and sliding chain do: (3, n) turns, (3, 3) in all."""
        point, s = self.point, self.chain.loop.rest_lengths
        columns, held = np.empty((3, len(s))), np.empty((3, 3))
        plane_kernels.hold(point.units, s, point.sliding, self.gains, columns, held)
        return columns, held


@dataclass(frozen=True)
class Chain:
    """Edges of lengths s_v (n,) that turn against each other, and the film between them."""

    loop: Loop
    load: float

    @property
    def weight(self) -> float:
        """Of the closed chain against the energy."""
        return _WEIGHT * (1.0 + abs(self.load))

    def at(self, angles: FloatArray) -> Point:
        """Return the point at the edges' angles (n,)."""
        s, n = self.loop.rest_lengths, len(angles)
        units, points = np.empty((n, 2)), np.empty((n + 1, 2))
        gradient, row = np.empty(n), np.empty(n)
        value = plane_kernels.energy_gradient(angles, s, self.load, units, points, gradient)
        means = self.loop.mean_lengths
        slide = units + np.concatenate([units[-1:], units[:-1]])
        slide_kernels.keep_lengths(units, means, slide)
        turn_kernels.slide_row(units, points, means, s, slide, row)
        return Point(angles, value, units, points, gradient, row)

    def pull(self, point: Point) -> FloatArray:
        """Return the pull (2,) on the chain's end that balances it best."""
        t, s = point.units, self.loop.rest_lengths
        across = np.stack([-t[:, 1], t[:, 0]])
        weighted = across * s
        balance: FloatArray = np.linalg.inv(weighted @ across.T) @ (across @ point.gradient)
        return -balance

    def factors(self, point: Point, pull: FloatArray, shift: float) -> Factors:
        """Factorise the Hessian plus shift diag(s) of the chain held by a pull (2,)."""
        s, load = self.loop.rest_lengths, self.load
        gains = np.empty((len(s), 5))
        negative = plane_kernels.factorise(
            point.angles,
            point.units,
            point.points,
            s,
            load,
            pull,
            point.sliding,
            shift,
            self.weight,
            gains,
        )
        return Factors(self, point, gains, negative)

    def solve(
        self, factors: Factors, rhs: FloatArray, gap: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the turns (n,) under torques rhs (n,) that close a gap (2,), and the pull.

        The last edge keeps its direction, and nothing slides.
        """
        point, turns, forces = factors.point, rhs.copy(), np.empty(3)
        plane_kernels.solve_held(
            point.units,
            self.loop.rest_lengths,
            point.sliding,
            factors.gains,
            self.weight,
            gap,
            *factors.held,
            turns,
            forces,
        )
        return turns, forces[:2]

    def step(self, factors: Factors) -> tuple[FloatArray, FloatArray]:
        """Return Newton's turns (n,) and the pull (2,) on the chain's end after them."""
        point = factors.point
        return self.solve(factors, -point.gradient, point.points[-1])

    def softest(
        self, factors: Factors, tries: int = _DIRECTIONS
    ) -> tuple[float, FloatArray]:
        """Return the lowest eigenvalue above -shift and its turns (n,), of unit size.

        Of the factorised Hessian, in the norm integral |p|^2 ds; by Rayleigh and Ritz among
        the powers of its inverse.
        """
        point, s = factors.point, self.loop.rest_lengths
        n, closed = len(s), np.zeros(2)
        basis, rows, images = (np.empty((tries, n)) for _ in range(3))
        # Any smooth start that no symmetry keeps apart from the lowest mode.
        arc = np.cumsum(s)
        turns = np.cos(np.outer(np.arange(1.0, 7.0) ** 1.5, 6.0 * arc + 1.0)).sum(axis=0)
        found, row = 0, np.empty(n)
        for k in range(tries):
            before = self._mass(point, turns, row)
            for _ in range(2):
                turns = turns - (rows[:k] @ turns) @ basis[:k]
            size = self._mass(point, turns, row)
            if not size > 1e-20 * before:
                break
            basis[k], rows[k] = turns / np.sqrt(size), row / np.sqrt(size)
            turns = self.solve(factors, rows[k], closed)[0]
            images[k] = turns
            found = k + 1
        inverse = rows[:found] @ images[:found].T
        values, vectors = np.linalg.eigh(0.5 * (inverse + inverse.T))
        return 1.0 / float(values[-1]), vectors[:, -1] @ basis[:found]

    def stability(self, factors: Factors) -> Stability:
        """Return the lowest eigenvalue of a minimum, with what rounding can move it by."""
        s, eps = self.loop.rest_lengths, float(np.finfo(np.float64).eps)
        if len(s) <= 3 + int(factors.point.sliding.any()):
            return Stability(np.empty(0), 0.0)
        stiffest = 32.0 / float(s.min()) ** 4
        return Stability(np.array([self.softest(factors)[0]]), 10 * eps * stiffest)

    def _mass(self, point: Point, turns: FloatArray, row: FloatArray) -> float:
        return turn_kernels.mass_row(
            point.units,
            point.points,
            self.loop.mean_lengths,
            self.loop.rest_lengths,
            turns,
            row,
        )

    def close(self, angles: FloatArray) -> FloatArray | None:
        """Return the closed chain (n,) next to angles (n,); None if it does not close."""
        turned = angles.copy()
        gap = plane_kernels.close(turned, self.loop.rest_lengths, 20)
        return turned if gap < 1e-12 else None

    def angles(self, x: FloatArray) -> FloatArray:
        """Return the angles (n,) of the edges of a polygon (n, 2)."""
        chords = self.loop.chords(x)
        return np.arctan2(chords[:, 1], chords[:, 0])

    def polygon(self, point: Point, like: FloatArray) -> FloatArray:
        """Return the vertices (n, 2), moved and turned to lie on those of `like` best."""
        mass = self.loop.mean_lengths[:, None] / float(self.loop.mean_lengths.sum())
        n = len(like)
        x = point.points[:-1] - np.arange(n)[:, None] / n * point.points[-1]
        x = x - (mass * x).sum(axis=0)
        centre = (mass * like).sum(axis=0)
        y = mass * (like - centre)
        along, across = np.vdot(x, y), np.vdot(x[:, 0], y[:, 1]) - np.vdot(x[:, 1], y[:, 0])
        c, s = np.array([along, across]) / np.hypot(along, across)
        placed: FloatArray = x @ np.array([[c, s], [-s, c]]) + centre
        return placed

    def tensions(self, x: FloatArray) -> FloatArray:
        """Return the edge tensions (n,) that balance the forces at x (n, 2) best."""
        loop = self.loop
        eased = loop.bending_force(x) + self.load * polygon_gradient(x)
        eased /= loop.mean_lengths[:, None]
        units = loop.chords(x) / loop.rest_lengths[:, None]
        balance: FloatArray = (units * loop.chords(eased)).sum(axis=1)
        slide_kernels.solve_lengths(units, loop.mean_lengths, balance)
        return -balance
