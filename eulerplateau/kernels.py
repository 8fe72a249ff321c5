"""Compiled loops: energies and gradients of film and loop. Arrays in, arrays out.

Every energy here is quadratic or, for the lengths, quartic in the positions, so the same
kernels give exact *differences* from a base point: Q(x0 + u) - Q(x0) = grad Q(x0).u + Q(u).
Numba does not notice when a helper in another module changes (numba #1833): kernels that
call each other stay in this file.
"""

from __future__ import annotations

from numba import njit

from eulerplateau.mesh import FloatArray, IntArray


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
