"""The loads at which a disk loses its stability, on a mesh: roots of an eigenvalue."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers import Problem, TangentModel, tangent_model

# Loads to start the secant from, whatever the film.
_FIRST, _SECOND = 1000.0, 3000.0
_PRECISION = 1e-9


def disk_threshold(problem: Problem, transverse: bool) -> tuple[float, int]:
    """Return the load where the disk buckles, and how many loads were looked at.

    `transverse` asks for the mode out of the plane, otherwise for the one within.
    """
    rest = problem.disk.shape
    x = rest.x_loop
    energy = partial(problem.film.of_loop(rest).energy, problem.loop)

    def lowest(load: float) -> float:
        nonlocal x
        model = _planar(energy, x, load)
        x = model.x
        values, vectors = model.eigen
        moved = (model.basis @ vectors).reshape(len(x), 3, -1)
        across = (moved[:, 2] ** 2).sum(axis=0) > 0.5
        return float(values[across == transverse][0])

    return _secant(lowest)


def _planar(
    energy_at: Callable[[float], LoopEnergy], x: FloatArray, load: float
) -> TangentModel:
    """Newton's method from a flat loop (n_b, 3), which stays flat, stable or not."""
    energy = energy_at(load)
    model = tangent_model(energy, x)
    for _ in range(20):
        if model.residual <= max(10 * model.rounding, 1e-12):
            return model
        step = np.asarray(np.linalg.solve(model.hessian, -model.gradient), dtype=np.float64)
        moved: FloatArray = model.x + model.displacement(step)
        after = energy.constraint.project(moved)
        if after is None:
            break
        model = tangent_model(energy, after * (1.0, 1.0, 0.0))
    raise ArithmeticError(f"no planar disk at load {load:g}")


def _secant(function: Callable[[float], float]) -> tuple[float, int]:
    a, b = _FIRST, _SECOND
    f, g = function(a), function(b)
    for count in range(3, 20):
        a, b, f = b, b - g * (b - a) / (g - f), g
        if abs(b - a) <= _PRECISION * abs(b):
            return b, count - 1
        g = function(b)
    raise ArithmeticError("the eigenvalue's root was not found")
