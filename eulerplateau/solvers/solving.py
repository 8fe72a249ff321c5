"""Solve at one load, or follow a film over many: what one calls from Python."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from importlib import import_module
from typing import Protocol, cast

import numpy as np
from numpy.typing import ArrayLike

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.loop import LEAST, MOST
from eulerplateau.mesh import Shape
from eulerplateau.solvers.equilibrium import Equilibrium
from eulerplateau.solvers.problem import Problem
from eulerplateau.solvers.start import coarse, displaced
from eulerplateau.threads import one_thread

# By the names of solver.name in a run's specification; only the one asked for is loaded.
SOLVERS = {"newton": "newton", "cg": "conjugate_gradient", "cg-plain": "plain_gradient"}

Start = Shape | Equilibrium | ArrayLike
Step = tuple[Problem, float]


class Minimise(Protocol):
    """A solver: `minimise` of newton, conjugate_gradient or plain_gradient."""

    def __call__(
        self,
        problem: Problem,
        load: float,
        start: Shape,
        tensions: FloatArray | None,
        max_iterations: int | None,
        observe: Callable[[FloatArray], None],
    ) -> Equilibrium:
        """Return the minimum reached from a start, or the best there is to say."""


def solve(
    problem: Problem,
    load: float,
    start: Start | None = None,
    *,
    tensions: ArrayLike | None = None,
    solver: str = "newton",
    max_iterations: int | None = None,
    observe: Callable[[FloatArray], None] | None = None,
) -> Equilibrium:
    """Return the minimum of the energy that a start leads to.

    Not converging raises nothing: the result's `status` says so.

    Parameters
    ----------
    load : float, not negative
        k L^3 / alpha of springs, sigma L^3 / alpha of other films.
    start : Shape, Equilibrium, or positions (n_v, 3) in units of L
        By default the rest shape, each vertex displaced by about 1e-3 across its plane. Of
        films with fixed weights only the loop matters; a soap film's interior is where its
        mesh lies. An equilibrium brings its tensions along.
    tensions : (n_b,) float
        Those that belong to the start, where they are known: they save time.
    solver : "newton", "cg", or "cg-plain" (the paper's method as it is)
    max_iterations : int
        Where to give up; by default 500 of newton's, 20,000 of cg's, a million of
        cg-plain's.
    observe : function of the loop (n_b, 3)
        Shown it after every step.

    Raises
    ------
    SpecError : for an unknown solver, a wrong load, or arrays of the wrong size
    """
    shape, known = _start(problem, start)
    if tensions is not None:
        known = _tensions(shape, tensions)
    minimise = _named(solver)
    _check_knows_contact(problem, solver)
    show = (lambda x_loop: None) if observe is None else observe
    with one_thread():
        return minimise(problem, _load(load), shape, known, _limit(max_iterations), show)


def sweep(
    problem: Problem,
    loads: Iterable[float] | None = None,
    start: Start | None = None,
    *,
    parameter: str = "load",
    values: Iterable[float] | None = None,
    load: float | None = None,
    tensions: ArrayLike | None = None,
    solver: str = "newton",
    max_iterations: int | None = None,
) -> Iterator[Equilibrium]:
    """Yield one equilibrium per load, each started from the last shape.

    Or one per value of another `parameter`, "link" or "twist_ratio" of a loop that resists
    twist, "diameter" of one that has it, at one `load`. A shape that is not finite is
    yielded, and not started from. See `solve`.
    """
    if parameter == "load":
        if loads is None or values is not None or load is not None:
            raise SpecError("loads", "should be given, and neither values nor load")
        steps = [(problem, _load(each)) for each in loads]
    else:
        if loads is not None or values is None or load is None:
            problem_is = f"of {parameter} should be given, and a load in place of loads"
            raise SpecError("values", problem_is)
        given, held = check_values(problem, parameter, values), _load(load)
        steps = [problem.at(parameter, value, held) for value in given]
    return follow_steps(
        problem,
        steps,
        start,
        tensions=tensions,
        solver=solver,
        max_iterations=max_iterations,
    )


def follow_steps(
    problem: Problem,
    steps: Sequence[Step],
    start: Start | None = None,
    *,
    tensions: ArrayLike | None = None,
    solver: str = "newton",
    max_iterations: int | None = None,
) -> Iterator[Equilibrium]:
    """Yield one equilibrium per step (problem, load), each started from the last shape.

    The steps' problems are `problem` at other values of its loop's parameters.
    """
    shape, known = _start(problem, start)
    if tensions is not None:
        known = _tensions(shape, tensions)
    _check_knows_contact(problem, solver)
    return _swept(steps, shape, known, _named(solver), _limit(max_iterations))


def check_values(problem: Problem, parameter: str, values: Iterable[float]) -> list[float]:
    """Return values of a parameter of a problem's loop; raises SpecError for wrong ones."""
    known = problem.loop.parameters
    if parameter not in known:
        names = " or ".join(repr(name) for name in ("load", *known))
        raise SpecError("parameter", f"found {parameter!r}; should be {names} of this loop")
    try:
        found = [float(value) for value in values]
    except (TypeError, ValueError):
        raise SpecError(parameter, "should be numbers") from None
    most = MOST.get(parameter, np.inf)
    for value in found:
        if not (np.isfinite(value) and LEAST[parameter] < value <= most):
            wanted = "finite" if np.isinf(LEAST[parameter]) else "positive"
            upper = "" if np.isinf(most) else f", at most {most:g}"
            raise SpecError(parameter, f"found {value:g}; should be {wanted}{upper}")
    return found


def _swept(
    steps: Sequence[Step],
    shape: Shape,
    tensions: FloatArray | None,
    minimise: Minimise,
    limit: int | None,
) -> Iterator[Equilibrium]:
    for problem, load in steps:
        with one_thread():
            found = minimise(problem, load, shape, tensions, limit, lambda x_loop: None)
        yield found
        if np.isfinite(found.shape.x).all():
            shape, tensions = found.shape, found.tensions


def _check_knows_contact(problem: Problem, solver: str) -> None:
    if problem.loop.diameter is not None and solver != "newton":
        found = f"found {solver!r}, which knows no contact; a loop with a diameter"
        raise SpecError("solver", f"{found} takes 'newton'")


def _named(solver: str) -> Minimise:
    if solver not in SOLVERS:
        known = " or ".join(repr(name) for name in SOLVERS)
        raise SpecError("solver", f"found {solver!r}; should be {known}")
    module = import_module(f"eulerplateau.solvers.{SOLVERS[solver]}")
    return cast(Minimise, module.minimise)


def _start(problem: Problem, start: Start | None) -> tuple[Shape, FloatArray | None]:
    if start is None:
        return problem.shape(displaced(problem.disk, 1e-3, 1)), None
    if isinstance(start, Equilibrium):
        shape = _fitting(problem, start.shape)
        same = len(shape.loop) == len(start.tensions)
        return shape, start.tensions if same else None
    if isinstance(start, Shape):
        return _fitting(problem, start), None
    return problem.shape(start), None


def _fitting(problem: Problem, shape: Shape) -> Shape:
    """Return a shape the problem can begin with, or raise SpecError."""
    if not np.array_equal(shape.loop[shape.loop < problem.disk.n_v], problem.disk.loop):
        raise SpecError("start", "has another loop than the problem's disk: is it its own?")
    if shape.x.shape == problem.disk.x.shape:
        return shape
    if len(shape.x) < problem.disk.n_v:
        return problem.shape(shape.x)
    return shape if problem.refines else coarse(problem.tied_film(), problem.disk, shape)


def _tensions(shape: Shape, tensions: ArrayLike) -> FloatArray:
    found = np.asarray(tensions, dtype=np.float64)
    if found.shape != shape.loop.shape:
        n_b = len(shape.loop)
        raise SpecError("tensions", f"have shape {found.shape}; should be ({n_b},)")
    return found


def _load(load: float) -> float:
    try:
        value = float(load)
    except (TypeError, ValueError):
        raise SpecError("load", f"found {load!r}; should be a number") from None
    if np.isnan(value) or value < 0:
        raise SpecError("load", f"found {value:g}; should not be negative")
    return value


def _limit(max_iterations: int | None) -> int | None:
    if max_iterations is not None and max_iterations < 1:
        raise SpecError("max_iterations", f"found {max_iterations}; should be 1 or more")
    return max_iterations
