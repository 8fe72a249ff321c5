"""The least distance of a loop's strands, by brute force over all pairs of its points.

Written without the package's search for contacts, which it is held against.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import minimum_filter
from scipy.spatial.distance import cdist

from eulerplateau.arrays import FloatArray

# Points on each edge of which all pairs are looked at.
_POINTS = 16
# The places of the nearest are moved by steps that are halved until they are so short.
_SHORTEST = 1e-9
_ROUNDS = 400


def least_distance(x: FloatArray, rest_lengths: FloatArray, apart: float) -> float:
    """Return the least distance of places that are `apart` from each other along a loop.

    The loop is the periodic cubic spline in rest arclength through vertices x (n, 3).
    """
    knots = np.concatenate([[0.0], np.cumsum(rest_lengths)])
    curve = CubicSpline(knots, np.vstack([x, x[:1]]), bc_type="periodic")
    whole = float(knots[-1])
    s = whole * np.arange(_POINTS * len(x)) / (_POINTS * len(x))
    points = curve(s)
    distances = cdist(points, points)
    distances[_along(s[:, None], s, whole) < apart] = np.inf
    # A place nearer than all sampled ones is within a spacing of one that is nearly so.
    low = distances == minimum_filter(distances, 3, mode="wrap")
    low &= distances < distances.min() + 2 * s[1]
    one, other = np.nonzero(np.triu(low))
    return _settled(curve, s[one], s[other], float(s[1]), apart)


def _settled(
    curve: CubicSpline, s: FloatArray, t: FloatArray, spacing: float, apart: float
) -> float:
    """Return the least distance that pairs of places (k,) come to, moved step by step."""
    whole = float(curve.x[-1])
    moves = np.array([(0, 0), *((i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j)])
    steps, every = np.full(len(s), spacing), np.arange(len(s))
    least = np.full(len(s), np.inf)
    for _ in range(_ROUNDS):
        tried_s = (s[:, None] + steps[:, None] * moves[:, 0]) % whole
        tried_t = (t[:, None] + steps[:, None] * moves[:, 1]) % whole
        distances = np.linalg.norm(curve(tried_s) - curve(tried_t), axis=-1)
        distances[_along(tried_s, tried_t, whole) < apart] = np.inf
        best = distances.argmin(axis=1)
        s, t, least = tried_s[every, best], tried_t[every, best], distances[every, best]
        steps = np.where(best == 0, 0.5 * steps, steps)
        if steps.max() < _SHORTEST:
            break
    return float(least.min())


def _along(s: FloatArray, t: FloatArray, whole: float) -> FloatArray:
    """Return how far places are from each other along a loop that is so long."""
    off = np.abs(s - t)
    return np.minimum(off, whole - off)
