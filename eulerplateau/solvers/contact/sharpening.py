"""Strands held exactly where they are nearest to each other.

An exchange (everywhere.py) ends with places held on both sides of one where strands are
nearest, to a part of an edge. In their stead one is held at the very place: as a point of
contact that slides, which Newton's method finds to rounding. That is the second of the two
phases of Hettich and Kortanek (1993, section 7.3), a reduction to finitely many gaps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Gaps, Strands, from_one_strand
from eulerplateau.solvers.contact.keeping import Touching

# No place is held beside another that is nearer than this, in edges.
BESIDE = 0.02
# Parts of the diameter: gaps that may be closed; by which strands may overlap in the end.
_CLOSE, _OVERLAP = 1e-5, 1e-9
# Rounds in which such places change.
_ROUNDS = 20

State = TypeVar("State", bound=Touching)


def sharpened(
    strands: Strands, state: State, rest: Callable[[FloatArray, Gaps], State | None]
) -> State | None:
    """Return the state at rest with strands held where they are nearest; None if lost.

    rest : returns the state at rest next to a loop (n, d), with gaps closed
    """
    crosses = state.gaps[state.gaps.slides]
    beside, x = state.gaps[~state.gaps.slides], state.model.x

    def nearest(reach: float, held: Gaps) -> Gaps:
        low = strands.nearest(x, reach * strands.diameter)
        low = low[strands.unlike(low, held, BESIDE)]
        low = from_one_strand(strands.knots, low[strands.distinct(low, BESIDE)], beside)
        return replace(low, slides=~low.slides)

    gaps = crosses.joined(nearest(_CLOSE, crosses))
    for _ in range(_ROUNDS):
        found = rest(x, gaps)
        if found is None:
            return None
        x, gaps = found.model.x, found.gaps
        if (found.forces < -found.uncertain).any():
            gaps = gaps[found.forces > found.forces.min()]
            continue
        others = nearest(-_OVERLAP, gaps)
        if not len(others):
            slides = ~strands.unlike(gaps, crosses, BESIDE)
            return rest(x, replace(gaps, slides=slides))
        gaps = gaps.joined(others)
    return None
