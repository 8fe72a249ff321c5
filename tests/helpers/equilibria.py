"""Equilibria of every kind, stable or not, and what the tests compare them with."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film import Stiffness
from eulerplateau.film.plane import PolygonArea
from eulerplateau.loop import Loop, LoopEnergy, free_motions, inextensible
from eulerplateau.mesh.shape import Shape
from eulerplateau.solvers import (
    Equilibrium,
    Problem,
    Status,
    TangentModel,
    solve,
    tangent_model,
)


def loop_energy(problem: Problem, load: float, near: Shape | None = None) -> LoopEnergy:
    """The energy of the loop alone, the film at rest near a shape, by default the disk."""
    film = problem.film.of_loop(problem.disk.shape if near is None else near)
    return film.energy(problem.loop, load)


def spanned(problem: Problem, x_loop: FloatArray) -> Shape:
    """The film at rest on a loop (n_b, 3), near the disk."""
    return problem.film.of_loop(problem.disk.shape).shape(x_loop)


def quadratic_energy(loop: Loop, film: FloatArray | None = None) -> LoopEnergy:
    """Bending, and a film whose energy has the second derivatives (n_b, n_b), or none."""
    n = len(loop.rest_lengths)
    term = Stiffness(np.zeros((n, n)) if film is None else 0.5 * film, 1.0)
    return inextensible(loop, term, partial(free_motions, loop, slides=False))


def energy_in_plane(loop: Loop, load: float) -> LoopEnergy:
    """Bending, and the area of the polygon (n_b, 2) under a tension."""
    motions = partial(free_motions, loop, slides=True)
    return inextensible(loop, PolygonArea(load), motions)


def critical_point(energy: LoopEnergy, x_loop: FloatArray) -> TangentModel:
    """Newton's method without a trust region: to the nearest equilibrium, of any index.

    From a flat loop it stays in the plane.
    """
    model = tangent_model(energy, x_loop)
    for _ in range(60):
        if model.residual <= max(10 * model.rounding, 1e-12):
            return model
        step = model.displacement(np.linalg.solve(model.hessian, -model.gradient))
        longest = np.linalg.norm(step, axis=1).max()
        x = energy.constraint.project(model.x + step * min(1.0, 0.01 / longest))
        assert x is not None
        model = tangent_model(energy, x)
    raise AssertionError("no equilibrium reached")


def planar(problem: Problem, loads: Iterable[float]) -> list[TangentModel]:
    """The planar equilibria of ascending loads, each from the last, stable or not.

    The first load has to be one at which the film stays in the plane.
    """
    loads = list(loads)
    start = solve(problem, loads[0], problem.disk.shape)
    x = start.shape.x_loop * [1.0, 1.0, 0.0]
    found = []
    for load in loads:
        found.append(critical_point(loop_energy(problem, load), x))
        x = found[-1].x
    return found


def ring(n: int) -> tuple[Loop, FloatArray]:
    """A regular n-gon of length 1 in the plane z = 0, and its rest lengths."""
    angle = 2 * np.pi * np.arange(n) / n
    x = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    return Loop(np.full(n, 1 / n)), x / (2 * n * np.sin(np.pi / n))


def assert_same_bits(one: Equilibrium, two: Equilibrium) -> None:
    """Every number of two equilibria, but for the time they took."""
    others = {"shape": None, "stability": None, "seconds": None}
    numbers = [
        {**vars(found), **vars(found.shape), **vars(found.stability), **others}
        for found in (one, two)
    ]
    assert numbers[0].keys() == numbers[1].keys()
    for name, value in numbers[0].items():
        np.testing.assert_array_equal(numbers[1][name], value, err_msg=name)


def turning(x_loop: FloatArray) -> float:
    """The largest angle, in degrees, between consecutive edges of a loop (n_b, 3)."""
    edges = np.roll(x_loop, -1, axis=0) - x_loop
    edges = edges / np.linalg.norm(edges, axis=1, keepdims=True)
    chords = np.linalg.norm(edges - np.roll(edges, 1, axis=0), axis=1)
    return float(np.degrees(2 * np.arcsin(np.minimum(chords.max() / 2, 1.0))))


def verdict(x_loop: FloatArray) -> Status:
    """What the status of an equilibrium has to be: is its loop (n_b, 3) fine enough?"""
    return Status.UNRESOLVED if turning(x_loop) > 30 else Status.CONVERGED


def distance_up_to_motion(x: FloatArray, y: FloatArray) -> float:
    """Largest distance of two shapes (n, 3) after the best rotation or reflection."""
    a, b = x - x.mean(axis=0), y - y.mean(axis=0)
    u, _, v = np.linalg.svd(a.T @ b)
    return float(np.linalg.norm(a @ (u @ v) - b, axis=1).max())
