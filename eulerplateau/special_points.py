"""Folds and bifurcations on a branch: found between two points, located, left by.

Let phi be the Hessian's null vector at such a point and b = dg/dl. Where b.phi does not
vanish the branch folds; where it does, two branches cross there, with directions

    (phi, 0)   and   (q, 1),   H q = -b,  q.phi = 0,

up to a mixture that symmetry forbids at a pitchfork (Keller 1977; Seydel 2010, ch. 5).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.optimize import brentq

from eulerplateau.continuation import (
    BranchPoint,
    Direction,
    Settings,
    advance,
    correct,
    load_derivative,
    make_direction,
)
from eulerplateau.mesh import FloatArray
from eulerplateau.problem import Problem
from eulerplateau.symmetry import ModeSymmetry, mode_symmetry

FOLD, BIFURCATION = "fold", "bifurcation"

# |b.phi| / |b| below which b has no part along phi. Symmetric points reach 1e-8; folds on
# these films have 0.1 and more.
_NO_PART = 1e-3
# Arclength at which a branch is left for another: far enough for two distinct solutions
# to be told apart, close enough to be certain of landing on the wanted one.
_SWITCHING_STEP = 2e-3
_PRECISION = 1e-14


@dataclass(frozen=True)
class SpecialPoint:
    """A point where an eigenvalue of the second variation vanishes.

    Attributes
    ----------
    kind : FOLD or BIFURCATION
    point : the equilibrium; at a bifurcation its direction is (q, 1), towards higher loads
    mode : (n_b, 3) float, the critical displacement phi
    eigenvalue : float, what is left of the critical eigenvalue
    n_unstable : int, negative eigenvalues not counting the critical one
    multiplicity : int, eigenvalues that vanish together
    symmetry : which symmetries phi breaks
    arrived : bool
        Whether the branch it was found on is the one along phi, which ends here: beyond
        lies its mirror image.
    """

    kind: str
    point: BranchPoint
    mode: FloatArray
    eigenvalue: float
    n_unstable: int
    multiplicity: int
    symmetry: ModeSymmetry
    arrived: bool = False


def special_points(
    problem: Problem, before: BranchPoint, after: BranchPoint, settings: Settings
) -> Iterator[SpecialPoint]:
    """Yield the special points between two neighbouring points, in order of arclength."""
    if before.direction.load * after.direction.load < 0:
        found = _turn(problem, before, after, settings)
        if found is not None:
            yield found
        return
    crossed = sorted((before.stability.n_unstable, after.stability.n_unstable))
    located = []
    for index in range(*crossed):
        point = _locate(problem, before, after, settings, partial(_eigenvalue, index))
        if point is not None:
            located.append((point, index))
    located.sort(key=lambda found: found[0].arclength)
    last = None
    for point, index in located:
        # Symmetric loops lose several modes at once: one event, and one set of branches.
        if last is not None and abs(point.load / last - 1) < 1e-6:
            continue
        last = point.load
        together = sum(abs(other.load / last - 1) < 1e-6 for other, _ in located)
        yield _describe(problem, point, index, together, settings)


def branches_from(
    problem: Problem, special: SpecialPoint, settings: Settings
) -> Iterator[BranchPoint]:
    """Yield a first point on each side of the other branch through a bifurcation."""
    if special.kind == FOLD:
        return
    model = special.point.model
    away = special.point.direction
    if not special.arrived:
        coefficients = model.basis.T @ (special.mode.ravel() * model.scale)
        away = make_direction(model, coefficients, 0.0, settings)
    for direction in (away, away.reversed()):
        found = _step_along(problem, special.point, direction, _SWITCHING_STEP, settings)
        if found is not None:
            yield found


def _locate(
    problem: Problem,
    before: BranchPoint,
    after: BranchPoint,
    settings: Settings,
    test: Callable[[BranchPoint], float],
) -> BranchPoint | None:
    """Return the point between two where `test(point)` vanishes; None if it is lost."""
    length = after.arclength - before.arclength
    points = {0.0: before, length: after}

    def value(step: float) -> float:
        if step not in points:
            point = advance(problem, before, step, settings)
            if point is None:
                raise ArithmeticError
            points[step] = point
        return float(test(points[step]))

    try:
        if value(0.0) * value(length) > 0:
            return None
        root = brentq(value, 0.0, length, xtol=_PRECISION, rtol=8.9e-16)
        value(root)
    except ArithmeticError:
        return None
    return points[root]


def _turn(
    problem: Problem, before: BranchPoint, after: BranchPoint, settings: Settings
) -> SpecialPoint | None:
    """Return the fold, or the bifurcation the branch passes across at extreme load.

    A pitchfork's side branch crosses the other branch where its own load is extreme. Its
    equations are singular there, so the point is located on the other branch.
    """
    extreme = _locate(problem, before, after, settings, lambda p: p.direction.load)
    if extreme is None:
        return None
    values, vectors = extreme.model.eigen
    index = int(np.abs(values).argmin())
    if _part_along(problem, extreme, vectors[:, index]) > _NO_PART:
        return _describe(problem, extreme, index, 1, settings)
    ends = _across(problem, extreme, index, settings)
    if ends is None:
        return None
    low, high = ends
    crossed = sorted((low.stability.n_unstable, high.stability.n_unstable))
    if crossed[0] == crossed[1]:
        return None
    point = _locate(problem, low, high, settings, partial(_eigenvalue, crossed[0]))
    if point is None:
        return None
    return replace(_describe(problem, point, crossed[0], 1, settings), arrived=True)


def _across(
    problem: Problem, extreme: BranchPoint, index: int, settings: Settings
) -> tuple[BranchPoint, BranchPoint] | None:
    """Return two points of the other branch, on both sides of the crossing."""
    direction = _through(problem, extreme, index, settings)
    back = _step_along(problem, extreme, direction, -_SWITCHING_STEP, settings)
    if back is None:
        return None
    forth = advance(problem, back, 2 * _SWITCHING_STEP, settings)
    return None if forth is None else (back, forth)


def _through(
    problem: Problem, point: BranchPoint, index: int, settings: Settings
) -> Direction:
    """Return (q, 1) with H q = -b and no part along the null vector `index`.

    At the bifurcation itself the bordered system has two null vectors, so the direction
    that `correct` finds there is an arbitrary mixture.
    """
    values, vectors = point.model.eigen
    others = np.arange(len(values)) != index
    slope = vectors[:, others].T @ load_derivative(problem, point.model)
    response = -vectors[:, others] @ (slope / values[others])
    return make_direction(point.model, response, 1.0, settings)


def _step_along(
    problem: Problem,
    point: BranchPoint,
    direction: Direction,
    step: float,
    settings: Settings,
) -> BranchPoint | None:
    guess = point.x + step * direction.displacement
    return correct(problem, guess, point.load + step * direction.load, direction, settings)


def _eigenvalue(index: int, point: BranchPoint) -> float:
    """Return an eigenvalue, as zero where rounding decides its sign.

    Closer to a bifurcation than that the corrector would follow rounding along the mode.
    """
    found = point.stability
    value = float(found.eigenvalues[index])
    return 0.0 if abs(value) <= found.error_bound else value


def _part_along(problem: Problem, point: BranchPoint, mode: FloatArray) -> float:
    slope = load_derivative(problem, point.model)
    return abs(float(slope @ mode)) / float(np.linalg.norm(slope))


def _describe(
    problem: Problem,
    point: BranchPoint,
    index: int,
    multiplicity: int,
    settings: Settings,
) -> SpecialPoint:
    values, vectors = point.model.eigen
    mode = point.model.displacement(vectors[:, index])
    folds = _part_along(problem, point, vectors[:, index]) > _NO_PART
    if not folds:
        through = _through(problem, point, index, settings)
        point = replace(point, direction=through)
    return SpecialPoint(
        kind=FOLD if folds else BIFURCATION,
        point=point,
        mode=mode,
        eigenvalue=float(values[index]),
        n_unstable=index,
        multiplicity=multiplicity,
        symmetry=mode_symmetry(point.x, mode),
    )
