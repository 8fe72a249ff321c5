"""Films whose strands touch: a loop of a diameter, held where it crosses itself.

Of a loop of diameter d that touches itself in one point the film is the one whose waist is
held at d. The constraint has two equations, length - 1 = 0 and distance - d = 0, with the
multipliers beta and -F, F = dE/dd being the force with which the strands push each other.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Self, TypeVar

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.conformal.by_writhe import CONTROL
from eulerplateau.branches.conformal.family import SmoothFamily
from eulerplateau.branches.conformal.terms import WholeLength
from eulerplateau.branches.point import BranchPoint, first_point
from eulerplateau.exact.conformal import (
    TWISTED,
    Basis,
    ConformalFilm,
    Crossing,
    bending_energy,
    loop_length,
    make_basis,
)
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers import Stability

_STEPS, _TRUST = 12, 0.5
_SETTLED, _STUCK = 1e-13, 1e-9
# On the way to other values: corrections up to which steps grow, first and shortest step.
_EASY, FIRST, _SHORTEST = 5, 0.05, 3e-4
# Steps shorter than this ask for more harmonics, up to so many.
_SHORT, _MOST_ON_THE_WAY = 8e-3, 216
_SAME_GRID = 0.01
# Of the grid that resolves a neck: lengths in L.
_CROWDING, _WIDE = 0.0045, 0.08


@dataclass(frozen=True)
class HeldApart(WholeLength):
    """The constraint that a loop is as long as it was, its strands `diameter` apart."""

    diameter: float

    def misfit(self, x: FloatArray) -> FloatArray:
        """Return what length and distance are too large by (2,)."""
        loop = self.unknowns.loop(x)
        apart = loop.crossing.distance - self.diameter
        return np.array([loop_length(loop.curve) - 1, apart])

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Return the derivatives of length and distance (2, size)."""
        u = self.unknowns
        apart = u.slope(u.loop(x).crossing.slope).T
        return np.vstack([super().jacobian(x), apart])

    def force(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the multipliers times those (size, 1)."""
        force: FloatArray = self.jacobian(x).T @ tensions[:, None]
        return force

    def stiffness(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the multipliers times the second derivatives (size, size)."""
        u = self.unknowns
        apart = u.curvature(u.loop(x).crossing.curvature)
        stiff: FloatArray = super().stiffness(x, tensions) + tensions[1] * apart
        return stiff

    def project(self, x: FloatArray) -> FloatArray | None:
        """Return the loop next to x that bends least away from it."""
        for _ in range(_STEPS):
            misfit, slopes = self.misfit(x), self.jacobian(x)
            if np.abs(misfit).max() < _SETTLED:
                return x
            x = x - slopes.T @ np.linalg.solve(slopes @ slopes.T, misfit)[:, None]
        return None


@dataclass(frozen=True)
class TouchingFamily(SmoothFamily):
    """Films held apart at the waist; `values` has their "diameter" too."""

    def energy(self, value: float) -> LoopEnergy:
        """Return the energy at a value of the parameter."""
        held = self.held(value)
        return replace(super().energy(value), constraint=held)

    def in_space(self, point: BranchPoint) -> Stability:
        """Return the spectrum among all loops that stay apart."""
        return self.at_once(point)

    def held(self, value: float) -> HeldApart:
        """Return the constraint at a value of the parameter."""
        return HeldApart(self.unknowns, self._values(value)["diameter"])


@dataclass(frozen=True)
class Touching:
    """A film whose strands touch in one point, of all half-turns.

    Attributes
    ----------
    x : (size, 1) float, what stands for the loop
    others : (2,) float, what is unknown besides: beta and -F
    corrections : int, of Newton's method
    """

    family: TouchingFamily
    x: FloatArray
    others: FloatArray
    corrections: int

    @property
    def values(self) -> Mapping[str, float]:
        """Load, twist ratio, link and diameter."""
        return self.family.values

    @property
    def basis(self) -> Basis:
        """The basis of the loop."""
        return self.family.basis

    @property
    def force(self) -> float:
        """The force of contact F = dE/dd, in alpha / L^2; negative if strands pull."""
        return -float(self.tensions[1])

    @property
    def tensions(self) -> FloatArray:
        """The multipliers (2,) of length and distance, beta and -F."""
        return self.others

    def with_unknowns(self, x: FloatArray, others: FloatArray) -> Self:
        """Return the film, or the guess, with other unknowns."""
        return replace(self, x=x, others=others)

    def by_others(self, energy: LoopEnergy, slopes: FloatArray) -> FloatArray:
        """Return how what does not balance (size, 2) changes with the others.

        slopes : (2, size) float, the constraint's
        """
        return slopes.T

    @property
    def crossing(self) -> Crossing:
        """Where the strands touch."""
        return self.family.unknowns.loop(self.x).crossing

    @property
    def convexity(self) -> float:
        """The least second derivative of the strands' distance, times the distance.

        By arc length, of both strands. It is 1 - |cos| of the crossing angle of straight
        ones; where it vanishes a point of contact becomes two. The force makes a kink of
        the curvature, dkappa/ds jumping by F/2, of which K harmonics miss F (ds/dphi) /
        (2 pi K) in the curvature itself.
        """
        at, miss = self.crossing, self.force / (2 * math.pi * self.basis.harmonics)
        form = at.form / np.outer(at.speeds, at.speeds) - miss * np.diag(at.speeds)
        return float(np.linalg.eigvalsh(form)[0]) * at.distance

    @property
    def energy(self) -> float:
        """Energy of film, bending and twist."""
        loop, load = self.family.unknowns.loop(self.x), self.values["load"]
        c = loop.coefficients
        film = 0.5 * load * float(c @ self.basis.dirichlet @ c)
        return film + bending_energy(loop.curve) + self.family.twist(load).energy(self.x)

    @property
    def point(self) -> BranchPoint:
        """The film as a point of a branch in the load."""
        return first_point(self.family, self.x, self.values["load"], CONTROL)

    def in_basis(self, basis: Basis) -> Self | None:
        """Return the same film in another basis; None if Newton's method fails."""
        family = replace(self.family, basis=basis)
        x = family.transferred(self.family, self.x)
        return settled(replace(self, family=family, x=x))


_Film = TypeVar("_Film", bound=Touching)


def in_contact(film: ConformalFilm, values: Mapping[str, float]) -> Touching:
    """Return a film of no force between its strands as one in contact, at its values."""
    family = TouchingFamily(film.basis, values)
    x, tensions = family.unknowns.x(film.coefficients), np.array([film.beta, 0.0])
    return _regraded(Touching(family, x, tensions, 0))


def settled(guess: _Film) -> _Film | None:
    """Return the film near a guess by Newton's method; None if that fails.

    The force is an unknown too, so that a guess may have any distance of its strands.
    """
    best, n = math.inf, len(guess.x)
    for corrections in range(_STEPS):
        family, x, load = guess.family, guess.x, guess.values["load"]
        energy, held = family.energy(load), family.held(load)
        forces, slopes = energy.forces(x), held.jacobian(x)
        unbalanced = sum(forces, start=slopes.T @ guess.tensions[:, None])
        misfit = held.misfit(x)
        largest = max(float(np.abs(force).max()) for force in forces)
        residual = max(float(np.abs(unbalanced).max()) / largest, *np.abs(misfit))
        if residual < _SETTLED or 0.5 * best < residual < _STUCK:
            return replace(guess, corrections=corrections)
        best = min(best, residual)
        matrix = np.zeros((n + 2, n + 2))
        matrix[:n, :n] = energy.lagrangian_hessian(x, guess.tensions)
        matrix[:n, n:], matrix[n:, :n] = guess.by_others(energy, slopes), slopes
        try:
            step = np.linalg.solve(matrix, -np.append(unbalanced, misfit))
        except LinAlgError:
            return None
        size = float(family.basis.wavenumbers @ np.abs(family.unknowns.scale * step[:n]))
        if not np.isfinite(size):
            return None
        step *= min(1.0, _TRUST / (size + 1e-300))
        guess = guess.with_unknowns(x + step[:n, None], guess.others + step[n:])
    return None


def way(start: _Film, wanted: Mapping[str, float], step: float = FIRST) -> Iterator[_Film]:
    """Yield the films on the way to other values, until those or until none is found.

    The way there is straight in the values, and in the logarithm of the diameter. The grid
    follows the neck, so that coefficients change little and films can be extrapolated.
    step : float, the first, as a part of the way
    """
    film, before, done, last = start, start, 0.0, -1.0
    while done < 1.0 and step >= _SHORTEST:
        there = min(1.0, done + step)
        values = {k: _between(k, start.values[k], wanted[k], there) for k in wanted}
        found = settled(_extrapolated(film, before, (there - done) / (done - last), values))
        if found is None:
            step /= 2
            finer = _finer(film) if step < _SHORT else None
            if finer is not None:
                film, before, last, step = finer, finer, -1.0, 2 * step
            continue
        film, before, done, last = _regraded(found), film, there, done
        yield film
        if found.corrections <= _EASY:
            step *= 1.5


def crowding(diameter: float, angle: float) -> float:
    """Return the crowding of a grid that resolves a neck.

    Between strands that cross at an angle, in degrees, it is a helicoid and conformally
    about log(size / diameter) pi / angle long.
    """
    return float(_CROWDING * (diameter / _WIDE) ** (180 / angle))


def _finer(film: _Film) -> _Film | None:
    """Return the film by more harmonics, if it may have more."""
    harmonics = 4 * film.basis.harmonics // 3
    if harmonics > _MOST_ON_THE_WAY:
        return None
    return film.in_basis(make_basis(harmonics, TWISTED, film.basis.crowding))


def _regraded(film: _Film) -> _Film:
    """Return the film on the grid of its own angle, on which all others are."""
    wanted = crowding(film.values["diameter"], film.crossing.angle)
    if abs(wanted / film.basis.crowding - 1) < _SAME_GRID:
        return film
    return film.in_basis(make_basis(film.basis.harmonics, TWISTED, wanted)) or film


def _extrapolated(
    film: _Film, before: _Film, far: float, values: Mapping[str, float]
) -> _Film:
    """Return a guess at values as far beyond `film`, per step there from `before`."""
    angle, past = film.crossing.angle, before.crossing.angle
    ahead = max(angle + far * (angle - past), 0.5 * angle)
    basis = make_basis(film.basis.harmonics, TWISTED, crowding(values["diameter"], ahead))
    x = film.x + far * (film.x - before.x)
    others = film.others + far * (film.others - before.others)
    guess = replace(film, family=TouchingFamily(basis, values))
    return guess.with_unknowns(x, others)


def _between(name: str, first: float, second: float, part: float) -> float:
    """Return a value on the way, to the last digit that of its ends."""
    if name == "diameter":
        return float(first ** (1 - part) * second**part)
    return first * (1 - part) + second * part
