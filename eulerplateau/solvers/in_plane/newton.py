"""Minima and saddles of a film kept in its plane, in time O(n_b) a step.

All that moves is a chain of edges, and what is unknown are their angles. A step of Newton's
method costs O(n_b) (kernels.py), and so does knowing how many eigenvalues of the second
variation are negative. Where there are any, the Hessian is shifted until there are none, so
that descent leaves saddles. A fine loop is started from the minimum of a coarse one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.interruption import heed
from eulerplateau.loop import Loop
from eulerplateau.solvers.equilibrium import Stability
from eulerplateau.solvers.in_plane.chain import Chain, Factors, Point

# Loop vertices of the coarse loop.
COARSE = 64
_LIMIT = 20
# Turns (radians): farther in one step is not tried; those of converged steps.
_FARTHEST = 0.7
_SETTLED = 1e-13
_ROUNDING = 1e-7
# A fine polygon settles this close to the coarse one it was started from (in L).
_NEAR = 0.05
# Part of the promised gain that a step has to bring, and how often it is halved.
_GAIN = 0.05
_HALVINGS = 40
# A larger shift is not tried: something is not finite.
_STIFFEST = 1e200
# Saddles that are left, each along its softest mode.
_SADDLES = 10
_ASIDE = 0.05


@dataclass(frozen=True)
class PlaneEquilibrium:
    """A polygon (n_b, 2) in equilibrium, its edge tensions (n_b,), and the steps taken."""

    x: FloatArray
    tensions: FloatArray
    iterations: int


@dataclass(frozen=True)
class _ChainEquilibrium:
    """A chain at rest, the factorised Hessian next to it, and the steps taken."""

    point: Point
    factors: Factors
    iterations: int


def settle_in_plane(
    loop: Loop, load: float, x: FloatArray, limit: int
) -> PlaneEquilibrium | None:
    """Return the equilibrium next to x (n_b, 2), stable or not; None if none is reached."""
    chain = Chain(loop, load)
    found = _settle(chain, chain.angles(x), limit)
    return None if found is None else _as_polygon(chain, found, x)


def minimum_in_plane(
    loop: Loop,
    load: float,
    x: FloatArray,
    limit: int,
    observe: Callable[[FloatArray], None],
) -> tuple[PlaneEquilibrium, Stability] | None:
    """Return the minimum that descent from x (n_b, 2) leads to; None if it gets stuck."""
    chain, spent, found = Chain(loop, load), 0, None
    if len(x) > 2 * COARSE:
        coarse = _find_coarse_minimum(chain, x, limit)
        if coarse is not None:
            angles, spent = coarse
            found = _settle(chain, angles, limit - spent)
            if found is not None and not _is_near(chain, found, angles):
                found = None
    if found is None:
        angles = chain.angles(x)
        found = _find_minimum(
            chain, angles, limit, lambda at: observe(at.points[:-1] + x[0])
        )
    if found is None:
        return None
    found = replace(found, iterations=found.iterations + spent)
    flat = _as_polygon(chain, found, x)
    observe(flat.x)
    return flat, chain.stability(found.factors)


def _is_near(chain: Chain, found: _ChainEquilibrium, angles: FloatArray) -> bool:
    """Whether a chain that has settled is a minimum, and the one it was started at."""
    start = chain.at(angles)
    moved = chain.polygon(found.point, start.points[:-1]) - start.points[:-1]
    moved -= moved.mean(axis=0)
    return found.factors.negative == 0 and float(np.abs(moved).max()) < _NEAR


def _as_polygon(
    chain: Chain, found: _ChainEquilibrium, like: FloatArray
) -> PlaneEquilibrium:
    x = chain.polygon(found.point, like)
    return PlaneEquilibrium(x, chain.tensions(x), found.iterations)


def _find_coarse_minimum(
    chain: Chain, x: FloatArray, limit: int
) -> tuple[FloatArray, int] | None:
    """Return a coarse loop's minimum as angles of the fine one, and the steps taken."""
    n, s = len(x), chain.loop.rest_lengths
    arc = np.concatenate([[0.0], np.cumsum(s)])
    kept = np.linspace(0, n, COARSE + 1).astype(np.int64)
    loop = Loop(np.diff(arc[kept]))
    coarse = Chain(loop, chain.load)
    found = _find_minimum(coarse, coarse.angles(x[kept[:-1]]), limit, lambda at: None)
    if found is None:
        return None
    # Tangents are nearest to their curve's in the middle of an edge.
    middle = 0.5 * (arc[kept[:-1]] + arc[kept[1:]])
    angles = np.unwrap(found.point.angles)
    turned = angles[0] + 2 * np.pi * np.round((angles[-1] - angles[0]) / (2 * np.pi))
    total = turned - angles[0]
    places = np.concatenate([middle[-1:] - arc[-1], middle, middle[:1] + arc[-1]])
    values = np.concatenate([angles[-1:] - total, angles, angles[:1] + total])
    smooth = chain.close(np.interp(arc[:-1] + 0.5 * s, places, values))
    return None if smooth is None else (smooth, found.iterations)


def _settle(chain: Chain, angles: FloatArray, limit: int) -> _ChainEquilibrium | None:
    """Return where Newton's method comes to rest, whatever the Hessian's index."""
    point, last = chain.at(angles), np.inf
    pull = chain.pull(point)
    for iteration in range(1, min(limit, _LIMIT) + 1):
        heed()
        factors = chain.factors(point, pull, 0.0)
        turns, pull = chain.step(factors)
        size = float(np.abs(turns).max())
        if not size < 4 * np.pi:
            return None
        point = chain.at(point.angles + turns)
        if _is_last_step(size, last):
            return _ChainEquilibrium(point, chain.factors(point, pull, 0.0), iteration)
        last = size
    return None


def _is_last_step(size: float, last: float) -> bool:
    """Whether what follows a step of this size, and one before, is lost in rounding."""
    ratio = size / last if 0 < size < last < np.inf else 1.0
    return size * ratio < _SETTLED or (size < _ROUNDING and size > 0.25 * last)


def _find_minimum(
    chain: Chain,
    angles: FloatArray,
    limit: int,
    observe: Callable[[Point], None],
) -> _ChainEquilibrium | None:
    """Return the minimum that descent on closed chains leads to; None if it gets stuck."""
    start = chain.close(angles)
    if start is None:
        return None
    point, shift, last, saddles = chain.at(start), 0.0, np.inf, 0
    pull = chain.pull(point)
    for iteration in range(1, limit + 1):
        heed()
        factors, shift = _shift_until_convex(chain, point, pull, shift)
        turns, pull = chain.step(factors)
        size = float(np.abs(turns).max())
        if shift == 0.0 and _is_last_step(size, last):
            after = chain.at(point.angles + turns)
            observe(after)
            return _ChainEquilibrium(after, chain.factors(after, pull, 0.0), iteration)
        if shift > 0.0 and size < _ROUNDING:
            saddles += 1
            turns = chain.softest(factors)[1]
            turns *= _ASIDE / float(np.abs(turns).max())
            if saddles > _SADDLES:
                return None
        found = _descend_along(chain, point, turns)
        if found is None:
            return None
        last, point = size, found
        observe(point)
    return None


def _shift_until_convex(
    chain: Chain, point: Point, pull: FloatArray, shift: float
) -> tuple[Factors, float]:
    """Return the factorised Hessian, shifted so far that it is positive; and the shift."""
    factors = chain.factors(point, pull, 0.0)
    if factors.negative == 0:
        return factors, 0.0
    # Rotation of a piece of the loop: what a kink's bending is worth, in the end.
    shift = max(0.25 * shift, 1.0)
    while factors.negative and shift < _STIFFEST:
        shift *= 4
        factors = chain.factors(point, pull, shift)
    return factors, shift


def _descend_along(chain: Chain, point: Point, turns: FloatArray) -> Point | None:
    """Return a closed chain along a descent direction with less energy; None if none."""
    size = float(np.abs(turns).max())
    part = min(1.0, _FARTHEST / size) if size > 0.0 else 1.0
    slope = float(point.gradient @ turns)
    noise = 1e-13 * (abs(point.energy) + abs(chain.load) + 40.0)
    for _ in range(_HALVINGS):
        angles = chain.close(point.angles + part * turns)
        if angles is not None:
            after = chain.at(angles)
            gained = after.energy - point.energy
            if gained <= _GAIN * part * slope or (abs(part * slope) < noise > gained):
                return after
        part *= 0.5
    return None
