"""Which motions of a loop keep its edges' lengths, and which of them slide it along itself.

Compiled loops, arrays in, arrays out. `solve_lengths` and `keep_lengths` serve loops in
space and in a plane; the others plane loops whose unknowns are the angles theta_v of their
edges (solvers/in_plane/kernels.py). Helpers stay in this file (numba #1833).
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.compiling import njit

# Threshold on the part of the sliding motion that is not a rotation, of 1. A circle's
# sliding is a rotation. Of loops nearer to a circle, what is left of it cannot be told from
# a change of shape, and stays among those.
SLIDES = 0.05


@njit(cache=True, error_model="numpy")
def solve_lengths(directions: FloatArray, means: FloatArray, rhs: FloatArray) -> bool:
    """Replace rhs (n,) by (J M^-1 J^T)^-1 rhs; return whether that matrix is definite.

    J is the Jacobian of the lengths (lengths.py), M = diag(<s>); directions (n, d), e_v /
    s_v, d = 2 or 3; means (n,), <s>. Tridiagonal but for the entry in the corner, which a
    rank-one term w w^T takes out, w (n,) having two entries: what remains is positive
    semidefinite, is factorised without pivoting, and Sherman and Morrison put w back.
    """
    n, solid = len(rhs), directions.shape[1] == 3
    corner = (
        directions[n - 1, 0] * directions[0, 0] + directions[n - 1, 1] * directions[0, 1]
    )
    first = directions[0, 0] ** 2 + directions[0, 1] ** 2
    last = directions[n - 1, 0] ** 2 + directions[n - 1, 1] ** 2
    if solid:
        corner += directions[n - 1, 2] * directions[0, 2]
        first += directions[0, 2] ** 2
        last += directions[n - 1, 2] ** 2
    even, root = (first / last) ** 0.25, np.sqrt(abs(corner) / means[0])
    start, end = root * even, np.copysign(root / even, -corner)
    inverse, ratios, border = np.empty(n), np.empty(n), np.empty(n)
    pivot, right, edge = 1.0, 0.0, 0.0
    ahead = 1.0 / means[0]
    for v in range(n):
        ease, ahead = ahead, 1.0 / means[v + 1 if v < n - 1 else 0]
        square = directions[v, 0] ** 2 + directions[v, 1] ** 2
        if solid:
            square += directions[v, 2] ** 2
        diagonal, beside, entry = square * (ease + ahead), 0.0, 0.0
        if v > 0:
            beside -= directions[v - 1, 0] * directions[v, 0]
            beside -= directions[v - 1, 1] * directions[v, 1]
            if solid:
                beside -= directions[v - 1, 2] * directions[v, 2]
            beside *= ease
        else:
            diagonal, entry = diagonal - start * start, start
        if v == n - 1:
            diagonal, entry = diagonal - end * end, end
        ratio = beside / pivot
        pivot = diagonal - ratio * beside
        if not pivot > 0.0:
            return False
        right = rhs[v] - ratio * right
        edge = entry - ratio * edge
        inverse[v], ratios[v] = 1.0 / pivot, ratio
        rhs[v], border[v] = right, edge
    ratio = right = edge = 0.0
    for v in range(n - 1, -1, -1):
        right = rhs[v] * inverse[v] - ratio * right
        edge = border[v] * inverse[v] - ratio * edge
        ratio = ratios[v]
        rhs[v], border[v] = right, edge
    share = start * rhs[0] + end * rhs[n - 1]
    share /= 1.0 + start * border[0] + end * border[n - 1]
    for v in range(n):
        rhs[v] -= share * border[v]
    return True


@njit(cache=True, error_model="numpy")
def keep_lengths(directions: FloatArray, means: FloatArray, field: FloatArray) -> bool:
    """Replace field (n, d) by the nearest motion p that keeps all lengths: J p = 0.

    In the norm sum_v <s_v> |p_v|^2. Arguments and what is returned as in `solve_lengths`.
    """
    n, dimension = field.shape
    pull = np.zeros(n)
    for d in range(dimension):
        for v in range(n - 1):
            pull[v] += directions[v, d] * (field[v + 1, d] - field[v, d])
        pull[n - 1] += directions[n - 1, d] * (field[0, d] - field[n - 1, d])
    definite = solve_lengths(directions, means, pull)
    for d in range(dimension):
        before = pull[n - 1] * directions[n - 1, d]
        for v in range(n):
            here = pull[v] * directions[v, d]
            field[v, d] += (here - before) / means[v]
            before = here
    return definite


@njit(cache=True, error_model="numpy")
def fill_motions(
    x: FloatArray, directions: FloatArray, means: FloatArray, motions: FloatArray
) -> int:
    """Fill motions (m, n, d) of a loop x (n, d) that cost nothing; return how many do.

    Orthonormal in the norm sum_v <s_v> |p_v|^2: translations, rotations, and last sliding,
    unless that is rigid: m = 7 in space, 4 in a plane. None where `solve_lengths` fails.
    """
    n, d = x.shape
    last, mass = len(motions) - 1, means.sum()
    motions[:] = 0.0
    centre, slide = np.zeros(d), motions[last]
    for v in range(n):
        size = 0.0
        for c in range(d):
            centre[c] += means[v] * x[v, c] / mass
            motions[c, v, c] = 1.0 / np.sqrt(mass)
            size += directions[v, c] ** 2
        for c in range(d):
            slide[v, c] += directions[v, c] / np.sqrt(size)
            slide[(v + 1) % n, c] += directions[v, c] / np.sqrt(size)
    for k in range(d, last):
        # About the axis across p and q.
        p, q = ((k + 1) % 3, (k + 2) % 3) if d == 3 else (0, 1)
        for v in range(n):
            motions[k, v, p] = centre[q] - x[v, q]
            motions[k, v, q] = x[v, p] - centre[p]
    if not keep_lengths(directions, means, slide):
        return 0
    for k in range(d, last + 1):
        whole = work(slide, motions[k], means) if k == last else 0.0
        # Twice: once more for what rounding has left.
        for other in 2 * list(range(k)):
            share = work(motions[other], motions[k], means)
            for v in range(n):
                for c in range(d):
                    motions[k, v, c] -= share * motions[other, v, c]
        left = work(motions[k], motions[k], means)
        if not left >= SLIDES**2 * whole:
            return k
        motions[k] /= np.sqrt(left)
    return last + 1


@njit(cache=True, error_model="numpy")
def work(one: FloatArray, other: FloatArray, means: FloatArray) -> float:
    """Return sum_v <s_v> p_v . q_v of two fields (n, d)."""
    total = 0.0
    for v in range(len(one)):
        for c in range(one.shape[1]):
            total += means[v] * one[v, c] * other[v, c]
    return total


@njit(cache=True, error_model="numpy")
def balance(
    directions: FloatArray,
    means: FloatArray,
    motions: FloatArray,
    force: FloatArray,
    tensions: FloatArray,
    left: FloatArray,
) -> float:
    """Fill the tensions (n,) that balance a force (n, d) best, and what they leave of it.

    In the norm of M^-1, and not along motions (m, n, d), orthonormal. Returns the largest
    of what tensions add; nan where `solve_lengths` fails.
    """
    n, d = force.shape
    pull, largest = np.empty(n), 0.0
    tensions[:], left[:] = 0.0, force
    # Twice: once more for what rounding has left.
    for _ in range(2):
        for v in range(n):
            after, pull[v] = (v + 1) % n, 0.0
            for c in range(d):
                moved = left[after, c] / means[after] - left[v, c] / means[v]
                pull[v] += directions[v, c] * moved
        if not solve_lengths(directions, means, pull):
            return np.nan
        tensions -= pull
        for v in range(n):
            for c in range(d):
                before = tensions[v - 1] * directions[v - 1, c]
                added = before - tensions[v] * directions[v, c]
                left[v, c] = force[v, c] + added
                largest = max(largest, abs(added))
    for k in range(len(motions)):
        share = 0.0
        for v in range(n):
            for c in range(d):
                share += motions[k, v, c] * left[v, c]
        for v in range(n):
            for c in range(d):
                left[v, c] -= share * means[v] * motions[k, v, c]
    return largest


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
    row: FloatArray,
) -> None:
    """Fill row (n,) with the part of d theta_v in the loop's sliding along itself.

    row . d theta = sum_v <s_v> slide_v . d x_v with motions.sliding; zero for a circle.
    """
    n = len(lengths)
    slide = np.empty((n, 2))
    for v in range(n):
        for d in range(2):
            slide[v, d] = units[v, d] + units[v - 1, d]
    keep_lengths(units, means, slide)
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
