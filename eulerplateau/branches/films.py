"""Branches of a film: from a problem to its diagram, what one calls from Python."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.exploration import (
    DiagramPoint,
    Limits,
    explore_from,
    explore_on,
)
from eulerplateau.branches.film_family import (
    FilmFamily,
    equilibrium,
    family_near,
    family_of,
)
from eulerplateau.branches.point import (
    BranchPoint,
    StepControl,
    first_point,
    point_near,
)
from eulerplateau.branches.progress import Arrays, progress_from
from eulerplateau.errors import SpecError
from eulerplateau.mesh import Shape
from eulerplateau.solvers import (
    Equilibrium,
    Problem,
    Status,
    solve,
)
from eulerplateau.threads import one_thread, stepwise

# Unresolved is no obstacle: the rows say so.
_EQUILIBRIA = Status.CONVERGED, Status.UNRESOLVED


@dataclass(frozen=True, repr=False)
class FilmPoint(DiagramPoint):
    """A point of a film's diagram."""

    @property
    def load(self) -> float:
        """The film's load."""
        return self.point.value

    @cached_property
    def equilibrium(self) -> Equilibrium:
        """The film there, with all its numbers."""
        return equilibrium(self.point)

    @property
    def shape(self) -> Shape:
        """Its shape."""
        return self.equilibrium.shape

    @property
    def critical_mode(self) -> FloatArray | None:
        """How the film (n_v, 3) moves in a special point's critical mode; else None."""
        if self.special is None:
            return None
        point = self.special.point
        return family_of(point).film.displacement(point.x, self.special.mode)

    def __repr__(self) -> str:
        """Return one line: branch, load, Morse index and what is special."""
        kind = "" if self.special is None else f", {self.special.kind} {self.number}"
        return (
            f"<FilmPoint on branch {self.branch} at load {self.load:.6g}: "
            f"{self.point.stability.n_unstable} unstable{kind}>"
        )


def film_point(found: Equilibrium, problem: Problem, control: StepControl) -> BranchPoint:
    """Return the branch point at an equilibrium, heading for higher loads."""
    family, x_loop = family_near(problem, found.shape)
    return first_point(family, x_loop, found.load, control)


def equilibrium_near(problem: Problem, shape: Shape, load: float) -> Equilibrium:
    """Return the equilibrium next to a shape at a load, stable or not.

    Raises SpecError where Newton's method comes to none.
    """
    family, x_loop = family_near(problem, shape)
    with one_thread():
        found = point_near(family, x_loop, load)
        if found is None:
            raise SpecError("start", f"no equilibrium is next to it at the load {load:g}")
        return equilibrium(found)


def first_equilibrium(
    problem: Problem, load: float, start: Shape | None = None
) -> Equilibrium:
    """Return the equilibrium that a start, by default the rest shape, leads to.

    It lies on the disk's own triangles: what the way there has made of them is no part of
    its state. Raises SpecError where there is none.
    """
    found = solve(problem, load, start)
    if found.status not in _EQUILIBRIA:
        raise SpecError(
            "branches.load_min",
            f"no equilibrium found at {load:g} ({found.status.value}): start elsewhere",
        )
    return replace(found, shape=problem.disk.shape.moved(found.shape.x))


def explore(
    problem: Problem,
    window: tuple[float, float],
    start: Equilibrium | None = None,
    *,
    special_points: int = 8,
    unstable_modes: int = 3,
    progress: Arrays | None = None,
) -> Iterator[FilmPoint]:
    """Yield the points of all branches of a film that hang together with a start.

    Folds and bifurcations are among them, located by an eigenvalue's crossing; their
    `special` says what they are.

    Parameters
    ----------
    window : (low, high), loads, 0 < low < high
    start : an equilibrium in the window, from which branches go both ways
        By default the minimum that the rest shape leads to at the lowest load.
    special_points : int
        New branches are followed from the first so many special points.
    unstable_modes : int
        A branch is left where it has more unstable modes than this.
    progress : what `point.then.arrays()` was after a point of this very exploration
        It goes on after that point, and asks for no start.

    Raises
    ------
    SpecError : for a wrong window, or a start that is no equilibrium in it
    """
    low, high = (float(end) for end in window)
    if not 0 < low < high:
        raise SpecError("window", f"found ({low:g}, {high:g}); should be 0 < low < high")
    if problem.film.dimension != 3:
        raise SpecError("problem", "should not be kept in its plane: branches leave it")
    control = StepControl(window=(low, high), unit=high)
    limits = Limits(special_points, unstable_modes)
    if progress is not None:
        return _continued(problem, progress, control, limits)
    found = first_equilibrium(problem, low) if start is None else start
    if found.status not in _EQUILIBRIA:
        what = f"is no equilibrium ({found.status.value})"
        raise SpecError("start", f"{what}: {found.status.advice}")
    if not low <= found.load <= high:
        raise SpecError("start", f"has the load {found.load:g}, outside the window")
    return _explored(problem, found, control, limits)


def _explored(
    problem: Problem, found: Equilibrium, control: StepControl, limits: Limits
) -> Iterator[FilmPoint]:
    def explored() -> Iterator[DiagramPoint]:
        start = film_point(found, problem, control)
        inside = found.load > control.window[0]
        return explore_from(start, control, limits, both_ways=inside)

    for visited in stepwise(explored):
        yield FilmPoint(**vars(visited))


def _continued(
    problem: Problem, progress: Arrays, control: StepControl, limits: Limits
) -> Iterator[FilmPoint]:
    def explored() -> Iterator[DiagramPoint]:
        family = FilmFamily(problem, problem.film.of_loop(problem.disk.shape))
        return explore_on(progress_from(progress, family), control, limits)

    for visited in stepwise(explored):
        yield FilmPoint(**vars(visited))
