"""The triangles of a film, their area and its gradient: compiled loops (tiling.py).

Side j of a triangle lies opposite its corner j; of corners i and j, j = i + 1 mod 3 comes
next. Arrays in, arrays out; what sums into an array expects zeros there.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.compiling import njit


@njit(cache=True)
def measure(
    x: FloatArray,
    triangles: IntArray,
    edges: FloatArray,
    normals: FloatArray,
    areas: FloatArray,
) -> None:
    """Fill sides (n_t, 3, 3), unit normals (n_t, 3) and areas (n_t,) of x (n_v, 3).

    The normal of a triangle without area is zero.
    """
    for t in range(triangles.shape[0]):
        for j in range(3):
            first, second = triangles[t, (j + 1) % 3], triangles[t, (j + 2) % 3]
            for d in range(3):
                edges[t, j, d] = x[second, d] - x[first, d]
        a, b = edges[t, 0], edges[t, 1]
        size = 0.0
        for d in range(3):
            p, q = (d + 1) % 3, (d + 2) % 3
            normals[t, d] = a[p] * b[q] - a[q] * b[p]
            size += normals[t, d] * normals[t, d]
        size = np.sqrt(size)
        areas[t] = 0.5 * size
        if size > 0.0:
            for d in range(3):
                normals[t, d] /= size


@njit(cache=True)
def least_sine(edges: FloatArray, areas: FloatArray) -> float:
    """Return the sine of the smallest angle of triangles (n_t, 3, 3); 0 without an area.

    It is opposite the shortest side, between the two others: see mesh.smallest_angle.
    """
    least = 1.0
    for t in range(edges.shape[0]):
        e, shortest, product = edges[t], np.inf, 1.0
        for j in range(3):
            size = np.sqrt(e[j, 0] ** 2 + e[j, 1] ** 2 + e[j, 2] ** 2)
            shortest, product = min(shortest, size), product * size
        sine = 0.0
        if shortest > 0.0:
            sine = 2.0 * areas[t] * shortest / product
        if not sine >= least:
            least = sine
    return least


@njit(cache=True)
def are_near(normals: FloatArray, others: FloatArray, cosine: float) -> bool:
    """Return whether unit normals (n, 3) turn less from others than by that cosine."""
    for t in range(normals.shape[0]):
        n, m = normals[t], others[t]
        if not n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > cosine:
            return False
    return True


@njit(cache=True)
def sum_normals(
    triangles: IntArray, normals: FloatArray, areas: FloatArray, found: FloatArray
) -> None:
    """Fill unit normals (n_v, 3) of vertices, the triangles' weighted by their areas."""
    found[:] = 0.0
    for t in range(triangles.shape[0]):
        for j in range(3):
            for d in range(3):
                found[triangles[t, j], d] += normals[t, d] * areas[t]
    for v in range(found.shape[0]):
        n = found[v]
        size = np.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
        if size > 0.0:
            for d in range(3):
                n[d] /= size


@njit(cache=True)
def sum_gradient(
    triangles: IntArray, edges: FloatArray, normals: FloatArray, gradient: FloatArray
) -> None:
    """Add n x e_j / 2 of every corner j to `gradient` (n_v, 3)."""
    for t in range(triangles.shape[0]):
        n = normals[t]
        for j in range(3):
            e, v = edges[t, j], triangles[t, j]
            for d in range(3):
                p, q = (d + 1) % 3, (d + 2) % 3
                gradient[v, d] += 0.5 * (n[p] * e[q] - n[q] * e[p])


@njit(cache=True)
def stand(
    x: FloatArray,
    triangles: IntArray,
    others: FloatArray,
    cosine: float,
    edges: FloatArray,
    normals: FloatArray,
    areas: FloatArray,
    gradient: FloatArray,
) -> bool:
    """Do `measure`, `are_near` and `sum_gradient` in one; return what the second says."""
    measure(x, triangles, edges, normals, areas)
    if not are_near(normals, others, cosine):
        return False
    sum_gradient(triangles, edges, normals, gradient)
    return True


@njit(cache=True)
def change(x: FloatArray, after: FloatArray, triangles: IntArray) -> float:
    """Return area(after) - area(x) with the relative precision of the difference.

    Triangle by triangle, |c'| - |c| = (c' - c) . (c' + c) / (|c'| + |c|) for c twice the
    vector area.
    """
    total = 0.0
    a, b, da, db = np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    for t in range(triangles.shape[0]):
        i, j, k = triangles[t]
        for d in range(3):
            a[d], b[d] = x[j, d] - x[i, d], x[k, d] - x[i, d]
            start = after[i, d] - x[i, d]
            da[d] = (after[j, d] - x[j, d]) - start
            db[d] = (after[k, d] - x[k, d]) - start
        along = sizes = grown = 0.0
        for d in range(3):
            p, q = (d + 1) % 3, (d + 2) % 3
            c = a[p] * b[q] - a[q] * b[p]
            moved = da[p] * (b[q] + db[q]) - da[q] * (b[p] + db[p])
            moved += a[p] * db[q] - a[q] * db[p]
            sizes += c * c
            grown += (c + moved) * (c + moved)
            along += moved * (2.0 * c + moved)
        size = np.sqrt(sizes) + np.sqrt(grown)
        if size > 0.0:
            total += along / size
    return 0.5 * total


@njit(cache=True)
def cotangents(edges: FloatArray, areas: FloatArray, found: FloatArray) -> None:
    """Fill (e_i . e_j) / (4 A) (n_t, 3, 3): zero for a triangle without an area."""
    for t in range(edges.shape[0]):
        for i in range(3):
            for j in range(3):
                dot = 0.0
                for d in range(3):
                    dot += edges[t, i, d] * edges[t, j, d]
                found[t, i, j] = dot / (4.0 * areas[t]) if areas[t] > 0.0 else 0.0


@njit(cache=True)
def lie_on_each_other(
    normals: FloatArray, areas: FloatArray, beyond: IntArray, cosine: float, least: float
) -> bool:
    """Return whether the normals of two neighbours differ by that cosine or more.

    beyond : (n_t, 3), the neighbours, or -1. Triangles of no larger area count for nothing.
    """
    for t in range(beyond.shape[0]):
        for j in range(3):
            other = beyond[t, j]
            if other < t or areas[t] <= least or areas[other] <= least:
                continue
            along = 0.0
            for d in range(3):
                along += normals[t, d] * normals[other, d]
            if along < cosine:
                return True
    return False
