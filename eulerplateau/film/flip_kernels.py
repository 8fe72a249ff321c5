"""How edges are flipped to Delaunay's triangles, on a surface: compiled loops (repair.py).

Arrays in, arrays out; helpers stay in this file (numba #1833).
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.compiling import njit

# Two triangles are turned into the other two of their quadrilateral only where it is nearly
# flat: cosine of the largest angle between their normals, before and after.
_FLAT = 0.5


@njit(cache=True)
def _corner_normal(x: FloatArray, i: int, j: int, k: int) -> FloatArray:
    normal = np.cross(x[j] - x[i], x[k] - x[i])
    size = np.sqrt((normal * normal).sum())
    return normal / size if size > 0 else np.zeros(3)


@njit(cache=True)
def _cotangent(x: FloatArray, at: int, i: int, j: int) -> float:
    ax, ay, az = x[i, 0] - x[at, 0], x[i, 1] - x[at, 1], x[i, 2] - x[at, 2]
    bx, by, bz = x[j, 0] - x[at, 0], x[j, 1] - x[at, 1], x[j, 2] - x[at, 2]
    cx, cy, cz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    cotangent: float = (ax * bx + ay * by + az * bz) / max(
        np.sqrt(cx * cx + cy * cy + cz * cz), 1e-300
    )
    return cotangent


@njit(cache=True)
def _have_edge(triangles: IntArray, across: IntArray, start: int, i: int, j: int) -> bool:
    """Whether vertex i, a corner of triangle `start`, is joined to j by an edge."""
    for way in range(2):
        t = start
        while t >= 0:
            corner = 0
            while triangles[t, corner] != i:
                corner += 1
            ahead = (corner + 1 + way) % 3
            if triangles[t, ahead] == j or triangles[t, (corner + 2 - way) % 3] == j:
                return True
            t = across[t, ahead]
            if t == start:
                break
    return False


@njit(cache=True)
def flip_to_delaunay(x: FloatArray, triangles: IntArray, across: IntArray) -> int:
    """Flip edges whose opposite angles sum to more than pi, in place; return how many.

    Lawson (1977), on a surface: the two angles decide, not a plane. x : (n_v, 3);
    triangles : (n_t, 3), counter-clockwise; across : (n_t, 3), the triangle beyond the side
    opposite each corner, -1 at the loop. No edge is made twice, and none that folds.
    """
    flips = 0
    for _ in range(50):
        before = flips
        for t in range(len(triangles)):
            for j in range(3):
                u = across[t, j]
                if u > t and _flip(x, triangles, across, t, j, u):
                    flips += 1
        if flips == before:
            break
    return flips


@njit(cache=True)
def _flip(
    x: FloatArray, triangles: IntArray, across: IntArray, t: int, j: int, u: int
) -> bool:
    c, a, b = triangles[t, j], triangles[t, (j + 1) % 3], triangles[t, (j + 2) % 3]
    k = 0
    while triangles[u, k] == a or triangles[u, k] == b:
        k += 1
    d = triangles[u, k]
    if _cotangent(x, c, a, b) + _cotangent(x, d, a, b) > -1e-9:
        return False
    old = _corner_normal(x, c, a, b), _corner_normal(x, d, b, a)
    new = _corner_normal(x, c, a, d), _corner_normal(x, d, b, c)
    flat = (new[0] * new[1]).sum()
    for was in old:
        for now in new:
            flat = min(flat, (was * now).sum())
    if flat < _FLAT or _have_edge(triangles, across, t, c, d):
        return False
    # Corner order in u is d, b, a: the sides opposite b and a lie along d-a and d-b.
    beyond_bc, beyond_ca = across[t, (j + 1) % 3], across[t, (j + 2) % 3]
    beyond_ad, beyond_db = across[u, (k + 1) % 3], across[u, (k + 2) % 3]
    triangles[t, 0], triangles[t, 1], triangles[t, 2] = c, a, d
    triangles[u, 0], triangles[u, 1], triangles[u, 2] = d, b, c
    across[t, 0], across[t, 1], across[t, 2] = beyond_ad, u, beyond_ca
    across[u, 0], across[u, 1], across[u, 2] = beyond_bc, t, beyond_db
    for owner, former, side in ((t, u, beyond_ad), (u, t, beyond_bc)):
        if side >= 0:
            for m in range(3):
                if across[side, m] == former:
                    across[side, m] = owner
                    break
    return True
