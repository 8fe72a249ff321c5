"""Compiled loops over the edges of a polygon, and over pairs of them: its writhe.

The writhe of a closed polygon is a sum over pairs of its edges: the directions in which two
of them are seen to cross cover a spherical quadrilateral, whose signed area over 2 pi is
what the pair adds (Banchoff 1976; Klenin and Langowski 2000). Edges that meet add nothing.

How it changes is local: modulo 2 it is the area over 2 pi that the unit tangents t_i,
joined by great arcs, enclose on the sphere, less 1 (Fuller 1978). So an edge e_i of length
s_i has

    2 pi dWr/de_i = (b_i + b_{i-1}) / s_i,     b_i = (t_{i+1} x t_i) / (1 + t_i . t_{i+1}).
"""

from __future__ import annotations

import math

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.compiling import njit

# Tangent of an angle that is small, and how many of them are less than pi.
_SMALL, _FEW = 0.1, 24


@njit(cache=True, inline="always")
def _solid_angle(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    """Return the signed area of a triangle of directions (Oosterom and Strackee 1983)."""
    la = math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])
    lb = math.sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2])
    lc = math.sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2])
    ab = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    bc = b[0] * c[0] + b[1] * c[1] + b[2] * c[2]
    ca = c[0] * a[0] + c[1] * a[1] + c[2] * a[2]
    volume = (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        + a[1] * (b[2] * c[0] - b[0] * c[2])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )
    return 2 * math.atan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)


@njit(cache=True)
def writhe(x: FloatArray) -> float:
    """Return the writhe of the closed polygon x (n, 3), right-handed crossings positive."""
    n = x.shape[0]
    total = 0.0
    # Small angles are summed as a product of 1 + i tan(angle), a few at a time.
    real, imaginary, few = 1.0, 0.0, 0
    for i in range(n - 2):
        j = i + 2
        # What is seen from both ends of edge i: directions to the ends of one edge more.
        ax, ay, az = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[j, 2] - x[i, 2]
        dx, dy, dz = x[j, 0] - x[i + 1, 0], x[j, 1] - x[i + 1, 1], x[j, 2] - x[i + 1, 2]
        a, d = (
            math.sqrt(ax * ax + ay * ay + az * az),
            math.sqrt(dx * dx + dy * dy + dz * dz),
        )
        ad = ax * dx + ay * dy + az * dz
        for j in range(i + 2, n if i > 0 else n - 1):
            k = (j + 1) % n
            bx, by, bz = x[k, 0] - x[i, 0], x[k, 1] - x[i, 1], x[k, 2] - x[i, 2]
            cx, cy, cz = x[k, 0] - x[i + 1, 0], x[k, 1] - x[i + 1, 1], x[k, 2] - x[i + 1, 2]
            b = math.sqrt(bx * bx + by * by + bz * bz)
            c = math.sqrt(cx * cx + cy * cy + cz * cz)
            ab, bc = ax * bx + ay * by + az * bz, bx * cx + by * cy + bz * cz
            ca = cx * ax + cy * ay + cz * az
            cd = cx * dx + cy * dy + cz * dz
            # Both triangles of the quadrilateral have the volume of the tetrahedron.
            volume = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz)
            volume += az * (bx * cy - by * cx)
            first = a * b * c + ab * c + bc * a + ca * b
            second = a * c * d + ca * d + cd * a + ad * c
            rise, run = volume * (first + second), first * second - volume * volume
            if abs(rise) < _SMALL * run:
                slope = rise / run
                real, imaginary = real - imaginary * slope, imaginary + real * slope
                few += 1
                if few == _FEW:
                    total += math.atan2(imaginary, real)
                    real, imaginary, few = 1.0, 0.0, 0
            else:
                total += math.atan2(rise, run)
            ax, ay, az, dx, dy, dz, a, d, ad = bx, by, bz, cx, cy, cz, b, c, bc
    return -(total + math.atan2(imaginary, real)) / math.pi


@njit(cache=True)
def tangent_area(before: FloatArray, after: FloatArray) -> float:
    """Return the area that the tangents of a polygon gain as its edges (n, 3) turn."""
    total = 0.0
    for area in tangent_areas(before, after).flat:
        total += area
    return total


@njit(cache=True)
def tangent_areas(before: FloatArray, after: FloatArray) -> FloatArray:
    """Return the parts of that at the vertex after each edge: of two triangles (n, 2)."""
    n = before.shape[0]
    areas = np.empty((n, 2))
    for i in range(n):
        j = (i + 1) % n
        areas[i, 0] = _solid_angle(before[i], after[j], before[j])
        areas[i, 1] = _solid_angle(before[i], after[i], after[j])
    return areas


@njit(cache=True)
def writhe_by_edges(edges: FloatArray, shares: FloatArray) -> FloatArray:
    """Return the derivative of the writhe by the edges (n, 3).

    What the vertex after each edge adds to it counts by its share (n,), 1 for the writhe.
    """
    n = edges.shape[0]
    slope = np.zeros((n, 3))
    tangent, length = _tangents(edges)
    binormal = _half_binormals(tangent)
    for i in range(n):
        for k in range(3):
            whole = shares[i] * binormal[i, k] + shares[i - 1] * binormal[i - 1, k]
            slope[i, k] = whole / (2 * math.pi * length[i])
    return slope


@njit(cache=True)
def writhe_second(edges: FloatArray, shares: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the second derivative of the writhe by the edges (n, 3).

    What the vertex after each edge adds to it counts by its share (n,), 1 for the writhe.
    Blocks (n, 3, 3): of each edge with itself, and of each edge with the next. With shares
    that differ those with itself are not symmetric, as directions across an edge cannot be
    carried everywhere without turning them: their symmetric part is the second derivative.
    """
    n = edges.shape[0]
    own, beside = np.zeros((n, 3, 3)), np.zeros((n, 3, 3))
    tangent, length = _tangents(edges)
    binormal = _half_binormals(tangent)
    for i in range(n):
        j = (i + 1) % n
        t, u, b, share = tangent[i], tangent[j], binormal[i], shares[i]
        width = 1 + t[0] * u[0] + t[1] * u[1] + t[2] * u[2]
        # How b changes as the first tangent turns, and as the second does.
        first, second = np.zeros((3, 3)), np.zeros((3, 3))
        for k in range(3):
            p, q = (k + 1) % 3, (k + 2) % 3
            first[p, q] -= u[k] / width
            first[q, p] += u[k] / width
            second[p, q] += t[k] / width
            second[q, p] -= t[k] / width
            for m in range(3):
                first[k, m] -= b[k] * u[m] / width
                second[k, m] -= b[k] * t[m] / width
        _across(first, t)
        _across(second, u)
        for k in range(3):
            for m in range(3):
                own[i, k, m] += share * first[k, m] / length[i] ** 2
                own[j, k, m] += share * second[k, m] / length[j] ** 2
                beside[i, k, m] += share * second[k, m] / (length[i] * length[j])
                # b lies across both tangents: what is left of it where an edge grows.
                own[i, k, m] -= share * b[k] * t[m] / length[i] ** 2
                own[j, k, m] -= share * b[k] * u[m] / length[j] ** 2
    return own / (2 * math.pi), beside / (2 * math.pi)


@njit(cache=True)
def add_edge_blocks(
    own: FloatArray, beside: FloatArray, factor: float, matrix: FloatArray
) -> None:
    """Add a second derivative by edges, times a factor, to one by positions (n, 3, n, 3).

    own, beside : (n, 3, 3), of each edge with itself, and with the next
    """
    n = own.shape[0]
    for i in range(n):
        j, beyond = (i + 1) % n, (i + 2) % n
        for k in range(3):
            for m in range(3):
                h = factor * own[i, k, m]
                matrix[i, k, i, m] += h
                matrix[j, k, j, m] += h
                matrix[i, k, j, m] -= h
                matrix[j, k, i, m] -= h
                h = factor * beside[i, k, m]
                # e_i = x_j - x_i and e_j = x_beyond - x_j.
                matrix[j, k, beyond, m] += h
                matrix[j, k, j, m] -= h
                matrix[i, k, beyond, m] -= h
                matrix[i, k, j, m] += h
                matrix[beyond, m, j, k] += h
                matrix[j, m, j, k] -= h
                matrix[beyond, m, i, k] -= h
                matrix[j, m, i, k] += h


@njit(cache=True)
def transported(tangents: FloatArray, first: FloatArray) -> FloatArray:
    """Return a direction across each edge (n, 3), none turned about it from the one before.

    tangents : (n, 3), unit; first : (3,), across the first edge
    """
    n = tangents.shape[0]
    found = np.empty((n, 3))
    found[0] = first
    for i in range(n - 1):
        # The least rotation that takes t to u, of what lies across t.
        t, u, d = tangents[i], tangents[i + 1], found[i]
        along = d[0] * u[0] + d[1] * u[1] + d[2] * u[2]
        width = 1 + t[0] * u[0] + t[1] * u[1] + t[2] * u[2]
        for k in range(3):
            found[i + 1, k] = d[k] - along * (t[k] + u[k]) / width
    return found


@njit(cache=True)
def _tangents(edges: FloatArray) -> tuple[FloatArray, FloatArray]:
    n = edges.shape[0]
    tangent, length = np.empty((n, 3)), np.empty(n)
    for i in range(n):
        e = edges[i]
        length[i] = math.sqrt(e[0] * e[0] + e[1] * e[1] + e[2] * e[2])
        for k in range(3):
            tangent[i, k] = e[k] / length[i]
    return tangent, length


@njit(cache=True)
def _half_binormals(tangent: FloatArray) -> FloatArray:
    """Return b_i (n, 3), minus half of the discrete curvature binormal."""
    n = tangent.shape[0]
    binormal = np.empty((n, 3))
    for i in range(n):
        t, u = tangent[i], tangent[(i + 1) % n]
        width = 1 + t[0] * u[0] + t[1] * u[1] + t[2] * u[2]
        for k in range(3):
            p, q = (k + 1) % 3, (k + 2) % 3
            binormal[i, k] = (u[p] * t[q] - u[q] * t[p]) / width
    return binormal


@njit(cache=True)
def _across(matrix: FloatArray, t: FloatArray) -> None:
    """Take from a matrix (3, 3) what it does along t: only turns of an edge count."""
    for k in range(3):
        along = matrix[k, 0] * t[0] + matrix[k, 1] * t[1] + matrix[k, 2] * t[2]
        for m in range(3):
            matrix[k, m] -= along * t[m]
