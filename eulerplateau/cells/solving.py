"""Solve for a cell, or follow it over many values: what one calls from Python."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from time import perf_counter

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.cells.cell import Cell, shortest_edge
from eulerplateau.cells.equilibrium import CellEquilibrium, measured, status_of
from eulerplateau.cells.touching import Apart, crosses_itself, strands_near
from eulerplateau.errors import SpecError
from eulerplateau.solvers import DenseModels, Descent, Status, stability
from eulerplateau.threads import one_thread

_MAX_ITERATIONS = 500
# Beyond a cell of these statuses a sweep does not go.
ENDS = Status.TOUCHING, Status.COLLAPSED, Status.NOT_FINITE

CellStart = CellEquilibrium | ArrayLike


def solve_cell(
    cell: Cell,
    sigma_hat: float,
    ks_hat: float,
    start: CellStart | None = None,
    *,
    max_iterations: int = _MAX_ITERATIONS,
    observe: Callable[[FloatArray], None] = lambda x: None,
) -> CellEquilibrium:
    """Return the minimum of a cell's energy that a start leads to.

    Not converging raises nothing: the result's `status` says so. A descent ends where the
    edge meets itself, with the status "touching".

    Parameters
    ----------
    sigma_hat : float, not negative
    ks_hat : float, positive
    start : CellEquilibrium, or positions (n, 2) in units of R0
        By default arcs from site to site, or straight lines where arcs would cross.
    max_iterations : int, steps of the descent
    observe : function of the loop (n, 2), shown it after every step

    Raises
    ------
    SpecError : for a wrong value, or a start that is no loop of this cell
    """
    sigma, ks = _value("sigma_hat", sigma_hat, 0.0), _value("ks_hat", ks_hat)
    if max_iterations < 1:
        raise SpecError("max_iterations", f"found {max_iterations}; should be 1 or more")
    x = _start(cell, start)
    began = perf_counter()
    with one_thread():
        found = _descended(cell, x, sigma, ks, max_iterations, observe)
    return replace(found, seconds=perf_counter() - began)


def sweep_cell(
    cell: Cell,
    values: Iterable[tuple[float, float]],
    start: CellStart | None = None,
    *,
    max_iterations: int = _MAX_ITERATIONS,
) -> Iterator[CellEquilibrium]:
    """Yield one equilibrium per (sigma_hat, ks_hat), each started from the last.

    Ends where the edge meets itself: that is yielded, and nothing after it. See
    `solve_cell`.
    """
    for sigma_hat, ks_hat in values:
        found = solve_cell(cell, sigma_hat, ks_hat, start, max_iterations=max_iterations)
        yield found
        if found.status in ENDS:
            return
        start = found


def _descended(
    cell: Cell,
    x: FloatArray,
    sigma: float,
    ks: float,
    limit: int,
    observe: Callable[[FloatArray], None],
) -> CellEquilibrium:
    """Descend from a loop (n, 2), in an energy made anew where edges have changed."""
    guard, iterations = Apart(cell.shares, close=strands_near(x)), 0
    try:
        while True:
            energy = cell.energy(sigma, ks, shortest_edge(x))
            energy = replace(energy, terms={**energy.terms, "apart": guard})
            models = DenseModels(energy)
            state, searched = Descent(models, limit - iterations, observe).run(x)
            iterations, x = iterations + state.iteration, state.model.x
            broken_off = searched is Status.ITERATION_LIMIT and iterations < limit
            if not (broken_off and guard.holds(x)):
                break
        spectrum = state.stability or stability(state.model.dense)
    except (LinAlgError, ValueError):
        # Numbers that overflow make matrices that are not finite.
        return measured(cell, x, sigma, ks)
    return measured(
        cell,
        x,
        sigma,
        ks,
        residual=state.model.residual,
        iterations=iterations,
        stability=spectrum,
        status=status_of(cell, state.model.dense, spectrum, searched),
    )


def _start(cell: Cell, start: CellStart | None) -> FloatArray:
    """Return the loop (n, 2) to start from, its edges equal; raise SpecError."""
    if start is None:
        arcs = cell.round_start()
        x = cell.straight_start() if crosses_itself(arcs) else arcs
    else:
        given = start.x if isinstance(start, CellEquilibrium) else start
        x = np.array(given, dtype=np.float64)
    if x.shape != (cell.size, 2):
        raise SpecError("start", f"has shape {x.shape}; should be ({cell.size}, 2)")
    if not np.isfinite(x).all():
        raise SpecError("start", "is not finite; should be positions in units of R0")
    equal = cell.energy(0.0, 1.0).constraint.project(x)
    if equal is None:
        raise SpecError("start", "has edges that cannot be made equal: start elsewhere")
    if crosses_itself(equal):
        raise SpecError("start", "crosses itself: start elsewhere")
    return equal


def _value(name: str, value: float, least: float | None = None) -> float:
    """Return a finite number that is positive, or not below `least`; raise SpecError."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise SpecError(name, f"found {value!r}; should be a number") from None
    low = number > 0 if least is None else number >= least
    if not (np.isfinite(number) and low):
        wanted = "positive" if least is None else f"{least:g} or more"
        raise SpecError(name, f"found {number:g}; should be {wanted} and finite")
    return number
