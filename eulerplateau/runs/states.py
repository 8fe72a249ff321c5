"""Which states a run shows: a film's planar or not, the distinct ones, one row for each."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from eulerplateau.runs.rows import Row

# Below this the loop's normal curvature is a remnant of the transverse kick and of soft
# modes near onset; a twisted state 1e-3 (relative) above its onset is well above it.
_PLANAR_BELOW = 0.05
# Strands that touch in a plane have one direction, but for such remnants. Those that cross
# (in degrees) are a diameter apart across every plane, though the film of a thin line is
# all but flat elsewhere.
_CROSSED_ABOVE = 1.0
# A planar film this round is called a disk, a longer one an ellipse (or an eight).
_ROUND_ABOVE = 0.95
# A saddle is shown from this part of its largest normal curvature on.
_FULL = 0.8
# Stable states of branches that differ by less than this part of the largest are alike.
_ALIKE = 0.01
# A stretch of fewer points is a stub, beside a special point whose eigenvalue has no sign.
_STUB = 4


@dataclass(frozen=True)
class States:
    """How the states of what a run follows are told apart.

    Attributes
    ----------
    of : of a row its state; None if it is none. Successive rows of one state are one
    shown : of such rows, those that show the state
    measure : of a row, what tells two states of one load apart
    between : of a first leg the loads to be looked at more closely, if there are any
    """

    of: Callable[[Any], Hashable]
    shown: Callable[[list[Any]], Sequence[Any]]
    measure: Callable[[Any], float]
    between: Callable[[Sequence[Any]], tuple[float, float] | None]


def is_planar(row: Row) -> bool:
    """Whether the film lies in a plane, judged by the integral of |kappa_n| ds.

    One whose strands cross does not, however little it bends.
    """
    crossing_angle = getattr(row, "crossing_angle", None) or 0.0
    return row.abs_kappa_n < _PLANAR_BELOW and crossing_angle < _CROSSED_ABOVE


def between_planar(rows: Sequence[Row]) -> tuple[float, float] | None:
    """Return the loads between which a film first leaves its plane and returns to it."""
    ascending = sorted(rows, key=lambda row: row.load)
    states = [(planar, list(alike)) for planar, alike in groupby(ascending, key=is_planar)]
    for (before, _), (planar, bent), (after, _) in zip(
        states, states[1:], states[2:], strict=False
    ):
        if before and after and not planar:
            return bent[0].load, bent[-1].load
    return None


def _kind(row: Row) -> tuple[bool, int, bool] | None:
    if not row.converged:
        return None
    if not is_planar(row):
        return False, 0, bool(row.self_intersections)
    half_turns = 0 if math.isnan(row.waist_twist) else round(abs(row.waist_twist) / 180.0)
    return True, half_turns, row.aspect > _ROUND_ABOVE


def _shown(state: list[Row]) -> list[Row]:
    if is_planar(state[0]):
        return [state[-1]]
    if state[0].self_intersections:
        return [max(state, key=lambda row: (row.self_intersections, row.abs_kappa_n))]
    largest = max(row.abs_kappa_n for row in state)
    full = [row for row in state if row.abs_kappa_n >= _FULL * largest]
    return [min(full, key=lambda row: row.load)]


# A film's state is a stretch of successive converged rows of one kind: not planar, and
# cutting through itself or not; or planar with the same number of half turns across the
# waist and alike in being round or not. A planar state is shown by its last row; one that
# cuts through itself where most triangles cross, or else where the integral of |kappa_n| ds
# is largest; and a saddle that does not at the lowest load where that integral comes close
# to its largest value, before the saddle overhangs.
FILM_STATES = States(_kind, _shown, lambda row: float(row.abs_kappa_n), between_planar)


def distinct_steps(rows: Sequence[Any], states: States = FILM_STATES) -> list[int]:
    """Return the steps that show the distinct states of a sweep, in its order."""
    known = [row for row in rows if states.of(row) is not None]
    stretches = [list(alike) for _, alike in groupby(known, key=states.of)]
    return [row.step for stretch in stretches for row in states.shown(stretch)]


def stable_states(
    stretches: Sequence[Sequence[Any]], states: States = FILM_STATES
) -> list[Any]:
    """Return the middle row of each stable stretch of a branch that is no stub.

    Of those alike in load and measure, which are mirror images, the first.
    """
    rows = [part[len(part) // 2] for part in stretches if len(part) >= _STUB]
    load = _ALIKE * max((abs(row.load) for row in rows), default=0.0)
    bend = _ALIKE * max((abs(states.measure(row)) for row in rows), default=0.0)
    kept: list[Any] = []
    for row in rows:
        if not any(
            abs(row.load - other.load) <= load
            and abs(states.measure(row) - states.measure(other)) <= bend
            for other in kept
        ):
            kept.append(row)
    return kept
