"""Branches of true films: followed, brought to a load, left where one bifurcates."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from eulerplateau.errors import NotConvergedError
from eulerplateau.exact.checks import finite
from eulerplateau.exact.conformal.basis import make_basis
from eulerplateau.exact.conformal.equilibrium import (
    ConformalFilm,
    Direction,
    branch_direction,
    correct,
    inner,
    newton,
)
from eulerplateau.exact.conformal.families import Family
from eulerplateau.exact.conformal.finer import MOST_HARMONICS, finer_bases
from eulerplateau.exact.conformal.second_variation import Mode, modes

_EASY, _HARD = 4, 10  # corrections: up to which steps grow, and at which they shrink
_STRAIGHT = 0.9  # cosine of the largest turn from one point to the next
_FIRST, _SMALLEST = 0.02, 1e-6
_LANDINGS, _LOCATIONS = 12, 60
_LOCATED = 1e-4  # largest eigenvalue taken for zero, over those at the neighbours
_CLOSE = 1e-3  # distance from a load from which Newton's method lands on it
BETTER = 0.5  # a refinement that does not shrink the tail by this factor is dropped


class BranchError(NotConvergedError):
    """A branch could not be followed to where the caller wants it."""


@dataclass(frozen=True)
class BranchPoint:
    """A film and the direction of its branch."""

    film: ConformalFilm
    direction: Direction

    @property
    def load(self) -> float:
        """sigma_hat."""
        return self.film.load

    def reversed(self) -> BranchPoint:
        """Return the same film, heading the other way."""
        return BranchPoint(self.film, self.direction.reversed())


def start(film: ConformalFilm) -> BranchPoint:
    """Return the branch point at a film, heading for higher loads."""
    return BranchPoint(film, branch_direction(film, None))


def follow(
    point: BranchPoint,
    largest_step: float,
    stop: Callable[[ConformalFilm], bool],
    max_points: int = 400,
) -> Iterator[BranchPoint]:
    """Yield the points after `point` up to the first at which `stop` is true.

    Pseudo-arclength continuation (Keller 1977) with steps up to `largest_step`, in loop
    lengths or 1000 units of load. Raises BranchError if no step, however short, succeeds
    or `max_points` do not lead to the end.
    """
    step = min(_FIRST, largest_step)
    for _ in range(max_points):
        after = advance(point, step)
        while after is None:
            step *= 0.5
            if step < _SMALLEST:
                raise BranchError(f"no step succeeds beyond sigma_hat = {point.load:.6f}")
            after = advance(point, step)
        yield after
        if stop(after.film):
            return
        if after.film.corrections <= _EASY:
            step = min(1.5 * step, largest_step)
        point = after
    raise BranchError(f"{max_points} points end at sigma_hat = {point.load:.6f}")


def advance(point: BranchPoint, step: float) -> BranchPoint | None:
    """Return the branch point at arclength `step`; None if there is none, or a kink."""
    film, direction = point.film, point.direction
    guess = film.coefficients + step * direction.coefficients
    load = film.load + step * direction.load
    found = newton(film.basis, guess, film.beta, load, direction, _HARD)
    if found is None:
        return None
    there, system = found
    ahead = system.direction(film.basis)
    straight = inner(film.basis, direction, ahead) >= _STRAIGHT
    return BranchPoint(there, ahead) if straight else None


def go_to_load(
    point: BranchPoint, load: float, largest_step: float = 0.05, max_points: int = 400
) -> BranchPoint:
    """Return the first point of the branch, the way `point` heads, at a load.

    Parameters
    ----------
    point : BranchPoint
        Where to begin; `point.reversed()` heads the other way.
    load : float
        sigma_hat = sigma L^3 / alpha, finite and not negative.
    largest_step : float
        In loop lengths, or 1000 units of load.

    Raises
    ------
    SpecError
        If the load is no such number.
    BranchError
        If `max_points` do not lead to the load.
    """
    side = np.sign(finite("load", load) - point.load)
    if side == 0:
        return point
    before = after = point
    for after in follow(
        point, largest_step, lambda film: bool((load - film.load) * side <= 0), max_points
    ):
        if (load - after.load) * side > 0:
            before = after
    return _land(before, after, load)


def _land(before: BranchPoint, after: BranchPoint, load: float) -> BranchPoint:
    """Return the point at a load between two points: regula falsi in the arclength."""
    basis = before.film.basis
    for _ in range(_LANDINGS):
        share = (load - before.load) / (after.load - before.load)
        middle = advance(before, share * _way(before, after))
        if middle is None:
            break
        if abs(middle.load - load) < _CLOSE:
            film = correct(basis, middle.film.coefficients, middle.film.beta, load)
            if film is None:
                break
            return BranchPoint(film, branch_direction(film, middle.direction))
        if (middle.load - load) * (after.load - load) > 0:
            after = middle
        else:
            before = middle
    raise BranchError(f"no landing at sigma_hat = {load:.6f}")


def resolve(
    point: BranchPoint, tail: float, most_harmonics: int = MOST_HARMONICS
) -> BranchPoint:
    """Return the same film with a tail of at most `tail`, or the least that refining gives.

    Parameters
    ----------
    tail : float
        The relative error of truncation to come to, 1e-10 say (Basis.tail).
    most_harmonics : int
        More are not tried; the film may then keep a larger tail.
    """
    while point.film.tail > tail:
        found = (
            change_basis(point, basis.harmonics, basis.crowding)
            for basis in finer_bases(point.film.basis, most_harmonics)
        )
        most = BETTER * point.film.tail
        better = (finer for finer in found if finer is not None and finer.film.tail < most)
        finer = next(better, None)
        if finer is None:
            break
        point = finer
    return point


def change_basis(point: BranchPoint, harmonics: int, crowding: float) -> BranchPoint | None:
    """Return the same film in another basis of its family, or None if Newton fails."""
    old = point.film
    basis = make_basis(harmonics, old.basis.family, crowding)
    guess = basis.transfer(old.basis, old.coefficients)
    film = correct(basis, guess, old.beta, old.load)
    if film is None:
        return None
    direction = basis.transfer(old.basis, point.direction.coefficients)
    last = Direction(direction, point.direction.load)
    return BranchPoint(film, branch_direction(film, last))


def locate(
    before: BranchPoint, after: BranchPoint, family: Family
) -> tuple[ConformalFilm, Mode]:
    """Return the film of zero eigenvalue between two neighbours of a branch, and its mode.

    Illinois' regula falsi in the arclength, until the eigenvalue is rounding or, where the
    branch itself is singular (a symmetry too low to tell mode and branch apart), Newton's
    method stops: the mode's eigenvalue says how close.

    Parameters
    ----------
    before, after : BranchPoint
        Neighbours on one branch, of one basis, between which one eigenvalue changes sign.
    family : Family
        The symmetry of the mode.

    Raises
    ------
    BranchError
        If no eigenvalue changes its sign, or the film found is not close to where it does.
    """
    first, last = (modes(point.film, family) for point in (before, after))
    number = min(sum(m.eigenvalue < 0 for m in found) for found in (first, last))
    low, high = ends = first[number].eigenvalue, last[number].eigenvalue
    if low * high > 0:
        raise BranchError(f"no eigenvalue of symmetry {family.name!r} changes its sign")
    best = min((before.film, first[number]), (after.film, last[number]), key=_distance)
    left, right = 0.0, _way(before, after)
    kept = 0
    for _ in range(_LOCATIONS):
        step = (left * high - right * low) / (high - low)
        there = advance(before, step)
        if there is None or abs(best[1].eigenvalue) < best[1].noise:
            break
        mode = modes(there.film, family)[number]
        best = min(best, (there.film, mode), key=_distance)
        if mode.eigenvalue * low > 0:
            left, low = step, mode.eigenvalue
            high *= 0.5 if kept == 1 else 1.0
            kept = 1
        else:
            right, high = step, mode.eigenvalue
            low *= 0.5 if kept == -1 else 1.0
            kept = -1
    if _distance(best) > _LOCATED * max(map(abs, ends)):
        raise BranchError(f"Newton's method fails near sigma_hat = {best[0].load:.6f}")
    return best


def _distance(found: tuple[ConformalFilm, Mode]) -> float:
    return abs(found[1].eigenvalue)


def _way(before: BranchPoint, after: BranchPoint) -> float:
    """Return how far `after` lies from `before` along the branch's direction there."""
    change = after.film.coefficients - before.film.coefficients
    way = Direction(change, after.load - before.load)
    return inner(before.film.basis, before.direction, way)


def switch(film: ConformalFilm, mode: Mode, amplitude: float) -> BranchPoint:
    """Return a film of the branch that leaves `film`, a singular one, along its mode.

    Parameters
    ----------
    film, mode : ConformalFilm, Mode
        What `locate` returns.
    amplitude : float
        Distance along the mode in the norm of `inner`, 0.01 say; its sign chooses one of
        the two sides. The point returned heads away from `film`.

    Raises
    ------
    BranchError
        If Newton's method finds no film there: a smaller amplitude may help.
    """
    both = join_symmetries(film.basis.family, mode.basis.family)
    basis = make_basis(film.basis.harmonics, both, film.basis.crowding)
    there = Direction(basis.embed(mode.basis, mode.coefficients), 0.0)
    unit = there.coefficients / np.sqrt(inner(basis, there, there))
    normal = Direction(unit, 0.0)
    base = basis.embed(film.basis, film.coefficients)
    found = correct(basis, base + amplitude * unit, film.beta, film.load, normal)
    if found is None:
        raise BranchError(f"no film at amplitude {amplitude:g}: try a smaller one")
    way = normal if amplitude > 0 else normal.reversed()
    return BranchPoint(found, branch_direction(found, way))


def join_symmetries(a: Family, b: Family) -> Family:
    """Return the symmetry that sums of displacements of two symmetries keep."""
    union = tuple(
        tuple(dict.fromkeys((*one, *other)))
        for one, other in zip(a.harmonics, b.harmonics, strict=True)
    )
    for family in (a, b):
        if all(set(u) == set(own) for u, own in zip(union, family.harmonics, strict=True)):
            return family
    return Family(f"{a.name} + {b.name}", (union[0], union[1], union[2]))
