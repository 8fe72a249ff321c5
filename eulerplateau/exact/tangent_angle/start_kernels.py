"""How a lobe's angle phi is read off a polygon: compiled loops (relaxation.py)."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.compiling import njit


@njit(cache=True, error_model="numpy")
def polygon_angle(
    start: FloatArray, at: FloatArray, phi: FloatArray
) -> tuple[float, float]:
    """Fill at, phi (N + 1,): arc length, of 1, to the middle of every edge, and phi there.

    start : (N, 2 or 3), of which x and y count. The last entry is the first edge's, once
    round. Returns the shortest edge over the mean one, and by how many radians the tangent
    turns.
    """
    n = len(start)
    length, shortest, last_x, last_y = 0.0, np.inf, 0.0, 0.0
    for v in range(n + 1):
        here, there = v % n, (v + 1) % n
        x, y = start[there, 0] - start[here, 0], start[there, 1] - start[here, 1]
        size = np.hypot(x, y)
        shortest = min(shortest, size)
        at[v] = length + 0.5 * size
        if v == 0:
            phi[v] = np.arctan2(y, x)
        else:
            turn = np.arctan2(last_x * y - last_y * x, last_x * x + last_y * y)
            phi[v] = phi[v - 1] + turn
        if v < n:
            length += size
        last_x, last_y = x, y
    turning = phi[n] - phi[0]
    for v in range(n + 1):
        at[v] /= length
        phi[v] -= 0.5 * np.pi + 2 * np.pi * at[v]
    return shortest * n / length, turning


@njit(cache=True, error_model="numpy")
def project(
    at: FloatArray, phi: FloatArray, lobes: int, half: int, c: FloatArray
) -> tuple[float, float]:
    """Fill c (m,) with the part of a polygon's phi, linear in between, that is a lobe's.

    phi counts at `half` points on every half lobe. Returns the root mean square of phi, and
    of what of it lacks the symmetry.
    """
    last = len(at) - 1
    count = 2 * lobes * half
    lobe = np.zeros(half)
    squares, kept, v = 0.0, 0.0, 0
    for i in range(count):
        s = (i + 0.5) / count
        if s < at[0]:
            s += 1.0
        while v < last - 1 and at[v + 1] < s:
            v += 1
        part = (s - at[v]) / (at[v + 1] - at[v])
        value = phi[v] + part * (phi[v + 1] - phi[v])
        if s > 1.0:
            v = 0
        squares += value * value / count
        place = i % (2 * half)
        if place < half:
            lobe[place] += 0.5 * value / lobes
        else:
            lobe[2 * half - 1 - place] -= 0.5 * value / lobes
    c[:] = 0.0
    for j in range(half):
        kept += lobe[j] * lobe[j] / half
        for k in range(len(c)):
            c[k] += 2 / half * lobe[j] * np.sin(np.pi * (k + 1) * (j + 0.5) / half)
    return np.sqrt(squares), np.sqrt(max(squares - kept, 0.0))
