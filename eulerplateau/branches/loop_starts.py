"""Loops from which equilibria are sought: circles, random ones, known ones displaced."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.point import BranchPoint
from eulerplateau.loop import Loop

# Random loops are circles with waves of these numbers, of sizes up to this over the number
# squared; small ones are as many as large ones are rare.
_WAVES, _SIZE = range(2, 6), 2.0
# The r.m.s. displacements from which deflation starts, in units of L.
_DISPLACED = 0.005, 0.05
# Of the stiffest mode's curvature: modes softer are displaced as if they were as stiff.
_SOFTEST = 1e-7


def random_loop(loop: Loop, rng: np.random.Generator) -> FloatArray:
    """Return a smooth random loop (n, 3) that is about as long as a loop."""
    x, s = circle(loop), _angles(loop)
    size, radius = _SIZE * rng.uniform() ** 2, np.linalg.norm(x[0])
    for wave in _WAVES:
        a, b = rng.standard_normal((2, 3)) * size / wave**2 * radius
        x += np.outer(np.cos(wave * s), a) + np.outer(np.sin(wave * s), b)
    return x


def circle(loop: Loop) -> FloatArray:
    """Return a circle (n, 3) that is as long as the loop, its vertices as far apart."""
    s, radius = _angles(loop), loop.rest_lengths.sum() / (2 * np.pi)
    x: FloatArray = radius * np.stack([np.cos(s), np.sin(s), np.zeros_like(s)], axis=1)
    return x


def _angles(loop: Loop) -> FloatArray:
    lengths = loop.rest_lengths
    angles: FloatArray = 2 * np.pi * np.cumsum(lengths) / lengths.sum()
    return angles


def displaced(point: BranchPoint, rng: np.random.Generator) -> FloatArray:
    """Return an equilibrium's loop (n, d) displaced at random, as heat would displace it.

    That is along each mode by the inverse root of its stiffness.
    """
    values, vectors = point.model.eigen
    stiffness = np.maximum(np.abs(values), _SOFTEST * np.abs(values).max())
    moved = point.model.displacement(
        vectors @ (rng.standard_normal(len(values)) / np.sqrt(stiffness))
    )
    size = np.sqrt(np.mean(np.sum(moved**2, axis=1)))
    found: FloatArray = point.x + moved * (rng.uniform(*_DISPLACED) / size)
    return found
