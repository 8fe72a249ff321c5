"""Which motions of a loop keep its edges' lengths, and which of them slide it along itself.

Compiled loops, arrays in, arrays out, for loops in space and in a plane. Helpers stay in
this file (numba #1833).
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
    n = len(rhs)
    corner = dot(directions, n - 1, 0)
    first, last = dot(directions, 0, 0), dot(directions, n - 1, n - 1)
    even, root = (first / last) ** 0.25, np.sqrt(abs(corner) / means[0])
    start, end = root * even, np.copysign(root / even, -corner)
    inverse, ratios, border = np.empty(n), np.empty(n), np.empty(n)
    pivot, right, edge = 1.0, 0.0, 0.0
    ahead = 1.0 / means[0]
    for v in range(n):
        ease, ahead = ahead, 1.0 / means[v + 1 if v < n - 1 else 0]
        diagonal = dot(directions, v, v) * (ease + ahead)
        beside, entry = 0.0, 0.0
        if v > 0:
            beside = -ease * dot(directions, v - 1, v)
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
def dot(rows: FloatArray, i: int, j: int) -> float:
    """Return the product of two of the rows (n, d), d = 2 or 3."""
    total: float = rows[i, 0] * rows[j, 0] + rows[i, 1] * rows[j, 1]
    if rows.shape[1] == 3:
        total += rows[i, 2] * rows[j, 2]
    return total


@njit(cache=True, error_model="numpy")
def give_lengths(
    x: FloatArray, lengths: FloatArray, means: FloatArray, small: float, steps: int
) -> bool:
    """Move x (n, d) to the nearest loop whose edges are so long; return whether there is.

    By Gauss and Newton, as lengths.project_lengths does; `small`: of what rounding leaves.
    """
    n, dimension = x.shape
    directions, pull, error = np.empty((n, dimension)), np.empty(n), np.inf
    for _ in range(steps):
        before, error, total = error, 0.0, 0.0
        for v in range(n):
            for d in range(dimension):
                directions[v, d] = (x[v + 1 if v < n - 1 else 0, d] - x[v, d]) / lengths[v]
            length = np.sqrt(dot(directions, v, v))
            pull[v] = 0.5 * (length - 1.0) * (length + 1.0) * lengths[v]
            part = abs(pull[v]) / lengths[v]
            error, total = max(error, part), total + part
        if not total < np.inf or error > 1e3:
            return False
        # Quadratic convergence ends where rounding begins: then error stops falling.
        if error < 1e-15 or (error < small and error >= 0.25 * before):
            return True
        if not solve_lengths(directions, means, pull):
            return False
        draw(directions, means, pull, x)
    return error < small


@njit(cache=True, error_model="numpy")
def draw(
    directions: FloatArray, means: FloatArray, pull: FloatArray, field: FloatArray
) -> None:
    """Take M^-1 J^T pull, of pulls (n,), from a field (n, d)."""
    n = len(field)
    for d in range(field.shape[1]):
        before = pull[n - 1] * directions[n - 1, d]
        for v in range(n):
            here = pull[v] * directions[v, d]
            field[v, d] += (here - before) / means[v]
            before = here


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
    draw(directions, means, pull, field)
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
