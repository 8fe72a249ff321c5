"""Which places are held where strands lie along each other, so that no gap is negative.

An exchange for infinitely many inequalities (Hettich and Kortanek 1993, section 7), as that
of solvers.contact.everywhere, of states that may be saddles: places are closed where
strands overlap, and let go where they would pull, as a quadratic program tells. It ends
with places on both sides of one where strands are nearest. In their stead one is held at
the very place, as a point of contact that slides, which Newton's method finds to rounding:
their second phase (section 7.3), a reduction to finitely many gaps.

Loaded only for loops that have a diameter.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.branches.places import FLAT, single
from eulerplateau.interruption import heed
from eulerplateau.loop import (
    ALONG,
    NO_GAPS,
    Gaps,
    LoopEnergy,
    Strands,
    from_one_strand,
    with_gaps_held,
)
from eulerplateau.solvers import (
    SOFTEST_BENDING,
    Program,
    TangentModel,
    Touching,
    loosened,
)

# Parts of the diameter: by which strands may overlap between places on the way, and in the
# end, where these are nearest; and gaps that may be closed there.
_OVERLAP, _SHARP, _EXACT, _CLOSE = 1e-6, 1e-9, 1e-12, 1e-5
# No place is held beside another that is nearer than this, in edges; those that cannot be
# closed at once hang together: of those within so many of one before them, it alone is.
_BESIDE, _TOGETHER = 0.02, (0.0, 0.1, 0.3)
_STEPS, _ROUNDS = 60, 20
# How far a step of the program leads, in L (r.m.s.).
_RADIUS = 0.05


@dataclass(frozen=True)
class Held(Touching):
    """A loop at rest with gaps closed, its strands, and its energy without contact.

    Attributes
    ----------
    within : places of the contacts that stay; None where others may come, and these part
    """

    strands: Strands = field(kw_only=True)
    energy: LoopEnergy = field(kw_only=True)
    within: Gaps | None = field(kw_only=True, default=None)

    @property
    def pulls(self) -> BoolArray:
        """Where (k,) strands pull at each other, by more than a force is off by."""
        pulls: BoolArray = self.forces < -self.uncertain
        if self.within is not None:
            pulls = pulls & ~single(self.strands, self.gaps)
        return pulls

    def nearest(self, reach: float) -> Gaps:
        """Return where gaps are least, below so many diameters, that are not held."""
        gaps, strands = self.gaps, self.strands
        low = strands.nearest(self.model.x, reach * strands.diameter)
        if self.within is not None:
            low = low[~strands.unlike(low, self.within.joined(gaps), ALONG)]
        low = low[strands.unlike(low, gaps, _BESIDE)]
        low = low[strands.distinct(low, _BESIDE)]
        return from_one_strand(strands.knots, low, gaps[~gaps.slides])


State = TypeVar("State", bound=Held)
# Returns the state at rest next to a loop (n, d), with gaps closed.
Rest = Callable[[FloatArray, Gaps], State | None]


def without_overlaps(state: State, rest: Rest[State]) -> State | None:
    """Return the state next to one at which no strands overlap, or pull; None if lost."""
    told = _told(state) == state.gaps.slides
    if told.all() and not state.pulls.any() and not len(state.nearest(-_EXACT)):
        return state
    # Near enough, where strands are nearest is where they touch: there is no way to go.
    slid = _sharpened(state, rest)
    if slid is not None and not len(slid.nearest(-_OVERLAP)) and not slid.pulls.any():
        return slid
    known, found = NO_GAPS, state
    for _ in range(_STEPS):
        heed()
        overlaps = found.nearest(-_OVERLAP)
        if not len(overlaps) and not found.pulls.any():
            return _sharpened(found, rest) or found
        known = _joined(found.strands, known, overlaps)
        after = _exchanged(found, known, rest)
        if after is None:
            return None
        found = after
    return None


def _exchanged(state: State, known: Gaps, rest: Rest[State]) -> State | None:
    """Return the state with what a step of the program closes, of all known places."""
    x, strands = state.model.x, state.strands
    gaps = _joined(strands, state.gaps, known)
    closed, loose = np.arange(len(gaps)) < len(state.gaps), _loose(state)
    try:
        gaps, widths = strands.at(x, gaps)
        rows = loose.coordinates.slope(strands.between(x, gaps).jacobian().T).T
        program = Program(loose.gradient, loose.hessian, widths, rows, closed)
        found = program.step(_RADIUS)
    except LinAlgError:
        return None
    if found is None:
        return None
    near, gaps = x + loose.displacement(found[0]), gaps[found[1]]
    reached = (rest(near, some) for some in _sets(strands, near, gaps))
    return next((each for each in reached if each is not None), None)


def _sets(strands: Strands, x: FloatArray, gaps: Gaps) -> Iterator[Gaps]:
    """Yield gaps, fewer of those that may be one closed twice, and where they slide."""
    for edges in _TOGETHER:
        yield gaps[strands.distinct(gaps, edges)]
    with suppress(LinAlgError):
        least, _ = strands.at(x, _sliding(gaps))
        yield least[strands.distinct(least, _BESIDE)]


def _sharpened(state: State, rest: Rest[State]) -> State | None:
    """Return the state with strands held where they are nearest; None if lost.

    They slide with it, but where the distance is too flat to tell where that is.
    """
    points = state.gaps[state.gaps.slides]
    low = replace(state, gaps=points).nearest(_CLOSE)
    x, gaps = state.model.x, points.joined(_sliding(low))
    for _ in range(_ROUNDS):
        found = rest(x, gaps)
        if found is None:
            return None
        x, gaps = found.model.x, found.gaps
        if found.pulls.any():
            gaps = gaps[found.forces > found.forces.min()]
            continue
        low = found.nearest(-_SHARP)
        if not len(low):
            return rest(x, replace(gaps, slides=_told(found)))
        gaps = gaps.joined(_sliding(low))
    return None


def _told(state: Held) -> BoolArray:
    """Return which places (k,) slide: where it is not too flat to tell where to."""
    told: BoolArray = state.strands.spreading(state.model.x, state.gaps) > FLAT
    return told


def _joined(strands: Strands, gaps: Gaps, others: Gaps) -> Gaps:
    """Return gaps, and behind them those of others that are not beside them."""
    return gaps.joined(others[strands.unlike(others, gaps, _BESIDE)])


def _sliding(gaps: Gaps) -> Gaps:
    return replace(gaps, slides=np.ones(len(gaps), dtype=bool))


def _loose(state: Held) -> TangentModel:
    """Return the model that keeps lengths only, stiff along the state's softest modes.

    Closing gaps makes it move along none that is unstable, or about to be.
    """
    model, held = state.model, with_gaps_held(state.energy, state.strands, state.gaps)
    loose, (values, vectors) = loosened(state.energy, held, model), model.eigen
    soft = values < SOFTEST_BENDING
    modes = model.modes(vectors[:, soft]) * model.scale[:, None]
    rows = loose.coordinates.slope(modes).T
    stiff = rows.T @ ((SOFTEST_BENDING - values[soft])[:, None] * rows)
    return replace(loose, hessian=loose.hessian + stiff)
