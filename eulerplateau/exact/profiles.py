"""Least squares with bounds, many problems at once, and profiles of the sum of squares.

A model takes parameters (b, p) of b problems and returns their residuals (b, n) and the
derivatives (b, n, p) of these. Parameters are logarithms: steps of order one are long.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray

Model = Callable[[FloatArray], tuple[FloatArray, FloatArray]]

_ITERATIONS, _ROUGH = 300, 20
# Length of a column of J that stands for none at all.
_VANISHED = 1e-150
_LONGEST_STEP = 3.0
# The sum of squares is flat to second order: its minimum on a profile needs no more.
_EXACT, _GOOD = 1e-11, 1e-5
# Keeps the scaled normal matrix, whose diagonal is one, regular.
_RIDGE = 1e-14
# Steps outwards double, from the quadratic estimate up to this; in all at most so many.
_LONGEST_STRIDE, _STRIDES = 2.0, 100
# Starts tried where a profile is looked at from afar.
_CHOSEN = 3
_ROOT_STEPS, _ROOT = 60, 1e-6
# Where the quadratic estimate is this narrow, the profile is quadratic to its square, and
# rounding moves its end by more.
NARROW = 1e-6


@dataclass(frozen=True)
class Box:
    """Bounds (p,) of the parameters; one whose bounds are equal is held."""

    low: FloatArray
    high: FloatArray


@dataclass(frozen=True)
class Minimum:
    """Parameters (p,), the sum of squares there, and the inverse (p, p) of J^T J.

    Directions that the data do not determine, and held parameters, are left out of
    `spread`: it is a pseudo-inverse. `size` (p,) are the lengths of the columns of J.
    """

    theta: FloatArray
    cost: float
    spread: FloatArray
    size: FloatArray


def lowest(model: Model, starts: FloatArray, box: Box) -> Minimum:
    """Return the lowest of the minima reached from `starts` (b, p)."""
    held = np.broadcast_to(box.low == box.high, starts.shape)
    theta, cost = minimise(model, starts, held, box, _GOOD, _ROUGH)
    best = [int(np.argmin(cost))]
    theta, cost = minimise(model, theta[best], held[best], box, _EXACT)
    slopes = model(theta)[1][0]
    free = ~held[0]
    size = np.maximum(np.sqrt((slopes**2).sum(axis=0)), _VANISHED)
    scaled = (slopes / size)[:, free]
    spread = np.zeros((len(free), len(free)))
    spread[np.ix_(free, free)] = np.linalg.pinv(scaled.T @ scaled, 1e-12)
    return Minimum(theta[0], float(cost[0]), spread / np.outer(size, size), size * free)


def minimise(
    model: Model,
    starts: FloatArray,
    held: BoolArray,
    box: Box,
    accuracy: float,
    iterations: int = _ITERATIONS,
) -> tuple[FloatArray, FloatArray]:
    """Return the minima (b, p) of the sums of squares in `box`, and these sums (b,).

    Levenberg and Marquardt's method, all problems in step; `held` (b, p) parameters stay
    where they start, and one at a bound stays there as long as it is pushed outwards.
    """
    theta = starts.copy()
    residual, jacobian = model(theta)
    cost = np.einsum("bn,bn->b", residual, residual)
    damping = np.full(len(theta), 1e-3)
    diagonal = np.arange(theta.shape[1])
    for _ in range(iterations):
        gradient = np.einsum("bnp,bn->bp", jacobian, residual)
        stuck = held | ((theta <= box.low) & (gradient > 0))
        stuck |= (theta >= box.high) & (gradient < 0)
        slopes = np.where(stuck[:, None, :], 0.0, jacobian)
        size = np.maximum(np.sqrt(np.einsum("bnp,bnp->bp", slopes, slopes)), _VANISHED)
        slopes = slopes / size[:, None, :]
        normal = np.swapaxes(slopes, 1, 2) @ slopes
        normal[:, diagonal, diagonal] += damping[:, None] + _RIDGE + stuck
        downhill = np.where(stuck, 0.0, -gradient / size)
        step = np.linalg.solve(normal, downhill[..., None])[..., 0] / size
        step = np.clip(step, -_LONGEST_STEP, _LONGEST_STEP)
        trial = np.where(stuck, theta, np.clip(theta + step, box.low, box.high))
        moved = np.abs(trial - theta).max(axis=1)
        tried, tried_jacobian = model(trial)
        tried_cost = np.einsum("bn,bn->b", tried, tried)
        better = tried_cost <= cost
        theta = np.where(better[:, None], trial, theta)
        residual = np.where(better[:, None], tried, residual)
        jacobian = np.where(better[:, None, None], tried_jacobian, jacobian)
        cost = np.where(better, tried_cost, cost)
        damping = np.where(better, np.maximum(damping / 10, 1e-12), damping * 10)
        if (moved < accuracy).all():
            break
    return theta, cost


@dataclass(frozen=True)
class _Ends:
    """Ends of intervals that are looked for together, each of one parameter on one side.

    A profile has been followed from `anchor` (p,) outwards over the distances `inner` (b,)
    to the parameters `theta` (b, p), where its sum of squares is still below the limit.
    """

    which: list[int]
    sign: FloatArray
    inner: FloatArray
    theta: FloatArray

    def of(self, chosen: BoolArray) -> _Ends:
        """Return some of the ends."""
        which = [j for j, take in zip(self.which, chosen, strict=True) if take]
        return _Ends(which, self.sign[chosen], self.inner[chosen], self.theta[chosen])


@dataclass(frozen=True)
class Profile:
    """Where the sum of squares, lowest for each value of a parameter, crosses a limit.

    `box` bounds the parameters and `edges`, well inside, how far a profile is followed: the
    model is at its limits there. `anchor` (p,) is the minimum, at the edges if it lies
    beyond them, and `lowest` its sum of squares.
    """

    model: Model
    box: Box
    edges: Box
    anchor: FloatArray
    lowest: float

    def ends(
        self, which: list[int], rise: float, spread: FloatArray, far: FloatArray
    ) -> FloatArray:
        """Return the ends (m, 2) of the intervals of the parameters `which`.

        An end is where the profile is `rise` above the minimum, or infinite where it never
        gets there. `spread` (p, p) is that of the minimum. A profile is followed from the
        minimum, and may miss a valley beside its own; so, if one end is open, all edges are
        also looked at from afar, from the parameters `far` (b, p).
        """
        twice = [j for j in which for _ in range(2)]
        sign = np.tile([-1.0, 1.0], len(which))
        theta = np.tile(self.anchor, (len(twice), 1))
        ends = _Ends(twice, sign, np.zeros(len(twice)), theta)
        variance = np.maximum(np.diag(spread)[twice], 1e-300)
        width = np.sqrt(rise * variance)
        slope = np.where(variance[:, None] > 1e-200, spread[twice] / variance[:, None], 0.0)
        slope[np.arange(len(twice)), twice] = 1.0
        distance = np.where(width < NARROW, width, np.inf)
        wide = distance == np.inf
        if wide.any():
            first = np.clip(width[wide], 1e-3, _LONGEST_STRIDE)
            distance[wide] = self._crossings(
                ends.of(wide), np.sqrt(rise), first, (sign[:, None] * slope)[wide]
            )
        if not np.isfinite(distance).all():
            distance[self._open(ends, rise, far)] = np.inf
        found: FloatArray = (self.anchor[twice] + sign * distance).reshape(-1, 2)
        return found

    def _open(self, ends: _Ends, rise: float, far: FloatArray) -> BoolArray:
        """Return whether the rise (b,) at the edge is small, of the best start for each."""
        starts = np.tile(far, (len(ends.which), 1, 1))
        edge = self._edge(ends)
        for j, value, rows in zip(ends.which, edge, starts, strict=True):
            rows[:, j] = value
        residual, _ = self.model(starts.reshape(-1, far.shape[1]))
        cost = np.einsum("bn,bn->b", residual, residual).reshape(len(edge), -1)
        chosen = np.argsort(cost, axis=1)[:, :_CHOSEN, None]
        best = np.take_along_axis(starts, chosen, axis=1)
        rises = [
            self._at(ends, np.abs(edge - self.anchor[ends.which]), best[:, i])[1]
            for i in range(best.shape[1])
        ]
        found: BoolArray = np.min(rises, axis=0) <= np.sqrt(rise)
        return found

    def _edge(self, ends: _Ends) -> FloatArray:
        """Return how far out (b,) the ends' parameters are followed."""
        low, high = self.edges.low[ends.which], self.edges.high[ends.which]
        return np.where(ends.sign < 0, low, high)

    def _crossings(
        self, ends: _Ends, limit: float, stride: FloatArray, slope: FloatArray
    ) -> FloatArray:
        """Return the distances (b,) at which the ends' rises reach `limit`^2, or inf.

        `stride` (b,) is the first step outwards, `slope` (b, p) how the minimum on the
        profile moves with the distance, to begin with.
        """
        found = np.full(len(ends.which), np.inf)
        numbers = np.arange(len(found))
        reach = np.abs(self._edge(ends) - self.anchor[ends.which])
        rise = np.zeros(len(found))
        for _ in range(_STRIDES):
            outer = np.minimum(ends.inner + stride, reach)
            step = (outer - ends.inner)[:, None]
            theta, risen = self._at(ends, outer, ends.theta + slope * step)
            over = risen > limit
            if over.any():
                found[numbers[over]] = self._between(
                    ends.of(over), rise[over], outer[over], theta[over], risen[over], limit
                )
            on = ~over & (outer < reach)
            if not on.any():
                break
            slope = ((theta - ends.theta) / np.maximum(step, 1e-12))[on]
            ends, reach = replace(ends, inner=outer, theta=theta).of(on), reach[on]
            numbers, rise = numbers[on], risen[on]
            stride = np.minimum(np.maximum(2 * stride[on], 1e-3), _LONGEST_STRIDE)
        return found

    def _between(
        self,
        ends: _Ends,
        rise: FloatArray,
        outer: FloatArray,
        theta: FloatArray,
        risen: FloatArray,
        limit: float,
    ) -> FloatArray:
        """Return where the rises reach `limit`: below it at `ends`, above it at `outer`.

        By regula falsi with the Illinois rule: the root of the rise is nearly linear.
        """
        inner, below = ends.inner.copy(), ends.theta
        low, high = rise - limit, risen - limit
        side = np.zeros(len(outer))
        for _ in range(_ROOT_STEPS):
            part = low / (low - high)
            middle = inner + part * (outer - inner)
            start = below + part[:, None] * (theta - below)
            at, value = self._at(ends, middle, start)
            value = value - limit
            up = value > 0
            low = np.where(up & (side > 0), low / 2, low)
            high = np.where(~up & (side < 0), high / 2, high)
            side = np.where(up, 1.0, -1.0)
            outer, high = np.where(up, middle, outer), np.where(up, value, high)
            inner, low = np.where(up, inner, middle), np.where(up, low, value)
            theta = np.where(up[:, None], at, theta)
            below = np.where(up[:, None], below, at)
            near = np.abs(value) <= _ROOT * limit
            if (near | (outer - inner <= _ROOT * outer)).all():
                break
        return middle

    def _at(
        self, ends: _Ends, distance: FloatArray, start: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Return the minima (b, p) at `distance`, and the roots (b,) of their rises."""
        start = np.clip(start, self.box.low, self.box.high)
        held = np.tile(self.box.low == self.box.high, (len(start), 1))
        rows = np.arange(len(start))
        start[rows, ends.which] = self.anchor[ends.which] + ends.sign * distance
        held[rows, ends.which] = True
        theta, cost = minimise(self.model, start, held, self.box, _GOOD)
        return theta, np.sqrt(np.maximum(cost - self.lowest, 0.0))
