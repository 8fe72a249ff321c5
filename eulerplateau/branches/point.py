"""Points of a branch: equilibria, corrected inside a hyperplane (continuation.py)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.control import Direction, StepControl
from eulerplateau.branches.family import Family
from eulerplateau.interruption import heed
from eulerplateau.lapack import dgelsy, dgeqrf, dormqr
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers import (
    RESIDUAL_TOLERANCE,
    Stability,
    TangentModel,
    stability,
    tangent_model,
)

_CORRECTIONS = 12
NOISE = 1e-10  # relative singular value below which forces are rounding
_COLUMNS = 32  # of LAPACK's blocks


@dataclass(frozen=True)
class BranchPoint:
    """An equilibrium on a branch, the branch's direction there, and its stability.

    Attributes
    ----------
    family : the energies it belongs to; made anew where a soap film has turned
    value : float, of the family's parameter
    """

    family: Family
    model: TangentModel
    value: float
    direction: Direction
    arclength: float
    corrections: int

    @property
    def x(self) -> FloatArray:
        """Loop positions (n, d)."""
        return self.model.x

    @property
    def energy(self) -> LoopEnergy:
        """The energy of which it is an equilibrium."""
        return self.family.energy(self.value)

    @property
    def stability(self) -> Stability:
        """Spectrum of the second variation."""
        return stability(self.model)


def first_point(
    family: Family, x: FloatArray, value: float, control: StepControl
) -> BranchPoint:
    """Return the branch point at an equilibrium x (n, d), heading for higher values."""
    energy = family.energy(value)
    model = tangent_model(energy, x)
    upwards = Direction(np.zeros_like(x), control.unit)
    direction = _tangent(family, energy, model, upwards, control)
    return BranchPoint(family, model, value, direction, 0.0, 0)


def point_on(
    family: Family, x: FloatArray, value: float, last: Direction, control: StepControl
) -> BranchPoint | None:
    """Return the branch point next to one of another family, turned the way of `last`.

    It is all but an equilibrium; it is corrected across its own direction. None if lost.
    """
    energy = family.energy(value)
    there = energy.constraint.project(x)
    if there is None:
        return None
    model = tangent_model(energy, there)
    way = _tangent(family, energy, model, last, control)
    return correct(family, there, value, way, control)


def _tangent(
    family: Family,
    energy: LoopEnergy,
    model: TangentModel,
    last: Direction,
    control: StepControl,
) -> Direction:
    """Return the direction of a branch at its point, turned the way of `last`."""
    slope = parameter_slope(family, energy, model)
    drift = parameter_drift(family, energy, model)
    return branch_direction(model, slope, last, control, drift)


def point_near(
    family: Family, x: FloatArray, value: float, least: float = 0.0
) -> BranchPoint | None:
    """Return the equilibrium at a value next to a loop x (n, d), stable or not; or None.

    least : as of a StepControl
    """
    control = StepControl((value, value), unit=max(value, 1.0), least=least)
    return correct(family, x, value, across_values(x, control.unit), control)


def across_values(x: FloatArray, unit: float) -> Direction:
    """Return the direction normal to which are all loops (n, d) of one value."""
    return Direction(np.zeros_like(x), unit)


def ahead(point: BranchPoint, value: float, least: float = 0.0) -> BranchPoint | None:
    """Return the equilibrium at a value near a point's own, along its branch; or None."""
    way = point.direction
    guess = point.x + (value - point.value) / way.rate * way.displacement
    return point_near(point.family, guess, value, least)


def along(point: BranchPoint, other: BranchPoint, control: StepControl) -> float:
    """Return how far `other` lies from `point` along the branch's direction there."""
    way = Direction(other.x - point.x, other.value - point.value)
    return inner(point.model, point.direction, way, control)


def inner(model: TangentModel, a: Direction, b: Direction, control: StepControl) -> float:
    """Return the product of two directions in which arclength is measured."""
    product = np.sum(a.displacement * b.displacement, axis=1)
    rate = a.rate * b.rate / control.unit**2
    return float(model.weights @ product) + rate


def correct(
    family: Family,
    guess: FloatArray,
    value: float,
    direction: Direction,
    control: StepControl,
    attempts: tuple[float, ...] = (0.0, NOISE),
) -> BranchPoint | None:
    """Return the equilibrium in the hyperplane through the guess normal to `direction`.

    Each of the attempts keeps still along singular vectors of relative value below it.
    """
    for smallest in attempts:
        found = _correct(family, guess, value, direction, control, smallest)
        if found is not None:
            return found
    return None


def _correct(
    family: Family,
    guess: FloatArray,
    value: float,
    direction: Direction,
    control: StepControl,
    smallest: float,
) -> BranchPoint | None:
    """Correct by Newton's method, still along singular vectors below `smallest`.

    Close to a bifurcation the Hessian hardly resists its critical mode: along it, rounding
    in the forces becomes motion, which a second attempt leaves out.
    """
    constraint = family.energy(value).constraint
    x = constraint.project(guess)
    best, guessed = np.inf, value
    for corrections in range(_CORRECTIONS):
        heed()
        if x is None or value <= control.least or not np.isfinite(value):
            return None
        try:
            energy = family.energy(value)
            model = tangent_model(energy, x)
            slope = parameter_slope(family, energy, model)
            drift = parameter_drift(family, energy, model)
        except LinAlgError:  # no film on this loop
            return None
        off = inner(model, direction, Direction(x - guess, value - guessed), control)
        settled = model.residual <= max(4 * model.rounding, 1e-13)
        stuck = model.residual < RESIDUAL_TOLERANCE**1.5 and model.residual > 0.5 * best
        if settled or stuck:
            tangent = branch_direction(model, slope, direction, control, drift)
            return BranchPoint(family, model, value, tangent, 0.0, corrections)
        best = min(best, model.residual)
        system = _bordered(model, slope, direction, control, drift)
        rhs = -np.append(model.gradient, off)
        try:
            shift = _solve(system, rhs, smallest)
        except LinAlgError:
            return None
        moved, more = model.displacement(shift[:-1]), float(shift[-1])
        value = value + more
        if drift is not None:
            moved = moved + more * drift
            constraint = family.energy(value).constraint
        x = constraint.project(x + moved)
    return None


def _solve(system: FloatArray, rhs: FloatArray, smallest: float) -> FloatArray:
    if smallest == 0.0:
        return np.linalg.solve(system, rhs).astype(np.float64)
    # By a QR that finds the rank; singular values would take ten times as long.
    n = len(rhs)
    free, room = np.zeros(n, dtype=np.int32), 3 * n + _COLUMNS * (n + 1)
    found: FloatArray = dgelsy(system, rhs[:, None], free, smallest, room)[1][:, 0]
    return found


def branch_direction(
    model: TangentModel,
    slope: FloatArray,
    last: Direction,
    control: StepControl,
    drift: FloatArray | None = None,
) -> Direction:
    """Return the branch's direction at an equilibrium, turned the way of `last`.

    `slope` (m,) is the model's parameter_slope, `drift` as of make_direction. The null
    vector of [H, b]: bordering by `last` would have to find one near `last`, also where a
    step has landed on a branch that crosses.
    """
    wide = np.column_stack([model.hessian, slope * control.unit])
    # The last column of the complete Q alone: of its reflections, what they make of one.
    m = len(slope)
    reflections, scales, _, _ = dgeqrf(wide.T, lwork=_COLUMNS * m)
    last_column = np.zeros((m + 1, 1))
    last_column[m] = 1.0
    null = dormqr("L", "N", reflections, scales, last_column, _COLUMNS)[0][:, 0]
    found = make_direction(model, null[:-1], null[-1] * control.unit, control, drift)
    return found if inner(model, found, last, control) >= 0 else found.reversed()


def make_direction(
    model: TangentModel,
    coefficients: FloatArray,
    rate: float,
    control: StepControl,
    drift: FloatArray | None = None,
) -> Direction:
    """Return the direction with these tangent coefficients, scaled to unit arclength.

    `drift` (n, d) is how the loop moves besides, per change of the parameter, where that
    changes what it is held to.
    """
    square = coefficients @ coefficients + (rate / control.unit) ** 2
    if drift is not None:
        # It is the least displacement, and across all that keep what the loop is held to.
        square += rate**2 * (model.weights @ np.sum(drift**2, axis=1))
    size = float(np.sqrt(square))
    moved = model.displacement(coefficients / size)
    if drift is not None:
        moved = moved + rate / size * drift
    return Direction(moved, rate / size)


def parameter_slope(family: Family, energy: LoopEnergy, model: TangentModel) -> FloatArray:
    """Return b = dg/dparameter (m,), g the model's gradient."""
    return model.slope(energy.pull(family.parameter, model.x, model.tensions))


def parameter_drift(
    family: Family, energy: LoopEnergy, model: TangentModel
) -> FloatArray | None:
    """Return the loop's drift (n, d) with the parameter; None where it has none."""
    return energy.bounds.drift(family.parameter, model.x)


def _bordered(
    model: TangentModel,
    slope: FloatArray,
    direction: Direction,
    control: StepControl,
    drift: FloatArray | None,
) -> FloatArray:
    """Return [[H, b], [normal^T, rate / unit^2]]: regular at folds, where H is not."""
    m = len(slope)
    system = np.empty((m + 1, m + 1))
    system[:m, :m] = model.hessian
    system[:m, m] = slope
    system[m, :m] = model.coefficients(direction.displacement)
    system[m, m] = direction.rate / control.unit**2
    if drift is not None:
        system[m, m] += model.weights @ np.sum(direction.displacement * drift, axis=1)
    return system
