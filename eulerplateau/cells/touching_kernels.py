"""Compiled loops over pairs of edges of a polygon: do they cross, are they near."""

from __future__ import annotations

import math

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.compiling import njit


@njit(cache=True)
def crosses(x: FloatArray) -> bool:
    """Whether two edges of a closed polygon x (n, 2) without a common vertex meet.

    Two segments meet if their boxes overlap and neither has both its ends strictly on one
    side of the other.
    """
    n = x.shape[0]
    for i in range(n - 2):
        a, b = i, i + 1
        low_x, high_x = min(x[a, 0], x[b, 0]), max(x[a, 0], x[b, 0])
        low_y, high_y = min(x[a, 1], x[b, 1]), max(x[a, 1], x[b, 1])
        last = n - 1 if i == 0 else n
        for c in range(i + 2, last):
            d = c + 1 if c + 1 < n else 0
            if max(x[c, 0], x[d, 0]) < low_x or min(x[c, 0], x[d, 0]) > high_x:
                continue
            if max(x[c, 1], x[d, 1]) < low_y or min(x[c, 1], x[d, 1]) > high_y:
                continue
            if _side(x, a, b, c) * _side(x, a, b, d) > 0.0:
                continue
            if _side(x, c, d, a) * _side(x, c, d, b) <= 0.0:
                return True
    return False


@njit(cache=True)
def near(x: FloatArray, lengths: FloatArray, reach: float, apart: float) -> bool:
    """Whether a vertex comes within `reach` edges of an edge `apart` edges along the loop.

    Both are measured in the shorter of the edges there, so that sides with short edges
    beside ones with long edges are no contact. An edge that begins at the distance d is
    followed by others out of reach until the loop can have come that far, which are left
    out. x : (n, 2); lengths : (n,), of edges v -> v + 1.
    """
    n = x.shape[0]
    longest = lengths.max()
    places = np.cumsum(lengths) - lengths
    perimeter = lengths.sum()
    for i in range(n):
        own = min(lengths[i], lengths[i - 1])
        k = 1
        while k < n - 1:
            j = i + k if i + k < n else i + k - n
            d_x, d_y = x[i, 0] - x[j, 0], x[i, 1] - x[j, 1]
            ahead = (math.sqrt(d_x * d_x + d_y * d_y) - reach * own) / longest
            k += max(1, int(min(ahead, float(n))))
            if ahead > 1.0:
                continue
            shorter = min(own, lengths[j])
            limit, along = reach * shorter, (places[j] - places[i]) % perimeter
            if min(along, perimeter - along - lengths[j]) < apart * shorter:
                continue
            after = j + 1 if j + 1 < n else 0
            e_x, e_y = x[after, 0] - x[j, 0], x[after, 1] - x[j, 1]
            part = (d_x * e_x + d_y * e_y) / (lengths[j] * lengths[j])
            part = min(1.0, max(0.0, part))
            d_x -= part * e_x
            d_y -= part * e_y
            if d_x * d_x + d_y * d_y < limit * limit:
                return True
    return False


@njit(cache=True)
def _side(x: FloatArray, a: int, b: int, c: int) -> float:
    """Twice the signed area of three vertices, positive if c lies left of a -> b."""
    area: float = (x[b, 0] - x[a, 0]) * (x[c, 1] - x[a, 1])
    area -= (x[b, 1] - x[a, 1]) * (x[c, 0] - x[a, 0])
    return area
