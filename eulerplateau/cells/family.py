"""Branches of a cell's equilibria, stable or not, in its contractility or its stiffness."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import (
    Arrays,
    BranchPoint,
    DiagramPoint,
    Limits,
    StepControl,
    UnboundedFamily,
    explore_from,
    explore_on,
    first_point,
    point_near,
    progress_from,
)
from eulerplateau.cells.cell import Cell, shortest_edge
from eulerplateau.cells.equilibrium import CellEquilibrium, measured, status_of
from eulerplateau.cells.solving import solve_cell
from eulerplateau.cells.touching import touches
from eulerplateau.errors import SpecError
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers import Status, TangentModel
from eulerplateau.threads import one_thread, stepwise

PARAMETERS = "load", "stiffness"

# Unresolved is no obstacle: the rows say so.
_EQUILIBRIA = Status.CONVERGED, Status.UNRESOLVED
# Arclengths for cells, which are some R0 across: |p|^2 is summed along all of their edge.
_FIRST_STEP, _LARGEST_STEP = 0.02, 0.1


@dataclass(frozen=True)
class CellFamily(UnboundedFamily):
    """A cell under one contractility, or stiffness of its adhesions, after another.

    Attributes
    ----------
    parameter : "load" for sigma_hat, "stiffness" for ks_hat
    fixed : float, the other one
    edge : float, about how long the shortest edge is
    """

    cell: Cell
    parameter: str
    fixed: float
    edge: float

    def __post_init__(self) -> None:
        """Refuse a parameter that a cell does not have."""
        if self.parameter not in PARAMETERS:
            known = " or ".join(repr(name) for name in PARAMETERS)
            raise SpecError("parameter", f"found {self.parameter!r}; should be {known}")

    def pair(self, value: float) -> tuple[float, float]:
        """Return (sigma_hat, ks_hat) at a value of the parameter."""
        loads = self.parameter == "load"
        return (value, self.fixed) if loads else (self.fixed, value)

    def energy(self, value: float) -> LoopEnergy:
        """Return the energy at a value of the parameter."""
        return self.cell.energy(*self.pair(value), self.edge)

    def with_value(self, parameter: str, value: float) -> CellFamily:
        """Return the family at another value of the parameter that it does not vary."""
        return self if parameter == self.parameter else replace(self, fixed=value)

    def positions(self, x: FloatArray) -> FloatArray:
        """Return the loop (n, 2) as it is."""
        return x

    def near(self, x: FloatArray) -> CellFamily:
        """Return the family good where edges are as short as those of a loop (n, 2)."""
        return replace(self, edge=shortest_edge(x))

    def rests(self, model: TangentModel, value: float) -> bool:
        """Return True: nothing of a film in the plane turns."""
        return True

    def released(self, x: FloatArray) -> CellFamily:
        """Return the family itself: a film in the plane has nothing to release."""
        return self

    def kept(self, x: FloatArray) -> Mapping[str, NDArray[Any]]:
        """Return how long its shortest edge is."""
        return {"edge": np.array(self.edge)}

    def restored(self, kept: Mapping[str, NDArray[Any]]) -> CellFamily:
        """Return the family with that edge."""
        edge = float(kept["edge"])
        return self if edge == self.edge else replace(self, edge=edge)


@dataclass(frozen=True, repr=False)
class CellPoint(DiagramPoint):
    """A point of a cell's diagram."""

    @property
    def value(self) -> float:
        """The parameter, sigma_hat or ks_hat."""
        return self.point.value

    @cached_property
    def equilibrium(self) -> CellEquilibrium:
        """The cell there, with all its numbers."""
        return cell_equilibrium(self.point)

    def __repr__(self) -> str:
        """Return one line: branch, parameter, Morse index and what is special."""
        kind = "" if self.special is None else f", {self.special.kind} {self.number}"
        return (
            f"<CellPoint on branch {self.branch} at {self.point.family.parameter} "
            f"{self.value:.6g}: {self.point.stability.n_unstable} unstable{kind}>"
        )


def cell_equilibrium(point: BranchPoint) -> CellEquilibrium:
    """Return the equilibrium of a cell at a point of one of its branches."""
    family = cast(CellFamily, point.family)
    return measured(
        family.cell,
        point.x,
        *family.pair(point.value),
        residual=point.model.residual,
        iterations=point.corrections,
        stability=point.stability,
        status=status_of(family.cell, point.model, point.stability, Status.CONVERGED),
    )


def cell_near(
    cell: Cell, x: FloatArray, sigma_hat: float, ks_hat: float
) -> CellEquilibrium:
    """Return the equilibrium next to a loop x (n, 2), stable or not.

    Raises SpecError where Newton's method comes to none.
    """
    family = CellFamily(cell, "load", ks_hat, shortest_edge(x))
    with one_thread():
        found = point_near(family, x, sigma_hat)
        if found is None:
            raise SpecError("start", f"no equilibrium is next to it at {sigma_hat:g}")
        return cell_equilibrium(found)


def explore_cell(
    cell: Cell,
    parameter: str,
    window: tuple[float, float],
    fixed: float,
    start: CellEquilibrium | None = None,
    *,
    special_points: int = 8,
    unstable_modes: int = 3,
    progress: Arrays | None = None,
) -> Iterator[CellPoint]:
    """Yield the points of all branches of a cell that hang together with a start.

    Folds and bifurcations are among them; their `special` says what they are. A branch
    ends where the edge meets itself: its last point is the first that does.

    Parameters
    ----------
    parameter : "load" for sigma_hat, "stiffness" for ks_hat
    window : (low, high), values of it, 0 < low < high
    fixed : float, the other one
    start : an equilibrium in the window, from which branches go both ways
        By default the minimum at the lowest value.
    special_points : int
        New branches are followed from the first so many special points.
    unstable_modes : int
        A branch is left where it has more unstable modes than this.
    progress : what `point.then.arrays()` was after a point of this very exploration
        It goes on after that point, and asks for no start.

    Raises
    ------
    SpecError : for a wrong parameter or window, or a start that is no equilibrium in it
    """
    family = CellFamily(cell, parameter, fixed, cell.edge)
    low, high = (float(end) for end in window)
    if not 0 < low < high:
        raise SpecError("window", f"found ({low:g}, {high:g}); should be 0 < low < high")
    control = StepControl(
        window=(low, high),
        unit=high,
        first_step=_FIRST_STEP,
        largest_step=_LARGEST_STEP,
    )
    limits = Limits(special_points, unstable_modes, lambda point: touches(point.x))
    if progress is not None:
        return _continued(progress, family, control, limits)
    found = solve_cell(cell, *family.pair(low)) if start is None else start
    value = _value_of(found, family)
    if not low <= value <= high:
        raise SpecError("start", f"has {parameter} {value:g}, outside the window")
    return _explored(family.near(found.x), found.x, value, control, limits)


def _explored(
    family: CellFamily, x: FloatArray, value: float, control: StepControl, limits: Limits
) -> Iterator[CellPoint]:
    def explored() -> Iterator[DiagramPoint]:
        start = first_point(family, x, value, control)
        inside = value > control.window[0]
        return explore_from(start, control, limits, both_ways=inside)

    yield from up_to_contact(CellPoint(**vars(point)) for point in stepwise(explored))


def _continued(
    arrays: Arrays, family: CellFamily, control: StepControl, limits: Limits
) -> Iterator[CellPoint]:
    progress = progress_from(arrays, family)
    points = stepwise(lambda: explore_on(progress, control, limits))
    # Of the branch it was kept on points have been seen, or it would not have been kept.
    seen = {progress.branch}
    yield from up_to_contact((CellPoint(**vars(point)) for point in points), seen)


def up_to_contact(
    points: Iterable[CellPoint], before: Collection[int] = ()
) -> Iterator[CellPoint]:
    """Yield the points of each branch up to the first that meets itself, included.

    A special point located beyond that, or a branch that leaves one, is no cell's. Of the
    branches `before` points have been seen already.
    """
    seen = set(before)
    ended: set[int] = set()
    for point in points:
        if touches(point.point.x):
            if point.special is not None or point.branch not in seen - ended:
                continue
            ended.add(point.branch)
        seen.add(point.branch)
        yield point


def _value_of(found: CellEquilibrium, family: CellFamily) -> float:
    """Return the parameter's value at a start; SpecError if it is of no use."""
    if found.status not in _EQUILIBRIA:
        what = f"is no equilibrium ({found.status.value})"
        raise SpecError("start", f"{what}: {found.status.advice}")
    pair = found.sigma_hat, found.ks_hat
    value = pair[PARAMETERS.index(family.parameter)]
    if family.pair(value) != pair:
        raise SpecError("start", f"has not the other parameter at {family.fixed:g}")
    return value
