"""Turns of the edges of a plane loop: what sliding and displacements are by them.

Compiled loops, arrays in, arrays out. The unknowns are the angles theta_v of the edges
(kernels.py), units (n, 2) their directions t_v. Helpers stay in this file (numba #1833).
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.compiling import njit
from eulerplateau.loop.slide_kernels import SLIDES


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
def remove_rigid(points: FloatArray, means: FloatArray, field: FloatArray) -> float:
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
    slide: FloatArray,
    row: FloatArray,
) -> None:
    """Fill row (n,) with the part of d theta_v in the loop's sliding along itself.

    row . d theta = sum_v <s_v> slide_v . d x_v with motions.sliding; zero for a circle.
    slide : (n, 2), the tangent made to keep all lengths; is changed
    """
    n = len(lengths)
    whole = 0.0
    for v in range(n):
        whole += means[v] * (slide[v, 0] ** 2 + slide[v, 1] ** 2)
    left = remove_rigid(points, means, slide)
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
    size = remove_rigid(points, means, field)
    for v in range(n):
        for d in range(2):
            field[v, d] *= means[v]
    work_of(units, lengths, field, row)
    return size
