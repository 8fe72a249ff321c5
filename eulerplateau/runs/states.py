"""Which states a run shows: planar or not, the distinct ones, one row for each."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import groupby

from eulerplateau.runs.table import Row

# Below this the loop's normal curvature is a remnant of the transverse kick and of soft
# modes near onset; a twisted state 1e-3 (relative) above its onset is well above it.
_PLANAR_BELOW = 0.05
# A planar film this round is called a disk, a longer one an ellipse (or an eight).
_ROUND_ABOVE = 0.95
# A saddle is shown from this part of its largest normal curvature on.
_FULL = 0.8
# Stable states of branches that differ by less than this part of the largest are alike.
_ALIKE = 0.01
# A stretch of fewer points is a stub, beside a special point whose eigenvalue has no sign.
_STUB = 4


def is_planar(row: Row) -> bool:
    """Whether the film lies in a plane, judged by the integral of |kappa_n| ds."""
    return row.abs_kappa_n < _PLANAR_BELOW


def distinct_steps(rows: Sequence[Row]) -> list[int]:
    """Return one step per distinct state of a sweep, in the order of the rows.

    A state is a stretch of successive converged rows of one kind: not planar, and cutting
    through itself or not; or planar with the same number of half turns across the waist
    and alike in being round or not. A planar state is shown by its last row; one that cuts
    through itself where most triangles cross, or else where the integral of |kappa_n| ds
    is largest; and a saddle that does not at the lowest load where that integral comes
    close to its largest value, before the saddle overhangs.
    """
    converged = [row for row in rows if row.converged]
    states = [list(alike) for _, alike in groupby(converged, key=_kind)]
    return [_shown(state).step for state in states]


def planar_stretches(rows: Sequence[Row]) -> list[tuple[bool, list[Row]]]:
    """Return the stretches of rows that are alike in being planar, and whether they are."""
    return [(planar, list(alike)) for planar, alike in groupby(rows, key=is_planar)]


def between_planar(rows: Sequence[Row]) -> tuple[float, float] | None:
    """Return the loads between which a film first leaves its plane and returns to it."""
    ascending = sorted(rows, key=lambda row: row.load)
    states = planar_stretches(ascending)
    for (before, _), (planar, bent), (after, _) in zip(
        states, states[1:], states[2:], strict=False
    ):
        if before and after and not planar:
            return bent[0].load, bent[-1].load
    return None


def stable_states(stretches: Sequence[Sequence[Row]]) -> list[Row]:
    """Return the middle row of each stable stretch of a branch that is no stub.

    Of those alike in load and order parameter, which are mirror images, the first.
    """
    rows = [part[len(part) // 2] for part in stretches if len(part) >= _STUB]
    load = _ALIKE * max((row.load for row in rows), default=0.0)
    bend = _ALIKE * max((row.abs_kappa_n for row in rows), default=0.0)
    kept: list[Row] = []
    for row in rows:
        if not any(
            abs(row.load - other.load) <= load
            and abs(row.abs_kappa_n - other.abs_kappa_n) <= bend
            for other in kept
        ):
            kept.append(row)
    return kept


def _shown(state: list[Row]) -> Row:
    if is_planar(state[0]):
        return state[-1]
    if state[0].self_intersections:
        return max(state, key=lambda row: (row.self_intersections, row.abs_kappa_n))
    largest = max(row.abs_kappa_n for row in state)
    full = [row for row in state if row.abs_kappa_n >= _FULL * largest]
    return min(full, key=lambda row: row.load)


def _kind(row: Row) -> tuple[bool, int, bool]:
    if not is_planar(row):
        return False, 0, bool(row.self_intersections)
    half_turns = 0 if math.isnan(row.waist_twist) else round(abs(row.waist_twist) / 180.0)
    return True, half_turns, row.aspect > _ROUND_ABOVE
