"""Energy, forces and Newton's step of a chain of edges round a film in its plane: compiled.

Arrays in, arrays out. What is unknown are the angles theta_v of the loop's edges s_v t_v,
t_v = (cos theta_v, sin theta_v): lengths then hold exactly, the loop closes where p_n =
sum_v s_v t_v = 0, and

    E = sum_v (2 - 2 cos(theta_v - theta_{v-1})) / <s_v> + load/2 sum_v p_v x s_v t_v

(eq. discrete-energy, alpha = 1, with the polygon's area), p_v = sum_{u<v} s_u t_u. Its
second variation is a sum over edges of a quadratic form in d theta_v, d theta_{v-1} and
d p_v, and d p_{v+1} = d p_v + s_v t_v^perp d theta_v: a linear-quadratic control problem,
which Riccati's recursion solves in O(n_b). The last edge keeps its direction, so that the
loop does not turn. Helpers stay in this file (numba #1833).
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.compiling import njit


@njit(cache=True, error_model="numpy")
def energy_gradient(
    angles: FloatArray,
    lengths: FloatArray,
    load: float,
    units: FloatArray,
    points: FloatArray,
    gradient: FloatArray,
) -> float:
    """Return E; fill t_v (n, 2), p_v (n + 1, 2) from p_0 = 0, and dE / d theta_v (n,).

    The gradient of bending is -2 sin(theta_{v+1} - theta_v) / <s_{v+1}> and its like, that
    of the area s_v t_v . (p_v + p_{v+1} - p_n) / 2.
    """
    n = len(angles)
    energy = 0.0
    points[0, 0] = points[0, 1] = 0.0
    for v in range(n):
        units[v, 0], units[v, 1] = np.cos(angles[v]), np.sin(angles[v])
        across = points[v, 0] * units[v, 1] - points[v, 1] * units[v, 0]
        energy += 0.5 * load * lengths[v] * across
        for d in range(2):
            points[v + 1, d] = points[v, d] + lengths[v] * units[v, d]
    for v in range(n):
        gradient[v] = 0.0
        for d in range(2):
            middle = 0.5 * (points[v, d] + points[v + 1, d] - points[n, d])
            gradient[v] += load * lengths[v] * units[v, d] * middle
    for v in range(n):
        mean = 0.5 * (lengths[v] + lengths[v - 1])
        turn = angles[v] - angles[v - 1]
        half = np.sin(0.5 * turn)
        energy += 4.0 * half * half / mean
        gradient[v] += 2.0 * np.sin(turn) / mean
        gradient[v - 1] -= 2.0 * np.sin(turn) / mean
    return energy


@njit(cache=True)
def _stiffness(angles: FloatArray, lengths: FloatArray, v: int) -> float:
    turn = np.cos(angles[v] - angles[v - 1])
    stiffness: float = 4.0 * turn / (lengths[v] + lengths[v - 1])
    return stiffness


@njit(cache=True, error_model="numpy")
def factorise(
    angles: FloatArray,
    units: FloatArray,
    points: FloatArray,
    lengths: FloatArray,
    load: float,
    pull: FloatArray,
    row: FloatArray,
    shift: float,
    weight: float,
    gains: FloatArray,
) -> int:
    """Factorise H + shift diag(s) + weight C^T C, C d theta = (d p_n, row . d theta).

    H is the Hessian of E + pull . p_n: over vertices, c_v (d theta_v - d theta_{v-1})^2,
    c_v = 2 cos(theta_v - theta_{v-1}) / <s_v>; over edges, load s_v t_v . d p_v d theta_v,
    s_v (t_v^perp . load (p_v + p_{v+1} - p_n) / 2 - t_v . pull) d theta_v^2.

    Riccati's recursion from the last edge but one; the state before edge v is z = (d p_v,
    sum_{u<v} row_u d theta_u, d theta_{v-1}). Fills gains (n, 5): per edge the four of the
    state, and the pivot; returns how many pivots are not positive, with a weight that is
    large enough the Hessian's number of negative eigenvalues where C d theta = 0.
    """
    n = len(lengths)
    xx = yy = qq = weight
    xy = xq = yq = xa = ya = qa = 0.0
    aa = _stiffness(angles, lengths, n - 1)
    for k in range(5):
        gains[n - 1, k] = 1.0 if k == 4 else 0.0
    negative = 0
    for v in range(n - 2, -1, -1):
        s, c, q = lengths[v], _stiffness(angles, lengths, v), row[v]
        mx = 0.5 * load * (points[v, 0] + points[v + 1, 0] - points[n, 0])
        my = 0.5 * load * (points[v, 1] + points[v + 1, 1] - points[n, 1])
        own = s * (units[v, 0] * (my - pull[0]) - units[v, 1] * (mx + pull[1]))
        x, y = -s * units[v, 1], s * units[v, 0]
        gx = xx * x + xy * y + xq * q + xa
        gy = xy * x + yy * y + yq * q + ya
        gq = xq * x + yq * y + qq * q + qa
        ga = xa * x + ya * y + qa * q + aa
        pivot = c + own + shift * s + x * gx + y * gy + q * gq + ga
        gx += 0.5 * load * y
        gy -= 0.5 * load * x
        if not pivot > 0.0:
            negative += 1
        kx, ky, kq, ka = gx / pivot, gy / pivot, gq / pivot, -c / pivot
        xx -= gx * kx
        xy -= gx * ky
        xq -= gx * kq
        yy -= gy * ky
        yq -= gy * kq
        qq -= gq * kq
        xa, ya, qa, aa = c * kx, c * ky, c * kq, c + c * ka
        gains[v, 0], gains[v, 1], gains[v, 2], gains[v, 3] = kx, ky, kq, ka
        gains[v, 4] = pivot
    return negative


@njit(cache=True, error_model="numpy")
def substitute(
    units: FloatArray,
    lengths: FloatArray,
    row: FloatArray,
    gains: FloatArray,
    vector: FloatArray,
    ends: FloatArray,
) -> None:
    """Replace vector (n,) by the solution with the factors; ends (3,) is C times that."""
    n = len(lengths)
    x = y = q = a = 0.0
    vector[n - 1] = 0.0
    for v in range(n - 2, -1, -1):
        s, k = lengths[v], gains[v]
        t = s * (units[v, 0] * y - units[v, 1] * x) + row[v] * q + a - vector[v]
        x -= k[0] * t
        y -= k[1] * t
        q -= k[2] * t
        a = -k[3] * t
        vector[v] = t / k[4]
    x = y = q = a = 0.0
    for v in range(n - 1):
        s, k = lengths[v], gains[v]
        a = -(k[0] * x + k[1] * y + k[2] * q + k[3] * a + vector[v])
        vector[v] = a
        x -= s * units[v, 1] * a
        y += s * units[v, 0] * a
        q += row[v] * a
    ends[0], ends[1], ends[2] = x, y, q


@njit(cache=True, error_model="numpy")
def hold(
    units: FloatArray,
    lengths: FloatArray,
    row: FloatArray,
    gains: FloatArray,
    columns: FloatArray,
    held: FloatArray,
) -> None:
    """Fill columns (3, n) with A^-1 C^T, A what was factorised, held (3, 3) with C of it.

    Of a circle, which does not slide, the last row of C is nothing, and that of held unity.
    """
    for v in range(len(lengths)):
        columns[0, v] = -lengths[v] * units[v, 1]
        columns[1, v] = lengths[v] * units[v, 0]
        columns[2, v] = row[v]
    for k in range(3):
        substitute(units, lengths, row, gains, columns[k], held[k])
    if held[2, 2] == 0.0:
        held[2, 2] = 1.0


@njit(cache=True, error_model="numpy")
def solve_held(
    units: FloatArray,
    lengths: FloatArray,
    row: FloatArray,
    gains: FloatArray,
    weight: float,
    gap: FloatArray,
    columns: FloatArray,
    held: FloatArray,
    vector: FloatArray,
    forces: FloatArray,
) -> None:
    """Solve H u + C^T f = vector, C u = -(gap, 0), with what `factorise` and `hold` left.

    gap (2,) of the chain; leaves u in vector (n,) and f in forces (3,).
    """
    substitute(units, lengths, row, gains, vector, forces)
    forces[0] += gap[0]
    forces[1] += gap[1]
    # Symmetric and, with factors that are positive, positive definite.
    matrix = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            matrix[i, j] = held[i, j]
    for k in range(2):
        for i in range(k + 1, 3):
            ratio = matrix[i, k] / matrix[k, k]
            forces[i] -= ratio * forces[k]
            for j in range(k, 3):
                matrix[i, j] -= ratio * matrix[k, j]
    for k in range(2, -1, -1):
        for j in range(k + 1, 3):
            forces[k] -= matrix[k, j] * forces[j]
        forces[k] /= matrix[k, k]
    for v in range(len(lengths)):
        for k in range(3):
            vector[v] -= forces[k] * columns[k, v]
    for k in range(2):
        forces[k] -= weight * gap[k]


@njit(cache=True, error_model="numpy")
def close(angles: FloatArray, lengths: FloatArray, steps: int) -> float:
    """Turn edges, the last one too, until the loop closes; return the gap that is left.

    Gauss-Newton: the smallest change in the norm sum_v s_v |d theta_v|^2.
    """
    n = len(angles)
    gap = np.inf
    for _ in range(steps):
        x = y = xx = xy = yy = 0.0
        for v in range(n):
            s, c = np.sin(angles[v]), np.cos(angles[v])
            x += lengths[v] * c
            y += lengths[v] * s
            xx += lengths[v] * s * s
            xy -= lengths[v] * s * c
            yy += lengths[v] * c * c
        before, gap = gap, max(abs(x), abs(y))
        if gap < 1e-15 or (gap < 1e-12 and gap > 0.25 * before):
            break
        det = xx * yy - xy * xy
        a, b = (yy * x - xy * y) / det, (xx * y - xy * x) / det
        for v in range(n):
            angles[v] += a * np.sin(angles[v]) - b * np.cos(angles[v])
    return gap
