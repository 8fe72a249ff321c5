"""Branches of a film: from a problem to its diagram, what one calls from Python."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.control import Hyperplane, StepControl
from eulerplateau.branches.exploration import (
    DiagramPoint,
    Limits,
    explore_from,
    explore_on,
)
from eulerplateau.branches.film_family import (
    equilibrium,
    family_near,
    family_of,
    family_on,
    on_its_mesh,
    recorded,
)
from eulerplateau.branches.point import BranchPoint, across_values, first_point, point_near
from eulerplateau.branches.progress import Arrays, progress_from
from eulerplateau.errors import SpecError
from eulerplateau.loop import LEAST, MOST
from eulerplateau.mesh import Shape
from eulerplateau.solvers import (
    Equilibrium,
    Problem,
    Status,
    check_values,
    solve,
)
from eulerplateau.threads import one_thread, stepwise

# Unresolved is no obstacle: the rows say so.
_EQUILIBRIA = Status.CONVERGED, Status.UNRESOLVED


@dataclass(frozen=True, repr=False)
class FilmPoint(DiagramPoint):
    """A point of a film's diagram.

    Strands of a loop with a diameter overlap nowhere: `recorded` is next to `point`, from
    which the branch goes on.
    """

    @cached_property
    def recorded(self) -> BranchPoint:
        """What is said of it: the point, or that next to it without overlaps."""
        return recorded(self.point, self.point.direction)

    @property
    def value(self) -> float:
        """The parameter that is varied: the load, or the link."""
        return self.recorded.value

    @property
    def load(self) -> float:
        """The film's load."""
        return family_of(self.recorded).at(self.value)[1]

    @property
    def problem(self) -> Problem:
        """The problem of which it is an equilibrium at that load."""
        return family_of(self.recorded).at(self.value)[0]

    @cached_property
    def equilibrium(self) -> Equilibrium:
        """The film there, with all its numbers."""
        return equilibrium(self.recorded)

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
        name = self.point.family.parameter
        return (
            f"<FilmPoint on branch {self.branch} at {name} {self.value:.6g}: "
            f"{self.point.stability.n_unstable} unstable{kind}>"
        )


def film_point(
    found: Equilibrium, problem: Problem, control: StepControl, parameter: str = "load"
) -> BranchPoint:
    """Return the branch point at an equilibrium, heading for higher values."""
    near = family_near(problem, found.shape, parameter, found.load, found.contacts)
    family, x_loop = near
    first = first_point(family, x_loop, problem.value(parameter, found.load), control)
    way = across_values(first.x, control.unit)
    plane = Hyperplane(first.x, first.value, way, control)
    return family.settled(first, plane) or first


def equilibrium_near(
    problem: Problem, shape: Shape, load: float, parameter: str = "load"
) -> Equilibrium:
    """Return the equilibrium next to a shape at a load, stable or not.

    `parameter` is what is to be varied from there on. Raises SpecError where Newton's
    method comes to none.
    """
    family, x_loop = family_near(problem, shape, parameter, load)
    value = problem.value(parameter, load)
    with one_thread():
        found = point_near(family, x_loop, value, LEAST[parameter])
        if found is None:
            where = f"the {parameter} {value:g}"
            raise SpecError("start", f"no equilibrium is next to it at {where}")
        return equilibrium(recorded(found, across_values(found.x, 1.0)))


def where_from(
    problem: Problem, parameter: str, window: tuple[float, float], load: float
) -> tuple[Problem, float]:
    """Return the problem and its load where an exploration starts that is not told where.

    At the loop's own value of the parameter, if that lies in the window; else, and of the
    load, at the window's lowest.
    """
    low, high = window
    own = problem.value(parameter, low)
    return problem.at(parameter, own if low <= own <= high else low, load)


def first_equilibrium(
    problem: Problem, load: float, start: Shape | None = None, parameter: str = "load"
) -> Equilibrium:
    """Return the equilibrium that a start, by default the rest shape, leads to.

    It lies on the disk's own triangles: what the way there has made of them is no part of
    its state. Raises SpecError where there is none.
    """
    found = solve(on_its_mesh(problem), load, start)
    if found.status not in _EQUILIBRIA:
        value, lost = problem.value(parameter, load), found.status.value
        raise SpecError(
            "branches.load_min" if parameter == "load" else "branches.low",
            f"no equilibrium found at {value:g} ({lost}): start elsewhere",
        )
    return replace(found, shape=problem.disk.shape.moved(found.shape.x))


def explore(
    problem: Problem,
    window: tuple[float, float],
    start: Equilibrium | None = None,
    *,
    parameter: str = "load",
    load: float | None = None,
    special_points: int = 8,
    unstable_modes: int = 3,
    progress: Arrays | None = None,
) -> Iterator[FilmPoint]:
    """Yield the points of all branches of a film that hang together with a start.

    Folds and bifurcations are among them, located by an eigenvalue's crossing, and where
    strands of a loop with a diameter touch, part or split; their `special` says what they
    are.

    Parameters
    ----------
    window : (low, high), loads, 0 < low < high
        Or values of another parameter.
    start : an equilibrium of `problem` in the window, from which branches go both ways
        By default the minimum that the rest shape leads to at the lowest load; of another
        parameter at the problem's own value, if that is in the window.
    parameter : "load", or "link" or "twist_ratio" of a loop that resists twist, "diameter"
        of one that has it
    load : at which another parameter is varied; by default that of `start`
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
    control = _control(problem, parameter, window)
    limits = Limits(special_points, unstable_modes)
    if parameter != "load":
        limits = replace(limits, stop=_pinched)
    held = _held(parameter, load, start)
    if progress is not None:
        return _continued(problem, (parameter, held), progress, control, limits)
    found = start
    if found is None:
        problem, held = where_from(problem, parameter, control.window, held)
        found = first_equilibrium(problem, held, parameter=parameter)
    if found.status not in _EQUILIBRIA:
        what = f"is no equilibrium ({found.status.value})"
        raise SpecError("start", f"{what}: {found.status.advice}")
    value, (low, high) = problem.value(parameter, found.load), control.window
    if not low <= value <= high:
        raise SpecError("start", f"has the {parameter} {value:g}, outside the window")
    return _explored(problem, found, parameter, control, limits)


def _control(problem: Problem, parameter: str, window: tuple[float, float]) -> StepControl:
    """Return how branches in a window are followed; raises SpecError."""
    low, high = (float(end) for end in window)
    if parameter != "load":
        check_values(problem, parameter, ())
    least, most = LEAST[parameter], MOST.get(parameter, np.inf)
    if not (least < low < high <= most and high < np.inf):
        wanted = "low < high" if np.isinf(least) else f"{least:g} < low < high"
        wanted += "" if np.isinf(most) else f" <= {most:g}"
        raise SpecError("window", f"found ({low:g}, {high:g}); should be {wanted}")
    if problem.film.dimension != 3:
        raise SpecError("problem", "should not be kept in its plane: branches leave it")
    return StepControl((low, high), unit=max(abs(low), abs(high)), least=least)


def _pinched(point: BranchPoint) -> bool:
    """Return whether strands meet, which would pass through each other beyond."""
    return family_of(point).problem.loop.pinched(point.x)


def _held(parameter: str, load: float | None, start: Equilibrium | None) -> float:
    """Return the load at which another parameter is varied; raises SpecError."""
    if parameter == "load":
        if load is not None:
            raise SpecError("load", "should be absent where the load is varied")
        return 0.0
    if start is not None:
        if load not in (None, start.load):
            raise SpecError("load", f"found {load:g}; start has {start.load:g}")
        return start.load
    if load is None or not 0 <= load < np.inf:
        said = "is missing" if load is None else f"found {load:g}"
        raise SpecError("load", f"{said}: should be that at which {parameter} is varied")
    return float(load)


def _explored(
    problem: Problem,
    found: Equilibrium,
    parameter: str,
    control: StepControl,
    limits: Limits,
) -> Iterator[FilmPoint]:
    def explored() -> Iterator[DiagramPoint]:
        start = film_point(found, problem, control, parameter)
        inside = problem.value(parameter, found.load) > control.window[0]
        return explore_from(start, control, limits, both_ways=inside)

    for visited in stepwise(explored):
        yield FilmPoint(**vars(visited))


def _continued(
    problem: Problem,
    varied: tuple[str, float],
    progress: Arrays,
    control: StepControl,
    limits: Limits,
) -> Iterator[FilmPoint]:
    def explored() -> Iterator[DiagramPoint]:
        film = problem.film.of_loop(problem.disk.shape)
        family = family_on(problem, film, *varied)
        return explore_on(progress_from(progress, family), control, limits)

    for visited in stepwise(explored):
        yield FilmPoint(**vars(visited))
