"""Points of a branch: equilibria, corrected inside a hyperplane (continuation.py)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import project_lengths
from eulerplateau.solvers import (
    RESIDUAL_TOLERANCE,
    Problem,
    Stability,
    TangentModel,
    loop_energy,
    stability,
    tangent_model,
)

_CORRECTIONS = 12
NOISE = 1e-10  # relative singular value below which forces are rounding


@dataclass(frozen=True)
class Settings:
    """How a branch is followed.

    Attributes
    ----------
    load_range : the window of loads; a branch ends where it leaves it
    load_unit : float
        A change of the load by this much is as long as a displacement of 1 L (r.m.s.).
    first_step, largest_step, smallest_step : arclengths
    max_points : int, per branch
    """

    load_range: tuple[float, float]
    load_unit: float
    first_step: float = 5e-3
    largest_step: float = 0.03
    smallest_step: float = 1e-9
    max_points: int = 400


@dataclass(frozen=True)
class Direction:
    """A direction of a branch: displacement (n_b, 3) and load rate, of unit arclength."""

    displacement: FloatArray
    load: float

    def reversed(self) -> Direction:
        """Return the opposite direction."""
        return Direction(-self.displacement, -self.load)


@dataclass(frozen=True)
class BranchPoint:
    """An equilibrium on a branch, the branch's direction there, and its stability.

    `problem` is the one it solves: a soap film's is made anew where the film has turned.
    """

    problem: Problem
    model: TangentModel
    load: float
    direction: Direction
    arclength: float
    corrections: int

    @property
    def x(self) -> FloatArray:
        """Loop positions (n_b, 3)."""
        return self.model.x

    @property
    def stability(self) -> Stability:
        """Spectrum of the second variation."""
        return stability(self.model)

    @property
    def film(self) -> FloatArray:
        """The film (n_v, 3) on the loop."""
        return self.problem.condensed.extend(self.x)

    def displacement(self, moved: FloatArray) -> FloatArray:
        """Return how the film (n_v, 3) follows a displacement of the loop (n_b, 3)."""
        return self.problem.condensed.displacement(self.x, moved)


def first_point(
    problem: Problem, x_loop: FloatArray, load: float, settings: Settings
) -> BranchPoint:
    """Return the branch point at an equilibrium (n_b, 3), heading for higher loads."""
    model = tangent_model(loop_energy(problem, load), x_loop)
    upwards = Direction(np.zeros_like(x_loop), settings.load_unit)
    direction = branch_direction(problem, model, upwards, settings)
    return BranchPoint(problem, model, load, direction, 0.0, 0)


def along(point: BranchPoint, other: BranchPoint, settings: Settings) -> float:
    """Return how far `other` lies from `point` along the branch's direction there."""
    way = Direction(other.x - point.x, other.load - point.load)
    return inner(point.problem, point.direction, way, settings)


def inner(problem: Problem, a: Direction, b: Direction, settings: Settings) -> float:
    """Return the product of two directions in which arclength is measured."""
    product = np.sum(a.displacement * b.displacement, axis=1)
    load = a.load * b.load / settings.load_unit**2
    return float(problem.loop.mean_lengths @ product) + load


def correct(
    problem: Problem,
    guess: FloatArray,
    load: float,
    direction: Direction,
    settings: Settings,
    attempts: tuple[float, ...] = (0.0, NOISE),
) -> BranchPoint | None:
    """Return the equilibrium in the hyperplane through the guess normal to `direction`.

    Each of the attempts keeps still along singular vectors of relative value below it.
    """
    for smallest in attempts:
        found = _correct(problem, guess, load, direction, settings, smallest)
        if found is not None:
            return found
    return None


def _correct(
    problem: Problem,
    guess: FloatArray,
    load: float,
    direction: Direction,
    settings: Settings,
    smallest: float,
) -> BranchPoint | None:
    """Correct by Newton's method, still along singular vectors below `smallest`.

    Close to a bifurcation the Hessian hardly resists its critical mode: along it, rounding
    in the forces becomes motion, which a second attempt leaves out.
    """
    x = project_lengths(problem.loop, guess)
    best = np.inf
    guess_load = load
    for corrections in range(_CORRECTIONS):
        if x is None or load <= 0 or not np.isfinite(load):
            return None
        try:
            model = tangent_model(loop_energy(problem, load), x)
        except LinAlgError:  # no film on this loop
            return None
        normal = coefficients_of(model, direction.displacement)
        way = Direction(x - guess, load - guess_load)
        off = inner(problem, direction, way, settings)
        settled = model.residual <= max(4 * model.rounding, 1e-13)
        stuck = model.residual < RESIDUAL_TOLERANCE**1.5 and model.residual > 0.5 * best
        if settled or stuck:
            tangent = branch_direction(problem, model, direction, settings)
            return BranchPoint(problem, model, load, tangent, 0.0, corrections)
        best = min(best, model.residual)
        system = _bordered(problem, model, normal, direction.load, settings)
        rhs = -np.append(model.gradient, off)
        try:
            shift = _solve(system, rhs, smallest)
        except LinAlgError:
            return None
        x = project_lengths(problem.loop, x + model.displacement(shift[:-1]))
        load = load + float(shift[-1])
    return None


def _solve(system: FloatArray, rhs: FloatArray, smallest: float) -> FloatArray:
    if smallest == 0.0:
        return np.linalg.solve(system, rhs).astype(np.float64)
    return np.linalg.lstsq(system, rhs, rcond=smallest)[0].astype(np.float64)


def branch_direction(
    problem: Problem, model: TangentModel, last: Direction, settings: Settings
) -> Direction:
    """Return the branch's direction at an equilibrium, turned the way of `last`.

    The null vector of [H, b]: bordering by `last` would have to find one near `last`, also
    where a step has landed on a branch that crosses.
    """
    slope = load_derivative(problem, model) * settings.load_unit
    wide = np.column_stack([model.hessian, slope])
    null = np.linalg.qr(wide.T, mode="complete")[0][:, -1]
    found = make_direction(model, null[:-1], null[-1] * settings.load_unit, settings)
    return found if inner(problem, found, last, settings) >= 0 else found.reversed()


def make_direction(
    model: TangentModel, coefficients: FloatArray, load: float, settings: Settings
) -> Direction:
    """Return the direction with these tangent coefficients, scaled to unit arclength."""
    size = float(np.sqrt(coefficients @ coefficients + (load / settings.load_unit) ** 2))
    return Direction(model.displacement(coefficients / size), load / size)


def load_derivative(problem: Problem, model: TangentModel) -> FloatArray:
    """Return b = dg/dl (2 n_b - 6,), the film's force per unit of load on tangent space."""
    force = problem.condensed.force(model.x)
    derivative: FloatArray = model.basis.T @ (force.ravel() / model.scale)
    return derivative


def coefficients_of(model: TangentModel, displacement: FloatArray) -> FloatArray:
    """Return the tangent coefficients (2 n_b - 6,) of a displacement (n_b, 3)."""
    found: FloatArray = model.basis.T @ (displacement.ravel() * model.scale)
    return found


def _bordered(
    problem: Problem,
    model: TangentModel,
    normal: FloatArray,
    load: float,
    settings: Settings,
) -> FloatArray:
    """Return [[H, b], [normal^T, load / unit^2]]: regular at folds, where H is not."""
    m = len(normal)
    system = np.empty((m + 1, m + 1))
    system[:m, :m] = model.hessian
    system[:m, m] = load_derivative(problem, model)
    system[m, :m] = normal
    system[m, m] = load / settings.load_unit**2
    return system
