"""Plain NumPy twins of the compiled kernels, written from the formulas alone.

Gradients are checked against the energies by Taylor's theorem; here are only the energies.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh.disk import Disk

Field = Callable[[FloatArray], tuple[float, FloatArray]]


def film_energy(mesh: Disk, x: FloatArray, load: float) -> float:
    """k sum |e|^2 over the edges that are not on the loop."""
    pairs = {tuple(sorted(pair)) for t in mesh.triangles.tolist() for pair in _sides(t)}
    pairs -= {tuple(sorted(pair)) for pair in _sides(mesh.loop.tolist())}
    i, j = np.array(sorted(pairs)).T
    return float(load * ((x[i] - x[j]) ** 2).sum())


def bending_energy(mesh: Disk, x: FloatArray) -> float:
    """sum_v <s_v> kappa_v^2 with kappa_v = |t_v - t_{v-1}| / <s_v>, t_v = e_v / s_v."""
    s = mesh.rest_lengths
    mean = (s + np.roll(s, 1)) / 2
    t = _chords(mesh, x) / s[:, None]
    kappa = np.linalg.norm(t - np.roll(t, 1, axis=0), axis=1) / mean
    return float((mean * kappa**2).sum())


def constraint(mesh: Disk, x: FloatArray) -> FloatArray:
    """c_v = (|e_v|^2 - s_v^2) / (2 s_v)."""
    s = mesh.rest_lengths
    return ((_chords(mesh, x) ** 2).sum(axis=1) - s**2) / (2 * s)


def lagrangian(
    mesh: Disk, x: FloatArray, load: float, tensions: FloatArray, penalty: float
) -> float:
    """Film, bending, sum_v lambda_v c_v and sum_v mu c_v^2 / (2 s_v)."""
    c = constraint(mesh, x)
    held = tensions @ c + penalty * (c**2 / (2 * mesh.rest_lengths)).sum()
    return film_energy(mesh, x, load) + bending_energy(mesh, x) + float(held)


def taylor_slope(field: Field, x: FloatArray, direction: FloatArray) -> float:
    """Order of E(x + t p) - E(x) - t grad E . p in t: 2 where the gradient is right."""
    value, gradient = field(x)
    steps = np.geomspace(1e-1, 1e-3, 9)
    leftover = [
        field(x + t * direction)[0] - value - t * np.vdot(gradient, direction)
        for t in steps
    ]
    return float(np.polyfit(np.log(steps), np.log(np.abs(leftover)), 1)[0])


def _chords(mesh: Disk, x: FloatArray) -> FloatArray:
    around = x[mesh.loop]
    return np.roll(around, -1, axis=0) - around


def _sides(cycle: list[int]) -> list[tuple[int, int]]:
    return list(zip(cycle, cycle[1:] + cycle[:1], strict=True))


def writhe(x: FloatArray) -> float:
    """Gauss's double integral over pairs of edges, by quadrature on both: slow."""
    places, shares = np.polynomial.legendre.leggauss(40)
    places, shares, n = 0.5 + 0.5 * places, 0.5 * shares, len(x)
    total = 0.0
    for i in range(n):
        for j in range(i + 2, n if i > 0 else n - 1):
            first, second = x[(i + 1) % n] - x[i], x[(j + 1) % n] - x[j]
            apart = (x[i] - x[j])[:, None, None] + (
                first[:, None, None] * places[:, None] - second[:, None, None] * places
            )
            seen = np.tensordot(np.cross(first, second), apart, 1)
            seen /= np.linalg.norm(apart, axis=0) ** 3
            total += float(shares @ seen @ shares)
    return total / (2 * np.pi)
