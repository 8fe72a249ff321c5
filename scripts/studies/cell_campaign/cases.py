"""Random cells: adhesions, contractility, stiffness, and a start, by a number."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.cells import Cell, Sites, crosses_itself, solve_cell
from eulerplateau.loop import edges_of
from eulerplateau.mesh import polygon_area

EDGES_PER_SIDE = 16
ADHESIONS = (3, 12)
STIFFNESS, CONTRACTILITY = (1.0, 1e4), (0.1, 500.0)
# Radii of the adhesions, in R0; the least gap between two that follow each other; how far
# a start is displaced, at most, in its mean edges.
_RADII, _GAP, _ROUGHNESS = (0.3, 1.0), 0.05, 3.0
_WAVES = 6


@dataclass(frozen=True)
class Outcome:
    """What a random cell came to.

    Attributes
    ----------
    status : str, of the equilibrium
    worst_turning : float, degrees at a vertex
    """

    number: int
    adhesions: int
    sigma_hat: float
    ks_hat: float
    status: str
    n_unstable: int | None
    residual: float
    iterations: int
    seconds: float
    worst_turning: float
    crossed: bool


def outcome(seed: int, number: int) -> Outcome:
    """Return what the random cell of this number comes to."""
    rng = np.random.default_rng((seed, number))
    cell = Cell(_sites(rng), EDGES_PER_SIDE)
    ks = _log_uniform(rng, STIFFNESS)
    low, high = CONTRACTILITY
    even = rng.random() < 0.5
    sigma = float(rng.uniform(low, high)) if even else _log_uniform(rng, CONTRACTILITY)
    found = solve_cell(cell, sigma, ks, _start(cell, rng))
    return Outcome(
        number,
        len(cell.sites.points),
        sigma,
        ks,
        found.status.value,
        found.n_unstable,
        found.residual,
        found.iterations,
        found.seconds,
        float(np.degrees(np.abs(edges_of(found.x).turning).max())),
        crosses_itself(found.x),
    )


def _log_uniform(rng: np.random.Generator, ends: tuple[float, float]) -> float:
    low, high = np.log(ends)
    return float(np.exp(rng.uniform(low, high)))


def _sites(rng: np.random.Generator) -> Sites:
    """Return adhesions at random angles and radii, equally stiff half of the time."""
    n = int(rng.integers(ADHESIONS[0], ADHESIONS[1] + 1))
    while True:
        angle = np.sort(rng.uniform(0, 2 * np.pi, n))
        radius = rng.uniform(*_RADII, n)
        points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
        gaps = np.roll(points, -1, axis=0) - points
        apart = np.hypot(gaps[:, 0], gaps[:, 1]).min() > _GAP
        if apart and polygon_area(points) > 0 and not crosses_itself(points):
            break
    stiff = rng.uniform(0.2, 3.0, n) if rng.random() < 0.5 else np.ones(n)
    return Sites(points, stiff)


def _start(cell: Cell, rng: np.random.Generator) -> FloatArray:
    """Return arcs or lines, displaced at random: rough or in waves, as far as they may."""
    arcs = rng.random() < 0.5
    x = cell.round_start() if arcs else cell.straight_start()
    if crosses_itself(x):
        x = cell.straight_start()
    size = rng.uniform(0, _ROUGHNESS) * cell.edge
    moved = rng.standard_normal(x.shape)
    if rng.random() < 0.5:
        t = 2 * np.pi * np.arange(cell.size) / cell.size
        waves = range(1, _WAVES + 1)
        basis = np.column_stack([f(k * t) / k for k in waves for f in (np.cos, np.sin)])
        moved = basis @ rng.standard_normal((2 * _WAVES, 2))
    while True:
        start: FloatArray = x + size * moved
        if _accepted(cell, start):
            return start
        size *= 0.8


def _accepted(cell: Cell, start: FloatArray) -> bool:
    """Return whether a loop (n, 2) can be started from: it does not cross itself."""
    if crosses_itself(start):
        return False
    equal = cell.energy(0.0, 1.0).constraint.project(start)
    return equal is not None and not crosses_itself(equal)
