"""Folds and bifurcations on a branch: found between two points, located, left by.

Let phi be the Hessian's null vector at such a point and b = dg/dl. Where b.phi does not
vanish the branch folds; where it does, two branches cross there, with directions

    (phi, 0)   and   (q, 1),   H q = -b,  q.phi = 0,

up to a mixture that symmetry forbids at a pitchfork (Keller 1977; Seydel 2010, ch. 5).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from operator import methodcaller

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.between import Interval, parameter_rate
from eulerplateau.branches.continuation import Kink, advance, released
from eulerplateau.branches.control import Direction, StepControl
from eulerplateau.branches.normal_form import NO_PART, part_along
from eulerplateau.branches.point import (
    BranchPoint,
    correct,
    make_direction,
    parameter_drift,
    parameter_slope,
)
from eulerplateau.branches.symmetry import ModeSymmetry, mode_symmetry

FOLD, BIFURCATION, CONTACT = "fold", "bifurcation", "contact"

# Arclength at which a branch is left for another: far enough for two distinct solutions
# to be told apart, close enough to be certain of landing on the wanted one.
_SWITCHING_STEP = 2e-3
# Part of an eigenvalue's change that it may be short of zero where it changes sign; and how
# many times what rounding makes of it the change has to be.
_LEAP, _CLEAR = 1e-5, 1e3
# Secants after which one that does not leap is that near: two or three do.
_SECANTS = 8
# Relative difference of values below which two modes are lost together.
_TOGETHER = 1e-6
# Part of a pure change of the parameter that a direction may have and still count as level:
# near enough to a pitchfork to cross over, not so near that its equations are singular.
_LEVEL = 0.02
# Where a branch is almost level all along: the part of its steepest that counts as level.
_LEVELLED = 0.25


@dataclass(frozen=True, repr=False)
class SpecialPoint:
    """A point where an eigenvalue of the second variation vanishes, or contact changes.

    Attributes
    ----------
    kind : FOLD or BIFURCATION, or CONTACT, where there is no critical displacement
    point : the equilibrium; at a bifurcation its direction is (q, 1), towards higher values
    mode : (n, d) float, the critical displacement phi
    eigenvalue : float, what is left of the critical eigenvalue
    error : float
        What rounding in the eigenvalue can have moved the parameter by.
    n_unstable : int, negative eigenvalues not counting the critical one
    multiplicity : int, eigenvalues that vanish together
    symmetry : which symmetries phi breaks
    arrived : bool
        Whether the branch it was found on is the one along phi, which ends here: beyond
        lies its mirror image.
    contact : what happens to strands that touch, in a word; empty where nothing does
    """

    kind: str
    point: BranchPoint
    mode: FloatArray
    eigenvalue: float
    error: float
    n_unstable: int
    multiplicity: int
    symmetry: ModeSymmetry
    arrived: bool = False
    contact: str = ""

    @property
    def breaks(self) -> tuple[str, ...]:
        """The symmetries that are lost along the critical displacement."""
        return self.symmetry.breaks

    def __repr__(self) -> str:
        """Return one line: the kind, the parameter with its error, what breaks."""
        broken = ", ".join(self.breaks) or "nothing"
        value = f"{self.point.value:.8g} +- {self.error:.1g}"
        kind = f"{self.kind}{multiple(self.multiplicity)}"
        return f"<SpecialPoint: {kind} at {value}, breaks {broken}>"


def multiple(multiplicity: int) -> str:
    """Return what is said behind an event of how many eigenvalues vanish at it."""
    if multiplicity == 1:
        return ""
    return " (double)" if multiplicity == 2 else f" ({multiplicity}-fold)"


def special_points(
    before: BranchPoint, after: BranchPoint, control: StepControl
) -> Iterator[SpecialPoint]:
    """Yield the special points between two neighbouring points, in order of arclength."""
    interval = Interval(before, after, control)
    if before.direction.rate * after.direction.rate < 0:
        found = _turn(interval)
        if found is not None:
            yield found
        return
    located = [
        (*crossed, index)
        for index in interval.crossing
        if (crossed := interval.at_rest(methodcaller("zero", index))) is not None
    ]
    located.sort(key=lambda each: each[1].arclength)
    last = None
    for within, point, _ in located:
        near = _TOGETHER * control.scale(point.value)
        # Symmetric loops lose several modes at once: one event, and one set of branches.
        if last is not None and abs(point.value - last) < near:
            continue
        last = point.value
        together = [i for _, other, i in located if abs(other.value - last) < near]
        found = _describe(within, point, min(together), len(together))
        # The eigenvalue of an all but free rotation wanders about zero: no event.
        if found.error < near:
            yield found


def contact_point(kink: Kink) -> SpecialPoint:
    """Return a kink, where strands touch, part or split, as a special point.

    Of its two sides the one with fewer unstable modes counts.
    """
    point = kink.before
    n_unstable = min(at.stability.n_unstable for at in (point, kink.after))
    return SpecialPoint(
        kind=CONTACT,
        point=point,
        mode=np.zeros_like(point.x),
        eigenvalue=float(point.stability.lowest),
        error=kink.error,
        n_unstable=n_unstable,
        multiplicity=1,
        symmetry=ModeSymmetry((), (), 0.0),
        contact=kink.what,
    )


def leaps(before: BranchPoint, after: BranchPoint, control: StepControl) -> bool:
    """Return whether a step has left its branch for another that passes close by.

    Where two branches miss each other narrowly, as an imperfect mesh makes those of a
    bifurcation do, an eigenvalue then changes sign without being zero in between.
    """
    if before.direction.rate * after.direction.rate < 0:
        return False
    interval = Interval(before, after, control)
    for index in interval.crossing:
        rise = interval.rise(index)
        if rise < _CLEAR * after.stability.error_bound:
            continue
        if not interval.nearly_zero(index, _LEAP * rise, _SECANTS):
            return True
    return False


def branches_from(special: SpecialPoint, control: StepControl) -> Iterator[BranchPoint]:
    """Yield a first point on each side of the other branch through a bifurcation."""
    if special.kind != BIFURCATION:
        return
    model = special.point.model
    away = special.point.direction
    if not special.arrived:
        coefficients = model.coefficients(special.mode)
        away = make_direction(model, coefficients, 0.0, control)
    for direction in (away, away.reversed()):
        found = _step_along(special.point, direction, _SWITCHING_STEP, control)
        if found is not None:
            yield replace(released(found, control), arclength=_SWITCHING_STEP)


def _turn(interval: Interval) -> SpecialPoint | None:
    """Return the fold, or the bifurcation the branch passes across at an extreme value.

    A pitchfork's side branch crosses the other branch where its own value is extreme. Both
    its halves are mirror images, so there its critical eigenvalue touches zero, while at a
    fold it crosses. Its equations are singular there, so the point is located on the other
    branch.
    """
    ends = interval.before.direction.rate, interval.after.direction.rate
    level = min(_LEVEL * interval.control.unit, _LEVELLED * max(np.abs(ends)))
    near = interval.locate(partial(parameter_rate, level))
    if near is None:
        return None
    index = int(np.abs(near.stability.eigenvalues).argmin())
    if interval.crossing:
        extreme = interval.at_rest(methodcaller("locate", partial(parameter_rate, 0.0)))
        fold = None if extreme is None else _describe(*extreme, index, 1)
        return fold if fold is not None and fold.kind == FOLD else None
    other = _across(interval, near, index)
    if other is None or len(other.crossing) != 1:
        return None
    number = other.crossing[0]
    crossing = other.at_rest(methodcaller("zero", number))
    if crossing is None:
        return None
    found = _describe(*crossing, number, 1)
    here = replace(found.point, arclength=_arclength_of_extreme(interval))
    return replace(found, point=here, arrived=True)


def _arclength_of_extreme(interval: Interval) -> float:
    """Return where on the branch the parameter is extreme: its rate is linear there."""
    before, after = interval.before.direction.rate, interval.after.direction.rate
    return interval.before.arclength + interval.length * before / (before - after)


def _across(interval: Interval, extreme: BranchPoint, index: int) -> Interval | None:
    """Return the interval of the other branch that holds the crossing."""
    control = interval.control
    direction = _through(extreme, index, control)
    back = _step_along(extreme, direction, -_SWITCHING_STEP, control)
    if back is None:
        return None
    forth = advance(back, 2 * _SWITCHING_STEP, control)
    return None if forth is None else Interval(back, forth, control)


def _through(point: BranchPoint, index: int, control: StepControl) -> Direction:
    """Return (q, 1) with H q = -b and no part along the null vector `index`.

    At the bifurcation itself the bordered system has two null vectors, so the direction
    that `correct` finds there is an arbitrary mixture.
    """
    values, vectors = point.model.eigen
    others = np.arange(len(values)) != index
    slope = vectors[:, others].T @ parameter_slope(point.family, point.energy, point.model)
    response = -vectors[:, others] @ (slope / values[others])
    drift = parameter_drift(point.family, point.energy, point.model)
    return make_direction(point.model, response, 1.0, control, drift)


def _step_along(
    point: BranchPoint,
    direction: Direction,
    step: float,
    control: StepControl,
) -> BranchPoint | None:
    guess = point.x + step * direction.displacement
    return correct(
        point.family, guess, point.value + step * direction.rate, direction, control
    )


def _describe(
    interval: Interval, point: BranchPoint, index: int, multiplicity: int
) -> SpecialPoint:
    values, vectors = point.model.eigen
    mode = point.model.displacement(vectors[:, index])
    parameter, unit = point.family.parameter, interval.control.unit
    folds = (
        part_along(point.energy, point.model, vectors[:, index], parameter, unit) > NO_PART
    )
    if not folds:
        point = replace(point, direction=_through(point, index, interval.control))
    return SpecialPoint(
        kind=FOLD if folds else BIFURCATION,
        point=point,
        mode=mode,
        eigenvalue=float(values[index]),
        error=interval.error(point, index),
        n_unstable=index,
        multiplicity=multiplicity,
        symmetry=symmetry_at(point, mode),
    )


def symmetry_at(point: BranchPoint, mode: FloatArray) -> ModeSymmetry:
    """Return what a displacement `mode` (n, d) does to the symmetries of a point's loop."""
    positions = point.family.positions
    handed = point.energy.is_handed
    return mode_symmetry(positions(point.x), positions(mode), mirrors=not handed)
