"""The distinct equilibria of a film at one load, sought in two ways apart from each other.

By starts: from random loops, a few steps towards an equilibrium of a random Morse index,
and then Newton's method, which comes to equilibria of any. By deflation: from what is
known, displaced at random and most along its softest modes, Newton's method with all that
is known divided out, again and again until it comes to nothing new (deflation.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.deflation import (
    Step,
    deflated,
    first,
    newton,
    search,
    towards_index,
)
from eulerplateau.branches.film_family import (
    FilmFamily,
    equilibrium,
    family_on,
    likeness_of,
    on_its_mesh,
)
from eulerplateau.branches.likeness import Likeness, symmetry_of
from eulerplateau.branches.loop_starts import circle, displaced, random_loop
from eulerplateau.branches.point import BranchPoint
from eulerplateau.loop import close_with_lengths
from eulerplateau.mesh import Shape
from eulerplateau.solvers import Equilibrium, Problem, solve
from eulerplateau.threads import one_thread

# At most so many steps towards an index, before Newton's.
_TOWARDS = 20
# Random loops are drawn so often at most: in a plane many cross themselves. And every so
# manieth is flat where strands touch: planar films in contact are reached from few others.
_DRAWS, _FLAT = 20, 3
# From one guess deflation finds so many at most.
_IN_A_ROW = 5
_Apart = Callable[[FilmFamily, FloatArray], FloatArray | None]
_Search = Callable[[FilmFamily, FloatArray, float, Step], BranchPoint | None]


@dataclass(frozen=True)
class Plan:
    """How equilibria are sought.

    Attributes
    ----------
    starts : int, random loops, and as many guesses for deflation
    index : int, the largest Morse index of interest
    distance : float, r.m.s. in units of L, up to which two equilibria are the same
    seed : int
    """

    starts: int = 100
    index: int = 4
    distance: float = 0.01
    seed: int = 1


@dataclass(frozen=True)
class Entry:
    """An equilibrium of a catalogue, and how it was found.

    Attributes
    ----------
    symmetry : str, in words: see symmetry_of
    starts, guesses : of int
        Numbers, from 1, of the random loops and of the guesses of deflation that led to it.
        Deflation finds nothing twice, but for the guess that ends where it was before.
    """

    equilibrium: Equilibrium
    symmetry: str
    starts: tuple[int, ...]
    guesses: tuple[int, ...]


@dataclass(frozen=True)
class _Met:
    """An equilibrium, and the numbers of the searches that have come to it."""

    point: BranchPoint
    searches: list[int]


def catalogue_at(
    problem: Problem,
    load: float,
    plan: Plan,
    searched: Callable[[], None] = lambda: None,
) -> list[Entry]:
    """Return the distinct equilibria that are found at a load, by their energies.

    Those of Morse index up to plan.index that the mesh resolves. `searched` is called after
    each of the 2 plan.starts searches.
    """
    problem = on_its_mesh(problem)
    same = likeness_of(problem, plan.distance)
    family = family_on(problem, problem.film.of_loop(problem.disk.shape), "load", load)
    finder = _Finder(problem, load, plan, same, searched, family, *_ways(problem))
    with one_thread():
        return finder.merged(finder.by_starts(), finder.by_deflation())


def _ways(problem: Problem) -> tuple[_Apart, _Search]:
    """Return how loops are taken apart that may touch, and how equilibria are sought."""
    if problem.loop.diameter is None:
        return lambda family, x: x, search
    # Loaded for such loops only.
    from eulerplateau.branches import contact_search

    return contact_search.apart, contact_search.search


@dataclass(frozen=True)
class _Finder:
    """What seeks the equilibria of a problem at a load.

    Attributes
    ----------
    family : the film near its disk
    apart : of the family and a loop (n, d), the loop near by that strands allow, if any
    search : of the family, such a loop, the load and a step, the equilibrium they lead to
    """

    problem: Problem
    load: float
    plan: Plan
    same: Likeness
    searched: Callable[[], None]
    family: FilmFamily
    apart: _Apart
    search: _Search

    def by_starts(self) -> list[_Met]:
        """Return what random loops come to."""
        rng = np.random.default_rng([self.plan.seed, 1])
        met: list[_Met] = []
        for number in range(1, self.plan.starts + 1):
            index, steps = rng.integers([self.plan.index + 1, _TOWARDS + 1])
            step = first(int(steps), towards_index(int(index)), newton)
            flat = self.problem.loop.diameter is not None and number % _FLAT == 0
            x = self._drawn(partial(self._random_loop, rng, 2 if flat else 3))
            found = self._search(self.problem.disk.shape, x, step)
            if found is not None:
                self._is_new(met, found, number)
            self.searched()
        return met

    def by_deflation(self) -> list[_Met]:
        """Return what deflation finds, from the equilibrium that a sweep begins at."""
        rng = np.random.default_rng([self.plan.seed, 2])
        met: list[_Met] = []
        # Where there is no such equilibrium, as of a soap film that is pinched: a circle.
        lowest, rest = solve(self.problem, self.load).shape, self.problem.disk.shape
        bases = (
            (lowest, self.family.film.project(lowest.x_loop)),
            (rest, self._in_film(circle(self.problem.loop))),
        )
        for shape, x in bases:
            base = self._search(shape, x, newton)
            if base is not None and not met:
                met.append(_Met(base, [0]))
        for number in range(1, self.plan.starts + 1):
            near = [known.point for known in met if self._matters(known.point)]
            if near:
                self._deflate(met, near[number % len(near)], rng, number)
            self.searched()
        return met

    def _deflate(
        self, met: list[_Met], around: BranchPoint, rng: np.random.Generator, number: int
    ) -> None:
        """Add what is found from one guess near an equilibrium, one after the other."""
        shape = equilibrium(around).shape
        x = self._drawn(partial(displaced, around, rng))
        for _ in range(_IN_A_ROW):
            step = deflated([known.point.x for known in met], self.same)
            found = self._search(shape, x, step)
            if found is None or not self._is_new(met, found, number):
                return

    def _drawn(self, draw: Callable[[], FloatArray]) -> FloatArray | None:
        """Return a loop (n, d) drawn at random, anew where strands would not come apart."""
        for _ in range(_DRAWS):
            x = self._loop_near(draw())
            if x is not None:
                return x
        return None

    def _random_loop(self, rng: np.random.Generator, dimension: int) -> FloatArray:
        """Return a random loop (n, d), in a plane if its dimension is 2."""
        x = random_loop(self.problem.loop, rng)
        x[:, dimension:] = 0.0
        return self._in_film(x)

    def _in_film(self, x: FloatArray) -> FloatArray:
        """Return a loop (n, 3) in the film's coordinates (n, d), flat if they are."""
        flat: FloatArray = x[:, : self.problem.film.dimension]
        return flat

    def _loop_near(self, x: FloatArray) -> FloatArray | None:
        """Return a loop near x (n, d) that keeps its lengths, its strands apart."""
        closed = close_with_lengths(self.problem.loop, x)
        return None if closed is None else self.apart(self.family, closed)

    def _search(self, near: Shape, x: FloatArray | None, step: Step) -> BranchPoint | None:
        """Return the equilibrium that steps lead to from a loop, the film near a shape."""
        if x is None:
            return None
        film, lifted = self.problem.film, self.family.film.lift(x)
        try:
            shape = film.prepared(film.carried(near, lifted))
            family = replace(self.family, film=film.of_loop(shape))
            return self.search(family, family.film.project(shape.x_loop), self.load, step)
        except LinAlgError:  # no film across this loop
            return None

    def _is_new(self, met: list[_Met], point: BranchPoint, number: int) -> bool:
        """Count an equilibrium among those met; return whether it is new."""
        for known in met:
            if self._are_same(known.point, point):
                known.searches.append(number)
                return False
        met.append(_Met(point, [number]))
        return True

    def _are_same(self, one: BranchPoint, other: BranchPoint) -> bool:
        return self.same.distance(one.x, other.x) < self.plan.distance

    def _matters(self, point: BranchPoint) -> bool:
        """Return whether an equilibrium belongs into the catalogue."""
        if point.stability.n_unstable > self.plan.index:
            return False
        return self.problem.classified(equilibrium(point)).converged

    def merged(self, by_starts: list[_Met], by_deflation: list[_Met]) -> list[Entry]:
        """Return what was found in either way, by energy."""
        entries, rest = [], list(by_deflation)
        for met in by_starts:
            like = [self._are_same(one.point, met.point) for one in rest]
            twins = [one for one, is_twin in zip(rest, like, strict=True) if is_twin]
            rest = [one for one, is_twin in zip(rest, like, strict=True) if not is_twin]
            guesses = sorted(number for one in twins for number in one.searches)
            entries.append((met.point, met.searches, guesses))
        entries += [(one.point, [], one.searches) for one in rest]
        found = [
            Entry(
                self.problem.classified(equilibrium(point)),
                symmetry_of(point.x, self.same, self.plan.distance),
                tuple(starts),
                tuple(guesses),
            )
            for point, starts, guesses in entries
            if self._matters(point)
        ]
        return sorted(found, key=lambda entry: entry.equilibrium.energy)
