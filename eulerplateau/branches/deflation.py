"""Newton's method kept away from equilibria that are known, and other ways to saddles.

Deflation (Farrell, Birkisson and Funke 2015): the gradient g is multiplied by

    M(x) = prod_i (1 + 1 / d_i(x)^2),

d_i / L the distance to the nearest copy of the i-th known equilibrium (likeness.py). Where
M g vanishes g does, but Newton's method on M g is driven away from what is known. Its step
is Newton's own, p, times a number (Sherman and Morrison's formula),

    p / (1 - p . grad M / M).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.family import Family
from eulerplateau.branches.likeness import Likeness
from eulerplateau.branches.point import BranchPoint, point_near
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers import TangentModel, tangent_model

# R.m.s. lengths of steps, in units of L.
FIRST_RADIUS, SMALLEST_RADIUS, _LONGEST = 0.01, 1e-5, 0.1
STEPS = 40
# Residual below which a loop is next to an equilibrium.
NEXT = 1e-3
# A soap film made anew at its own shape so often agrees with it; L.
MADE_ANEW, AGREES = 8, 1e-6
# Of the largest: curvatures below are taken for this, lest a soft mode takes all of a step.
_SOFT = 1e-6

Step = Callable[[TangentModel], FloatArray]


def factor(slopes: Sequence[float], squares: Sequence[float]) -> float:
    """Return by what deflation multiplies Newton's step.

    slopes : of the known equilibria's squared distances along that step
    squares : these squared distances, in units of L^2
    """
    down = sum(
        slope / (square * (square + 1))
        for slope, square in zip(slopes, squares, strict=True)
    )
    return 1 / (1 + down) if down != -1 else np.inf


def deflated(known: Sequence[FloatArray], likeness: Likeness) -> Step:
    """Return the step (m,) of Newton's method with loops (n, 3) divided out."""

    def step(model: TangentModel) -> FloatArray:
        plain = newton(model)
        moved = model.displacement(plain)
        apart = [likeness.difference(model.x, x) for x in known]
        slopes = [likeness.slope(one, moved) for one in apart]
        squares = [max(one.square, 1e-30) for one in apart]
        stretched: FloatArray = factor(slopes, squares) * plain
        return stretched

    return step


def newton(model: TangentModel) -> FloatArray:
    """Return the step (m,) of Newton's method."""
    return np.linalg.solve(model.hessian, -model.gradient).astype(np.float64, copy=False)


def towards_index(index: int) -> Step:
    """Return the step (m,) that climbs along so many of the softest modes.

    Along all others it descends: it comes to rest at equilibria of this index.
    """

    def step(model: TangentModel) -> FloatArray:
        values, vectors = model.eigen
        size = np.maximum(np.abs(values), _SOFT * np.abs(values).max())
        way = (vectors.T @ model.gradient) / size
        way[index:] *= -1
        climbed: FloatArray = vectors @ way
        return climbed

    return step


def first(steps: int, way: Step, then: Step) -> Step:
    """Return the step of one way for so many steps, and of another after them."""
    taken = itertools.count()

    def step(model: TangentModel) -> FloatArray:
        return way(model) if next(taken) < steps else then(model)

    return step


def search(family: Family, x: FloatArray, value: float, step: Step) -> BranchPoint | None:
    """Return the equilibrium to which steps lead from a loop x (n, d); None if to none.

    Steps are as long as the second-order model is right about the energy, which may rise.
    """
    radius = FIRST_RADIUS
    try:
        model = tangent_model(family.energy(value), x)
        for _ in range(STEPS):
            if model.residual < NEXT:
                return _made_anew(point_near(family, model.x, value))
            change = step(model)
            after = _trusted(family.energy(value), model, change, radius)
            if after is None:
                return None
            x, radius = after
            if not family.energy(value).holds(x):
                family = family.near(x)
            model = tangent_model(family.energy(value), x)
    except LinAlgError:  # no film on this loop, or no step
        return None
    return None


def _made_anew(point: BranchPoint | None) -> BranchPoint | None:
    """Return an equilibrium with its film known at its own shape; None if it gets lost."""
    for _ in range(MADE_ANEW):
        if point is None:
            return None
        family = point.family.near(point.x)
        if family is point.family:
            return point
        again = point_near(family, point.x, point.value)
        if again is not None and float(np.abs(again.x - point.x).max()) < AGREES:
            return again
        point = again
    return None


def _trusted(
    energy: LoopEnergy, model: TangentModel, change: FloatArray, radius: float
) -> tuple[FloatArray, float] | None:
    """Return the loop after a step (m,), as long as it can be trusted, and the next radius.

    None if no length can.
    """
    size = float(np.linalg.norm(change))
    if not np.isfinite(size) or size == 0:
        return None
    while radius > SMALLEST_RADIUS:
        part = min(1.0, radius / size) * change
        x = energy.constraint.project(model.x + model.displacement(part))
        if x is not None:
            moved = x - model.x
            trusted = wider(model, part, energy.change(model.x, moved), radius)
            if trusted is not None:
                # To the last bit where the change was asked for: a film is known there.
                return model.x + moved, trusted
        radius = 0.4 * min(size, radius)
    return None


def wider(
    model: TangentModel, part: FloatArray, gained: float, radius: float, noise: float = 0.0
) -> float | None:
    """Return the radius after a step (m,); None if the model was not right about it.

    It is if it errs by a small part of what the modes gain and lose, which may cancel, and
    by the `noise` of the energy that was gained.
    """
    first, second = model.gradient * part, 0.5 * part * (model.hessian @ part)
    promised = float(first.sum() + second.sum())
    off = max(abs(gained - promised) - noise, 0.0)
    error = off / max(float(np.abs(first).sum()), 1e-300)
    if not error < 0.2:
        return None
    return min(2 * radius, _LONGEST) if error < 0.05 else radius
