"""Polygons in the plane, and how derivatives of a term are tested on them."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Term


def uneven(n: int, seed: int) -> FloatArray:
    """A star-shaped polygon (n, 2), counter-clockwise, with uneven edges and turning."""
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * (np.arange(n) + 0.3 * rng.uniform(-1, 1, n)) / n
    radius = rng.uniform(0.7, 1.3, n)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def turned(x: FloatArray, angle: float) -> FloatArray:
    """The polygon turned about the origin."""
    c, s = np.cos(angle), np.sin(angle)
    return x @ np.array([[c, s], [-s, c]])


def order(sizes: list[float], errors: list[float]) -> float:
    """The exponent fitted to errors that fall like a power of a size."""
    return float(np.polyfit(np.log(sizes), np.log(np.abs(errors)), 1)[0])


def remainders(term: Term, x: FloatArray, step: FloatArray) -> tuple[float, float]:
    """Orders in h of change - h g.u and of change - h g.u - h^2 u.H u / 2."""
    hessian = term.hessian(x)
    if len(hessian) == len(x):
        hessian = np.kron(hessian, np.eye(x.shape[1]))
    slope, bend = np.vdot(term.force(x), step), step.ravel() @ hessian @ step.ravel()
    sizes = [0.01 * 0.5**k for k in range(4)]
    first = [term.change(x, h * step) - h * slope for h in sizes]
    second = [f - 0.5 * h * h * bend for f, h in zip(first, sizes, strict=True)]
    return order(sizes, first), order(sizes, second)
