"""Compiled loops: energies and gradients of film and loop. Arrays in, arrays out.

Every energy but the area is quadratic or, for the lengths, quartic in the positions, so the
same kernels give exact *differences* from a base point: Q(x0 + u) - Q(x0) = grad Q(x0).u +
Q(u).
Numba does not notice when a helper in another module changes (numba #1833): kernels that
call each other stay in this file.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.compiling import njit

Vector = tuple[float, float, float]


@njit(cache=True)
def film_energy_gradient(
    x: FloatArray, edges: IntArray, weights: FloatArray, gradient: FloatArray
) -> float:
    """Add the gradient of sum_e w_e |e|^2 to `gradient`; return the sum.

    Second term of eq. discrete-energy with w = k L^3/alpha. x, gradient : (n_v, 3);
    edges : (m, 2); weights : (m,).
    """
    energy = 0.0
    for e in range(edges.shape[0]):
        i, j = edges[e]
        for d in range(3):
            span = x[j, d] - x[i, d]
            energy += weights[e] * span * span
            force = 2.0 * weights[e] * span
            gradient[j, d] += force
            gradient[i, d] -= force
    return energy


@njit(cache=True)
def bending_energy_gradient(
    x: FloatArray, loop: IntArray, rest_lengths: FloatArray, gradient: FloatArray
) -> float:
    """Add the gradient of sum_v <s_v> kappa_v^2 to `gradient`; return the sum.

    First term of eq. discrete-energy with alpha = 1, kappa_v = |t_v - t_{v-1}| / <s_v> and
    t_v = (x_{v+1} - x_v) / s_v, the unit tangent where the loop keeps its rest lengths.
    x, gradient : (n_v, 3); loop, rest_lengths : (n_b,).
    """
    energy = 0.0
    n = loop.shape[0]
    for v in range(n):
        before, here, after = loop[v - 1], loop[v], loop[(v + 1) % n]
        s_in, s_out = rest_lengths[v - 1], rest_lengths[v]
        mean = 0.5 * (s_in + s_out)
        for d in range(3):
            turn = (x[after, d] - x[here, d]) / s_out - (x[here, d] - x[before, d]) / s_in
            energy += turn * turn / mean
            force = 2.0 * turn / mean
            gradient[after, d] += force / s_out
            gradient[here, d] -= force / s_out + force / s_in
            gradient[before, d] += force / s_in
    return energy


@njit(cache=True)
def augmented_difference(
    u: FloatArray,
    base: FloatArray,
    base_gradient: FloatArray,
    edges: IntArray,
    weights: FloatArray,
    loop: IntArray,
    rest_lengths: FloatArray,
    tension: FloatArray,
    penalty: float,
    gradient: FloatArray,
) -> float:
    """Augmented Lagrangian at base + u minus its value at base; gradient by the way.

    A = E_film + E_bending + sum_v [lambda_v c_v + mu c_v^2 / (2 s_v)] with
    c_v = (|e_v|^2 - s_v^2) / (2 s_v). `base_gradient` (n_v, 3) is grad A at the base,
    `tension` (n_b,) is lambda_v + mu c_v / s_v there. As a difference the value keeps its
    relative precision however small u is, which is what lets a line search finish.
    """
    gradient[:] = base_gradient
    value = film_energy_gradient(u, edges, weights, gradient)
    value += bending_energy_gradient(u, loop, rest_lengths, gradient)
    for i in range(u.shape[0]):
        for d in range(3):
            value += base_gradient[i, d] * u[i, d]
    n = loop.shape[0]
    for v in range(n):
        i, j = loop[v], loop[(v + 1) % n]
        s = rest_lengths[v]
        cross, square = 0.0, 0.0
        for d in range(3):
            chord, step = base[j, d] - base[i, d], u[j, d] - u[i, d]
            cross += chord * step
            square += step * step
        change = (cross + 0.5 * square) / s
        value += tension[v] * 0.5 * square / s + 0.5 * penalty * change * change / s
        pull = penalty * change / s
        for d in range(3):
            chord, step = base[j, d] - base[i, d], u[j, d] - u[i, d]
            force = (tension[v] * step + pull * (chord + step)) / s
            gradient[j, d] += force
            gradient[i, d] -= force
    return value


@njit(cache=True)
def _side(x: FloatArray, i: int, j: int) -> Vector:
    return x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[j, 2] - x[i, 2]


@njit(cache=True)
def _sum(a: Vector, factor: float, b: Vector) -> Vector:
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]


@njit(cache=True)
def _dot(a: Vector, b: Vector) -> float:
    product: float = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return product


@njit(cache=True)
def _cross(a: Vector, b: Vector) -> Vector:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


@njit(cache=True)
def area_beyond_linear(
    u: FloatArray, base: FloatArray, triangles: IntArray, gradient: FloatArray
) -> float:
    """Return A(base + u) - A(base) - grad A . u; add the gradient of that to `gradient`.

    A is the area of the triangles. With c and c + d twice the vector area of one, d = d1 +
    d2 linear and quadratic in u, S = |c + d| + |c| and g = |c + d| - |c| = d.(2 c + d) / S,

        2 (A(u) - A(0) - grad A . u) = (2 c . d2 + |d|^2 - g c . d1 / |c|) / S,

    every term of second order: nothing cancels, however small u is. A triangle without an
    area is left out. u, base, gradient : (n_v, 3); triangles : (n_t, 3).
    """
    value = 0.0
    for t in range(triangles.shape[0]):
        i, j, k = triangles[t]
        p, q, v, w = _side(base, i, j), _side(base, i, k), _side(u, i, j), _side(u, i, k)
        c, second = _cross(p, q), _cross(v, w)
        first = _sum(_cross(v, q), 1.0, _cross(p, w))
        d = _sum(first, 1.0, second)
        moved = _sum(c, 1.0, d)
        size, after = np.sqrt(_dot(c, c)), np.sqrt(_dot(moved, moved))
        if size == 0.0 or after == 0.0:
            continue
        total = size + after
        gain = (2.0 * _dot(c, d) + _dot(d, d)) / total
        linear = _dot(c, first) / size
        value += 0.5 * (2.0 * _dot(c, second) + _dot(d, d) - gain * linear) / total
        # With n = c / |c| grad_j A = (x_k - x_i) x n / 2; n turns by (d - g n) / |c + d|.
        turn = _sum(d, -gain / size, c)
        at_j = _sum(_cross(w, c), size / after, _cross(_sum(q, 1.0, w), turn))
        at_k = _sum(_cross(c, v), size / after, _cross(turn, _sum(p, 1.0, v)))
        for axis in range(3):
            gradient[j, axis] += 0.5 * at_j[axis] / size
            gradient[k, axis] += 0.5 * at_k[axis] / size
            gradient[i, axis] -= 0.5 * (at_j[axis] + at_k[axis]) / size
    return value


@njit(cache=True)
def strands_within(x: FloatArray, reach: float, apart: int) -> bool:
    """Whether vertices of a loop at least `apart` edges from each other are within reach.

    A vertex at the distance d is followed by others at less than `reach` only after
    (d - reach) / (longest edge) edges, which are left out. x : (n, d), cyclic.
    """
    n = x.shape[0]
    longest = 0.0
    for v in range(n):
        longest = max(longest, _squared_distance(x, v, (v + 1) % n))
    longest = np.sqrt(longest)
    for v in range(n):
        u = v + apart
        while u <= v + n - apart and u < n:
            distance = np.sqrt(_squared_distance(x, v, u))
            if distance < reach:
                return True
            ahead = (distance - reach) / longest if longest > 0.0 else 0.0
            u += max(1, int(min(ahead, float(n))))
    return False


@njit(cache=True)
def _squared_distance(x: FloatArray, i: int, j: int) -> float:
    square = 0.0
    for d in range(x.shape[1]):
        square += (x[i, d] - x[j, d]) ** 2
    return square
