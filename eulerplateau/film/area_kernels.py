"""The area of a film's triangles with its two derivatives: compiled loops (area.py).

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
def sum_hessian(
    cotangent: FloatArray, normals: FloatArray, place: IntArray, blocks: FloatArray
) -> None:
    """Add d2A/dx_i dx_j of every triangle to `blocks` (m, 3, 3), at `place` (n_t, 3, 3)."""
    for t in range(cotangent.shape[0]):
        n = normals[t]
        for i in range(3):
            for j in range(3):
                block = blocks[place[t, i, j]]
                # 1 where j follows two after i, -1 where one after, 0 for i = j.
                turn = 0.5 * (((j - i) % 3 == 2) * 1.0 - ((j - i) % 3 == 1) * 1.0)
                for d in range(3):
                    p, q = (d + 1) % 3, (d + 2) % 3
                    for e in range(3):
                        block[d, e] += cotangent[t, i, j] * n[d] * n[e]
                    # Row d of [n]_x: -n_q in column p, n_p in column q.
                    block[d, p] -= turn * n[q]
                    block[d, q] += turn * n[p]


@njit(cache=True)
def sum_along(
    cotangent: FloatArray,
    normals: FloatArray,
    triangles: IntArray,
    directions: FloatArray,
    place: IntArray,
    entries: FloatArray,
) -> None:
    """Add u_i . d2A/dx_i dx_j u_j to `entries`, at `place` (n_t, 3, 3).

    directions : (n_v, 3), u.
    """
    for t in range(triangles.shape[0]):
        n = normals[t]
        for i in range(3):
            u = directions[triangles[t, i]]
            rise = n[0] * u[0] + n[1] * u[1] + n[2] * u[2]
            for j in range(3):
                w = directions[triangles[t, j]]
                value = (
                    cotangent[t, i, j] * rise * (n[0] * w[0] + n[1] * w[1] + n[2] * w[2])
                )
                turn = 0.5 * (((j - i) % 3 == 2) * 1.0 - ((j - i) % 3 == 1) * 1.0)
                for d in range(3):
                    p, q = (d + 1) % 3, (d + 2) % 3
                    value += turn * u[d] * (n[p] * w[q] - n[q] * w[p])
                entries[place[t, i, j]] += value


@njit(cache=True)
def couple(
    entries: FloatArray,
    pairs: IntArray,
    rows: IntArray,
    columns: IntArray,
    values: FloatArray,
    found: FloatArray,
) -> None:
    """Add a matrix's entries at `pairs` (k,) times values (n, d) to `found` (m, d).

    rows, columns : (k,), where each of them is
    """
    for k in range(pairs.shape[0]):
        for d in range(values.shape[1]):
            found[rows[k], d] += entries[pairs[k]] * values[columns[k], d]


@njit(cache=True)
def pull(
    blocks: FloatArray,
    rows: IntArray,
    columns: IntArray,
    moved: FloatArray,
    found: FloatArray,
) -> None:
    """Add blocks (m, 3, 3) times displacements (n_v, 3) to `found` (n_v, 3)."""
    for m in range(blocks.shape[0]):
        block, step, force = blocks[m], moved[columns[m]], found[rows[m]]
        for d in range(3):
            force[d] += block[d, 0] * step[0] + block[d, 1] * step[1] + block[d, 2] * step[2]


@njit(cache=True)
def rise(
    blocks: FloatArray,
    pairs: IntArray,
    rows: IntArray,
    columns: IntArray,
    normals: FloatArray,
    found: FloatArray,
) -> None:
    """Fill found (k,) with n_i . H_ik n_k of the blocks (m, 3, 3) at `pairs` (k,)."""
    for at in range(pairs.shape[0]):
        m = pairs[at]
        block, one, other = blocks[m], normals[rows[m]], normals[columns[m]]
        total = 0.0
        for d in range(3):
            along = one[0] * block[0, d] + one[1] * block[1, d] + one[2] * block[2, d]
            total += along * other[d]
        found[at] = total


@njit(cache=True)
def rise_and_follow(
    blocks: FloatArray,
    pairs: IntArray,
    rows: IntArray,
    columns: IntArray,
    normals: FloatArray,
    weight: FloatArray,
    found: FloatArray,
) -> None:
    """Fill found (k, 3) with w_k n_i . H_ik of the blocks (m, 3, 3) at `pairs` (k,)."""
    for at in range(pairs.shape[0]):
        m = pairs[at]
        block, one, share = blocks[m], normals[rows[m]], weight[columns[m]]
        for d in range(3):
            along = one[0] * block[0, d] + one[1] * block[1, d] + one[2] * block[2, d]
            found[at, d] = share * along


@njit(cache=True)
def follow(
    blocks: FloatArray,
    pairs: IntArray,
    rows: IntArray,
    columns: IntArray,
    weight: FloatArray,
    found: FloatArray,
) -> None:
    """Fill found (k, 3, 3) with w_i w_k H_ik of the blocks (m, 3, 3) at `pairs` (k,)."""
    for at in range(pairs.shape[0]):
        m = pairs[at]
        share = weight[rows[m]] * weight[columns[m]]
        for d in range(3):
            for e in range(3):
                found[at, d, e] = share * blocks[m, d, e]
