"""Which shapes of a run are meant: by step, by load, the distinct ones."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from eulerplateau.errors import SpecError
from eulerplateau.runs import Run


def chosen_steps(run: Run, steps: Sequence[int], loads: Sequence[float]) -> list[int]:
    """Return the steps asked for by number and by load, each once, in the run's order.

    With neither it is one step per distinct state, or the last if none converged.
    """
    if not steps and not loads:
        return run.distinct_steps() or [run.rows[-1].step]
    wanted = set(_known(run, steps)).union(*(_nearest(run, load) for load in loads))
    return [row.step for row in run.rows if row.step in wanted]


def _known(run: Run, steps: Sequence[int]) -> Sequence[int]:
    known = [row.step for row in run.rows]
    for step in steps:
        if step not in known:
            problem = f"the run has no step {step}, only {min(known)} to {max(known)}"
            raise SpecError("--step", problem)
    return steps


def _nearest(run: Run, load: float) -> list[int]:
    """Return the step nearest to `load` on each branch, or leg, that reaches it."""
    found = []
    for series in run.series:
        if series.loads.min() <= load <= series.loads.max():
            nearest = np.argmin(np.abs(series.loads - load))
            found.append(series.rows[nearest].step)
    if not found:
        loads = [row.load for row in run.rows]
        problem = f"no branch reaches {load:g}: loads are {min(loads):g} to {max(loads):g}"
        raise SpecError("--load", problem)
    return found
