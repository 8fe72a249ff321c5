"""Triangulated disks and surfaces for tests, built without a mesher."""

from __future__ import annotations

from functools import cache

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.mesh.disk import Disk


@cache
def hexagon_points(rings: int) -> tuple[FloatArray, IntArray]:
    """Triangular lattice in a regular hexagon of circumradius 1, corners at (±1, 0), ...

    Returns points (3 rings (rings + 1) + 1, 2), ring after ring from the centre, and
    counter-clockwise triangles (6 rings², 3); made once, they cannot be written to.
    """
    turns = np.linspace(0.0, 2.0 * np.pi, 7)
    corner = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    points = [(0.0, 0.0)]
    triangles = []
    for ring in range(1, rings + 1):
        inner, outer = 1 + 3 * (ring - 1) * (ring - 2), 1 + 3 * ring * (ring - 1)
        inner = 0 if ring == 1 else inner
        around, within = 6 * ring, max(6 * (ring - 1), 1)
        for k in range(6):
            for i in range(ring):
                points.append(
                    tuple(corner[k] * (ring - i) + corner[k + 1] * i) / np.array(rings)
                )
                here = inner + (k * (ring - 1) + i) % within
                left = outer + (k * ring + i + 1) % around
                triangles.append((here, outer + k * ring + i, left))
                if i < ring - 1:
                    triangles.append(
                        (here, left, inner + (k * (ring - 1) + i + 1) % within)
                    )
    made = np.array(points), np.array(triangles)
    for array in made:
        array.flags.writeable = False
    return made


def disk_points(rings: int, jitter: float = 0.0) -> tuple[FloatArray, IntArray]:
    """Unit disk of concentric rings, 6 j vertices on ring j; vertices optionally displaced.

    `jitter` is a fraction of the edge length; loop vertices slide along the circle.
    """
    _, triangles = hexagon_points(rings)
    ring = np.concatenate(
        [[0], np.repeat(np.arange(1, rings + 1), 6 * np.arange(1, rings + 1))]
    )
    place = np.concatenate([[0], *(np.arange(6 * j) for j in range(1, rings + 1))])
    noise = jitter / rings * np.random.default_rng(3).uniform(-1.0, 1.0, (2, len(ring)))
    radius = ring / rings
    angle = 2.0 * np.pi * place / np.maximum(6 * ring, 1)
    angle += noise[0] / np.maximum(radius, 1.0 / rings)
    radius = np.where(ring == rings, 1.0, radius + noise[1])
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1), triangles


def sliver(thickness: float, shape: str) -> tuple[FloatArray, IntArray]:
    """A disk with one triangle split at a point so near its side, or its corner."""
    points, shared = disk_points(4)
    triangles, number = shared.copy(), 20
    i, j, k = triangles[number]
    near = 0.5 * (points[i] + points[j]) if shape == "cap" else points[i]
    far = points[k] if shape == "cap" else 0.5 * (points[j] + points[k])
    new = len(points)
    triangles[number] = i, j, new
    split = np.vstack([triangles, [[j, k, new], [k, i, new]]])
    return np.vstack([points, near + thickness * (far - near)]), split


def flat(points: FloatArray) -> FloatArray:
    """Points (n, 2) as positions (n, 3) in the plane z = 0."""
    return np.column_stack([points, np.zeros(len(points))])


def enneper(points: FloatArray, radius: float) -> FloatArray:
    """Enneper's minimal surface over the disk of that radius; `points` in the unit disk.

    With R the radius: integral of K dA = -4 pi R²/(1 + R²), and on the boundary at angle φ
    kappa_n ds = ∓2 R cos 2φ/(1 + R²) dφ. It cuts through itself for R > √3.
    """
    u, v = radius * points.T
    return np.column_stack([u - u**3 / 3 + u * v**2, v - v**3 / 3 + u**2 * v, u**2 - v**2])


def eight(points: FloatArray, t: float) -> FloatArray:
    """The family of eq. eight with R = 1."""
    a, b = points.T
    return np.column_stack([(1 + t * t) * a, (1 - t * t) * b, 2.0 * t * a * b])


def cap(points: FloatArray, opening: float) -> FloatArray:
    """Cap of the unit sphere about +z, from the pole to polar angle `opening`."""
    radius = np.hypot(*points.T)
    polar = opening * radius
    spread = np.sin(polar) / np.where(radius > 0.0, radius, 1.0)
    return np.column_stack([spread[:, None] * points, np.cos(polar)])


def mesh_of(points: FloatArray, triangles: IntArray) -> Disk:
    """Disk of points in the plane (n, 2) or in space (n, 3)."""
    return Disk.from_triangles(flat(points) if points.shape[1] == 2 else points, triangles)


@cache
def fan(edges: int) -> Disk:
    """A disk of triangles about its middle: of a film in its plane only the loop counts."""
    turns, k = 2 * np.pi * np.arange(edges) / edges, np.arange(edges)
    ring = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    triangles = np.stack([0 * k, 1 + k, 1 + (k + 1) % edges], axis=1)
    return mesh_of(np.concatenate([np.zeros((1, 2)), ring]), triangles)


def crumpled(mesh: Disk, size: float) -> FloatArray:
    """Rest positions of `mesh` plus seeded normal noise of standard deviation `size`."""
    return mesh.x + size * np.random.default_rng(5).standard_normal(mesh.x.shape)


def wave(n: int, size: float) -> FloatArray:
    """A smooth displacement (n, 3) of a loop, without symmetry, of at most this size."""
    turns = 2 * np.pi * np.arange(n) / n
    modes = np.stack([f(k * turns) for k in (2, 3) for f in (np.cos, np.sin)], axis=1)
    shape: FloatArray = modes @ np.random.default_rng(6).standard_normal((4, 3))
    return size * shape / np.linalg.norm(shape, axis=1).max()


def rotation() -> FloatArray:
    """A proper rotation (3, 3) about no special axis."""
    q, r = np.linalg.qr(np.random.default_rng(7).standard_normal((3, 3)))
    q = q * np.sign(np.diag(r))
    return q * np.sign(np.linalg.det(q))


def fitted_order(sizes: list[float], errors: list[float]) -> float:
    """Slope of log |error| against log size, by least squares."""
    return float(np.polyfit(np.log(sizes), np.log(np.abs(errors)), 1)[0])
