"""Compiled loops of a plane loop's motions. Arrays in, arrays out.

Displacements that keep the edges' lengths, by the angles theta_v of the edges
(plane_kernels.py). Helpers stay in this file (numba #1833).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from eulerplateau.arrays import FloatArray

# Of a circle, sliding is a rotation. What is left of it, of 1, is a motion of its own
# beyond this; nearer to a circle it cannot be told from the shape's modes, and stays among
# them.
SLIDES = 0.05


@njit(cache=True, error_model="numpy")
def solve_lengths(units: FloatArray, means: FloatArray, rhs: FloatArray) -> None:
    """Replace rhs (n,) by (J M^-1 J^T)^-1 rhs, J the lengths' Jacobian, M = diag(<s>).

    Tridiagonal but for a corner, which a rank-one term takes out (inextensible.py).
    """
    n = len(rhs)
    corner = -(units[n - 1, 0] * units[0, 0] + units[n - 1, 1] * units[0, 1]) / means[0]
    root = np.sqrt(abs(corner))
    ends = (root, np.copysign(root, corner))
    border = np.zeros(n)
    border[0], border[n - 1] = ends
    pivots, ratios = np.empty(n), np.empty(n)
    for v in range(n):
        diagonal = 1.0 / means[v] + 1.0 / means[(v + 1) % n]
        if v == 0 or v == n - 1:
            diagonal -= root * root
        if v == 0:
            ratios[v] = 0.0
        else:
            dot = units[v - 1, 0] * units[v, 0] + units[v - 1, 1] * units[v, 1]
            beside = -dot / means[v]
            ratios[v] = beside / pivots[v - 1]
            diagonal -= ratios[v] * beside
            rhs[v] -= ratios[v] * rhs[v - 1]
            border[v] -= ratios[v] * border[v - 1]
        pivots[v] = diagonal
    for v in range(n - 1, -1, -1):
        rhs[v] /= pivots[v]
        border[v] /= pivots[v]
        if v < n - 1:
            rhs[v] -= ratios[v + 1] * rhs[v + 1]
            border[v] -= ratios[v + 1] * border[v + 1]
    share = ends[0] * rhs[0] + ends[1] * rhs[n - 1]
    share /= 1.0 + ends[0] * border[0] + ends[1] * border[n - 1]
    for v in range(n):
        rhs[v] -= share * border[v]


@njit(cache=True, error_model="numpy")
def work_of(
    units: FloatArray, lengths: FloatArray, forces: FloatArray, row: FloatArray
) -> None:
    """Fill row (n,) with the work per d theta_v of forces (n, 2) that sum to zero."""
    x, y = 0.0, 0.0
    for v in range(len(lengths) - 1, -1, -1):
        row[v] = lengths[v] * (units[v, 0] * y - units[v, 1] * x)
        x += forces[v, 0]
        y += forces[v, 1]


@njit(cache=True, error_model="numpy")
def without_rigid(points: FloatArray, means: FloatArray, field: FloatArray) -> float:
    """Take rigid motions out of a field (n, 2); return what is left of it squared.

    Both in the norm sum_v <s_v> |p_v|^2; points (n or more, 2) are the vertices.
    """
    n = len(field)
    mass, inertia, spin, left = 0.0, 0.0, 0.0, 0.0
    x, y, u, w = 0.0, 0.0, 0.0, 0.0
    for v in range(n):
        mass += means[v]
        x += means[v] * points[v, 0]
        y += means[v] * points[v, 1]
        u += means[v] * field[v, 0]
        w += means[v] * field[v, 1]
    x, y, u, w = x / mass, y / mass, u / mass, w / mass
    for v in range(n):
        a, b = points[v, 0] - x, points[v, 1] - y
        spin += means[v] * (a * (field[v, 1] - w) - b * (field[v, 0] - u))
        inertia += means[v] * (a * a + b * b)
    spin /= inertia
    for v in range(n):
        field[v, 0] -= u - spin * (points[v, 1] - y)
        field[v, 1] -= w + spin * (points[v, 0] - x)
        left += means[v] * (field[v, 0] ** 2 + field[v, 1] ** 2)
    return left


@njit(cache=True, error_model="numpy")
def slide_row(
    units: FloatArray,
    points: FloatArray,
    means: FloatArray,
    lengths: FloatArray,
    row: FloatArray,
) -> None:
    """Fill row (n,) with the part of d theta_v in the loop's sliding along itself.

    row . d theta = sum_v <s_v> slide_v . d x_v with motions.sliding; zero for a circle.
    """
    n = len(lengths)
    pull, slide = np.empty(n), np.empty((n, 2))
    whole = 0.0
    for v in range(n):
        for d in range(2):
            slide[v, d] = units[v, d] + units[v - 1, d]
    for v in range(n):
        after = (v + 1) % n
        pull[v] = 0.0
        for d in range(2):
            pull[v] += units[v, d] * (slide[after, d] - slide[v, d])
    solve_lengths(units, means, pull)
    for v in range(n):
        for d in range(2):
            slide[v, d] += (pull[v] * units[v, d] - pull[v - 1] * units[v - 1, d]) / means[
                v
            ]
        whole += means[v] * (slide[v, 0] ** 2 + slide[v, 1] ** 2)
    left = without_rigid(points, means, slide)
    scale = 1.0 / np.sqrt(left) if left >= SLIDES**2 * whole else 0.0
    for v in range(n):
        for d in range(2):
            slide[v, d] *= means[v] * scale
    work_of(units, lengths, slide, row)


@njit(cache=True, error_model="numpy")
def mass_row(
    units: FloatArray,
    points: FloatArray,
    means: FloatArray,
    lengths: FloatArray,
    turns: FloatArray,
    row: FloatArray,
) -> float:
    """Fill row (n,) with M d theta of turns (n,); return d theta . M d theta.

    M is the norm integral |p|^2 ds of the displacement, rigid motions taken out.
    """
    n = len(lengths)
    field = np.zeros((n, 2))
    for v in range(1, n):
        field[v, 0] = field[v - 1, 0] - lengths[v - 1] * units[v - 1, 1] * turns[v - 1]
        field[v, 1] = field[v - 1, 1] + lengths[v - 1] * units[v - 1, 0] * turns[v - 1]
    size = without_rigid(points, means, field)
    for v in range(n):
        for d in range(2):
            field[v, d] *= means[v]
    work_of(units, lengths, field, row)
    return size
