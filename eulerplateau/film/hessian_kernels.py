"""The second derivative of a film's area, and what it does to displacements.

Compiled loops, as in area_kernels.py, where sides are counted. Blocks (m, 3, 3) couple
pairs of vertices, `rows` and `columns` (m,). What sums into an array expects zeros there.
"""

from __future__ import annotations

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.compiling import njit


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
            force[d] += (
                block[d, 0] * step[0] + block[d, 1] * step[1] + block[d, 2] * step[2]
            )


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
