"""Compiled loops over a rod's cross-sections: how they settle along a loop that is given.

Turned by angles psi_i about their edges they have the energy

    sum_i p_i cos psi_i + q_i sin psi_i + (1/2) sum_i c_i (m_i + psi_{i+1} - psi_i)^2,

the first of a natural curvature that wants to lie in the plane of the loop's own, the
second of twist, a chain of springs that is closed. How a frame is carried to a loop near
by, without turning about its edges, is here too.
"""

from __future__ import annotations

import math

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.compiling import njit

_STEPS = 1000
# Radians: Newton's method is not believed to go farther in a step.
_FAR = 0.5
# A pivot of so much of the largest is none: the frame turns as a whole for nothing.
_NOTHING = 1e-13


@njit(cache=True)
def settle(
    p: FloatArray, q: FloatArray, springs: FloatArray, twists: FloatArray, psi: FloatArray
) -> bool:
    """Take angles psi (n,) down to a minimum; return whether they are at one.

    By Newton's method where that is near one. Else by the same with as much added to the
    stiffness as makes the energy fall, which twice the size of the cosines does: no such
    step goes up. False at an equilibrium that is no minimum, from which nothing leads down.

    Parameters
    ----------
    p, q, springs, twists : (n,) float, p_i, q_i, c_i and m_i; n is 3 at least
    """
    size = np.sqrt(p * p + q * q)
    slope = _slope(p, q, springs, twists, psi)
    left = np.abs(slope).max()
    rounding = 1e-15 * (springs.max() * (np.abs(psi).max() + 1) + size.max())
    least = 1e-9 * size.max()
    added = 1e-3 * size.max() + least
    for _ in range(_STEPS):
        curvature = -p * np.cos(psi) - q * np.sin(psi)
        step = -slope
        stable = solve_chain(curvature, springs, step)
        if left <= rounding:
            return stable
        close = stable and np.abs(step).max() < _FAR
        if close:
            trial = psi + step
            after = _slope(p, q, springs, twists, trial)
            reached = np.abs(after).max()
            if reached > 0.5 * left:
                # Rounding stops Newton's method, or it is not as near as it seemed.
                if reached < 1e6 * rounding:
                    return True
                close = False
        if not close:
            energy, falls = _energy(p, q, springs, twists, psi), False
            while not falls:
                step = -slope
                trial, surely = psi, added >= 2 * size.max()
                definite = solve_chain(curvature + added, springs, step)
                if definite and (surely or np.abs(step).max() < _FAR):
                    trial = psi + step
                falls = surely or _energy(p, q, springs, twists, trial) < energy
                added *= 8
            added = max(added / 64, least)
            after = _slope(p, q, springs, twists, trial)
            reached = np.abs(after).max()
        psi[:], slope, left = trial, after, reached
    return False


@njit(cache=True)
def solve_chain(own: FloatArray, springs: FloatArray, rhs: FloatArray) -> bool:
    """Replace rhs (n,) by T^-1 rhs; return whether T is positive definite, to rounding.

    T is diag(own) and the closed chain of springs (n,), of which c_i joins i to i + 1. The
    last unknown is a border; where a pivot is negative rhs is lost.
    """
    n = len(rhs)
    pivot, border = np.empty(n), np.zeros(n)
    least = _NOTHING * springs.max()
    border[0] = -springs[n - 1]
    border[n - 2] -= springs[n - 2]
    last, right = own[n - 1] + springs[n - 1] + springs[n - 2], rhs[n - 1]
    for i in range(n - 1):
        pivot[i] = own[i] + springs[i] + springs[i - 1]
        if i > 0:
            ratio = -springs[i - 1] / pivot[i - 1]
            pivot[i] += ratio * springs[i - 1]
            rhs[i] -= ratio * rhs[i - 1]
            border[i] -= ratio * border[i - 1]
        if not pivot[i] > 0.0:
            return False
        last -= border[i] * border[i] / pivot[i]
        right -= border[i] * rhs[i] / pivot[i]
    if last < -n * least:
        return False
    rhs[n - 1] = right / max(last, least)
    for i in range(n - 2, -1, -1):
        rhs[i] -= border[i] * rhs[n - 1]
        if i < n - 2:
            rhs[i] += springs[i] * rhs[i + 1]
        rhs[i] /= pivot[i]
    return True


@njit(cache=True)
def _slope(
    p: FloatArray, q: FloatArray, springs: FloatArray, twists: FloatArray, psi: FloatArray
) -> FloatArray:
    """Return the derivative (n,) of the energy by the angles."""
    n = len(psi)
    slope = np.empty(n)
    before = springs[n - 1] * (twists[n - 1] + psi[0] - psi[n - 1])
    for i in range(n):
        moment = springs[i] * (twists[i] + psi[(i + 1) % n] - psi[i])
        turned = q[i] * math.cos(psi[i]) - p[i] * math.sin(psi[i])
        slope[i] = turned + before - moment
        before = moment
    return slope


@njit(cache=True)
def _energy(
    p: FloatArray, q: FloatArray, springs: FloatArray, twists: FloatArray, psi: FloatArray
) -> float:
    """Return the energy of angles."""
    n, total = len(psi), 0.0
    for i in range(n):
        twist = twists[i] + psi[(i + 1) % n] - psi[i]
        total += p[i] * math.cos(psi[i]) + q[i] * math.sin(psi[i])
        total += 0.5 * springs[i] * twist * twist
    return total


@njit(cache=True)
def carried(before: FloatArray, after: FloatArray, directors: FloatArray) -> FloatArray:
    """Return directors (n, 3) carried to other tangents without turning about them.

    before, after : (n, 3) float, unit tangents, none of them turned back
    """
    found = np.empty_like(directors)
    for i in range(len(directors)):
        t, u, d = before[i], after[i], directors[i]
        along = d[0] * u[0] + d[1] * u[1] + d[2] * u[2]
        width = 1 + t[0] * u[0] + t[1] * u[1] + t[2] * u[2]
        for k in range(3):
            found[i, k] = d[k] - along * (t[k] + u[k]) / width
    return found


@njit(cache=True)
def turned(tangents: FloatArray, directors: FloatArray, angles: FloatArray) -> FloatArray:
    """Return directors (n, 3) turned about unit tangents (n, 3) by angles (n,)."""
    found = np.empty_like(directors)
    for i in range(len(directors)):
        t, d = tangents[i], directors[i]
        cosine, sine = math.cos(angles[i]), math.sin(angles[i])
        for k in range(3):
            p, q = (k + 1) % 3, (k + 2) % 3
            found[i, k] = cosine * d[k] + sine * (t[p] * d[q] - t[q] * d[p])
    return found
