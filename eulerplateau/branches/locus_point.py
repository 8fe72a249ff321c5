"""Points of a curve of special points in two parameters, corrected in a hyperplane.

With the tangent model's gradient g and Hessian H, and k modes that are lost together (one,
but for round loops), a point solves

    g(x, p, r) + B mu = 0,     tr Phi^T H Phi = 0,     [[H, B], [B^T, 0]] [Phi; S] = [0; 1],

the borders B being the last point's modes (Govaerts 2000). There S = -Phi^T H Phi, whose
derivative by a displacement is known at the last point (normal_form.py) and mended from
step to step by what S has done (Broyden 1965). At a fold mu = 0. At a bifurcation that a
symmetry keeps H is singular for good: mu is an unknown there, and B^T dx = 0. What is
found is an equilibrium, mu = 0, as long as the symmetry is kept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from scipy.linalg import LinAlgError, polar

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.control import Motion, StepControl
from eulerplateau.branches.family import Family
from eulerplateau.branches.normal_form import Neighbourhood, bordered
from eulerplateau.interruption import heed
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers import TangentModel, tangent_model

_CORRECTIONS = 20
# Arclength of a correction below which it is none, and below which it may be rounding.
_SETTLED, _ROUNDING = 1e-12, 1e-7
# Distance from a value that does not exist, in the parameter's unit, at which curves end.
_NEXT_TO = 1e-6


@dataclass(frozen=True)
class Course:
    """What a curve is a curve of.

    Attributes
    ----------
    second : name of the second parameter; the family knows the first
    controls : windows, units and least values of both; steps are the first one's
    symmetric : whether it is one of bifurcations that a symmetry keeps; else of folds
    breaks : names of symmetries
        Of bifurcations, those that their mode breaks; of folds that one of these left,
        those that the second parameter has taken from it.
    """

    second: str
    controls: tuple[StepControl, StepControl]
    symmetric: bool
    breaks: tuple[str, ...] = ()

    @property
    def units(self) -> FloatArray:
        """Changes of both parameters (2,) that are as long as a displacement of 1 L."""
        return np.array([control.unit for control in self.controls])

    def exists(self, values: FloatArray) -> bool:
        """Return whether both parameters (2,) may have these values."""
        least = np.array([control.least for control in self.controls])
        return bool(np.all(np.isfinite(values) & (values > least)))

    def inside(self, values: FloatArray) -> bool:
        """Return whether both parameters (2,) are in their windows."""
        low, high = np.transpose([control.window for control in self.controls])
        least = np.array([control.least for control in self.controls])
        low = np.maximum(low, least + _NEXT_TO * self.units)
        return bool(np.all((low <= values) & (values <= high)))

    def dot(self, model: TangentModel, one: Motion, other: Motion) -> float:
        """Return the product of two motions in which arclength is measured."""
        product = model.weights @ np.sum(one.displacement * other.displacement, axis=1)
        return float(product + one.rates / self.units @ (other.rates / self.units))

    def row(self, model: TangentModel, motion: Motion) -> FloatArray:
        """Return a motion (m + 2,) in the model's coordinates and the parameters' units."""
        return np.append(model.coefficients(motion.displacement), motion.rates / self.units)

    def motion(self, model: TangentModel, row: FloatArray) -> Motion:
        """Return what a row (m + 2,) is."""
        return Motion(model.displacement(row[:-2]), row[-2:] * self.units)


@dataclass(frozen=True)
class LocusPoint:
    """A point of a curve of special points.

    Attributes
    ----------
    family : at the second parameter's value
    values : (2,) float, of both parameters
    near : loops along the modes that are lost
    steepness : the gradient of the mean of phi^T H phi, in the product of arclength
    direction : of the curve, of unit arclength
    arclength : float, from the start, either way
    special : str, what is special about it, or nothing
    end : str, why the curve ends here, or nothing
    """

    course: Course
    family: Family
    model: TangentModel
    values: FloatArray
    near: Neighbourhood
    steepness: Motion
    direction: Motion
    corrections: int
    arclength: float = 0.0
    special: str = ""
    end: str = ""

    @property
    def place(self) -> Motion:
        """The loop and both values."""
        return Motion(self.model.x, self.values)

    @property
    def energy(self) -> LoopEnergy:
        """The energy of which it is an equilibrium."""
        return self.family.energy(float(self.values[0]))

    @property
    def modes(self) -> FloatArray:
        """The orthonormal null vectors (m, k), in the model's coordinates."""
        return self.near.modes

    @cached_property
    def coefficient(self) -> float:
        """Of a bifurcation a_3, supercritical where positive; of a fold a_2.

        Its sign is the mode's: see normal_form.py. Raises LinAlgError as that does.
        """
        return self.near.cubic() if self.course.symmetric else self.near.quadratic()

    @cached_property
    def others(self) -> FloatArray:
        """The eigenvalues of all other modes, ascending."""
        hessian, modes = self.model.hessian, self.modes
        # Those that are lost come to lie above all others.
        above = 2 * float(np.abs(hessian).sum(axis=1).max())
        values = np.linalg.eigvalsh(hessian + (above * modes) @ modes.T)
        return values[: -modes.shape[1]].astype(np.float64, copy=False)

    @property
    def n_unstable(self) -> int:
        """How many other modes are unstable."""
        return int(np.sum(self.others < 0))

    def dot(self, one: Motion, other: Motion) -> float:
        """Return the product of two motions in which arclength is measured."""
        return self.course.dot(self.model, one, other)

    def next_to(self, guess: Motion, normal: Motion) -> LocusPoint | None:
        """Return the point in the hyperplane through a guess, by what is known here."""
        modes = [self.model.displacement(mode) for mode in self.modes.T]
        return correct(self.course, self.family, guess, normal, modes, self.steepness)

    def reversed(self) -> LocusPoint:
        """Return the point heading the other way."""
        return replace(self, direction=self.direction * -1.0)


@dataclass(frozen=True)
class Trial:
    """A loop at two values on the way to a point, looked at from a point near by."""

    course: Course
    family: Family
    values: FloatArray
    energy: LoopEnergy
    model: TangentModel
    border: FloatArray
    modes: FloatArray
    curved: float

    @property
    def place(self) -> Motion:
        """The loop and both values."""
        return Motion(self.model.x, self.values)

    @cached_property
    def slopes(self) -> FloatArray:
        """The derivative of g by both parameters in their units, as columns (m, 2)."""
        model, names = self.model, (self.family.parameter, self.course.second)
        rates = [model.slope(self.energy.rate(name, model.x)) for name in names]
        return np.column_stack(rates) * self.course.units

    def system(self, *rows: Motion) -> FloatArray:
        """Return the matrix of g and of further rows, by x, by parameters and by mu.

        The rows that hold the loop along the modes of a bifurcation come last.
        """
        upper = np.hstack([self.model.hessian, self.slopes])
        lower = [self.course.row(self.model, row) for row in rows]
        matrix = np.vstack([upper, *lower])
        if not self.course.symmetric:
            return matrix
        border = np.zeros((len(matrix), self.border.shape[1]))
        border[: len(upper)] = self.border
        held = np.zeros((self.border.shape[1], matrix.shape[1]))
        held[:, : len(upper)] = self.border.T
        return np.block([[matrix, border], [held, np.zeros((len(held), len(held)))]])

    def shift(self, steepness: Motion, normal: Motion, off: float) -> Motion:
        """Return Newton's step; raises LinAlgError if there is none."""
        matrix, m = self.system(steepness, normal), len(self.model.gradient)
        left = np.zeros(len(matrix))
        left[: m + 2] = *self.model.gradient, self.curved, off
        step = -np.linalg.solve(matrix, left).astype(np.float64)
        return self.course.motion(self.model, step[: m + 2])

    def completed(self, normal: Motion, corrections: int) -> LocusPoint:
        """Return the point that this is, heading as `normal`; raises LinAlgError."""
        course, model = self.course, self.model
        # Asked for here, before the film has been to the loops near by.
        upper = self.slopes
        names = self.family.parameter, course.second
        near = Neighbourhood(self.energy, model, self.modes, names)
        mixed = np.array([near.mixed(name) for name in names]) * course.units
        row = np.append(near.steepness(), mixed)
        steepness = course.motion(model, row)
        matrix = self.system(steepness, normal)
        along = np.zeros(len(matrix))
        along[len(upper) + 1] = 1.0
        null = np.linalg.solve(matrix, along).astype(np.float64)
        direction = course.motion(model, null[: len(row)])
        size = float(np.sqrt(course.dot(model, direction, direction)))
        return LocusPoint(
            course=course,
            family=self.family,
            model=model,
            values=self.values,
            near=near,
            steepness=steepness,
            direction=direction * (1 / size),
            corrections=corrections,
        )


def correct(
    course: Course,
    family: Family,
    guess: Motion,
    normal: Motion,
    modes: Sequence[FloatArray],
    steepness: Motion,
) -> LocusPoint | None:
    """Return the point in the hyperplane through a guess normal to a direction; or None.

    Parameters
    ----------
    modes : displacements (n, d), near those that are lost
    steepness : as of a LocusPoint near by
    """
    place: Motion | None = guess
    best, last = np.inf, None
    for corrections in range(_CORRECTIONS):
        heed()
        if place is None or not course.exists(place.rates):
            return None
        try:
            there = trial(course, family, place, modes)
            dot = partial(course.dot, there.model)
            if last is not None:
                shift, before = last
                done = there.curved - before - dot(steepness, shift)
                steepness += shift * (done / dot(shift, shift))
            shift = there.shift(steepness, normal, dot(normal, there.place - guess))
            size = float(np.sqrt(dot(shift, shift)))
            if size <= _SETTLED or 0.5 * best < size < _ROUNDING:
                return there.completed(normal, corrections)
        except LinAlgError:
            return None
        best, last = min(best, size), (shift, there.curved)
        place = there.place + shift
    return None


def trial(
    course: Course, family: Family, place: Motion, modes: Sequence[FloatArray]
) -> Trial:
    """Return a loop at two values, brought to its lengths; raises LinAlgError if lost."""
    there = family.with_value(course.second, float(place.rates[1]))
    energy = there.energy(float(place.rates[0]))
    x = energy.constraint.project(place.displacement)
    if x is None:
        raise LinAlgError("no loop near by keeps its length")
    model = tangent_model(energy, x)
    border = polar(np.column_stack([model.coefficients(mode) for mode in modes]))[0]
    found, left = bordered(model.hessian, border, np.zeros_like(border), np.eye(len(modes)))
    curved = -float(np.trace(left)) / len(modes)
    return Trial(course, there, place.rates, energy, model, border, polar(found)[0], curved)
