"""Which gaps of a loop are closed, and of which kind they are: what changes of that.

Where strands cross they touch at a point, which slides as they move. Where they lie along
each other they are held once an edge, and where on the edges is a convention of the mesh;
in the end the middle of each stretch is one of the places.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.loop import (
    ALONG,
    NO_GAPS,
    Gaps,
    LoopEnergy,
    Strands,
    evenly,
    with_gaps_held,
)
from eulerplateau.solvers.second_variation import TangentModel, tangent_model

# The residual below which it is asked whether strands pull, and what counts as pulling:
# so much of the largest tension, and what an unbalanced force would account for.
_ASKED = 1e-3
_PULLS = 1e-9
# By which part of the diameter strands may overlap between vertices at which they are held
# along each other; and how often that is mended, or strands that part are held at points.
_BETWEEN = 1e-3
_CHANGES = 8


@dataclass(frozen=True)
class Touching:
    """A loop with the gaps that are closed on it, and the model that keeps them.

    At places of `laid` strands touched at a point on the way, and lay along each other. So
    many `changes` of the kinds of contacts have led to it.
    """

    model: TangentModel
    gaps: Gaps
    laid: Gaps
    radius: float
    iteration: int
    changes: int = 0

    @property
    def beside(self) -> Gaps:
        """Places where strands lie along each other, or did so on the way."""
        return self.laid.joined(self.gaps[~self.gaps.slides])

    @property
    def forces(self) -> FloatArray:
        """The forces (k,) with which strands push each other, alpha / L^2."""
        return -self.model.tensions[len(self.model.x) :]

    @property
    def uncertain(self) -> float:
        """What such a force can be off by, as far as forces do not balance."""
        tensions = self.model.tensions
        largest = float(np.abs(tensions).max())
        return largest * (_PULLS + len(tensions) * self.model.residual)


@dataclass(frozen=True)
class Keeping:
    """How gaps are kept closed while an energy that knows no contact is minimised."""

    energy: LoopEnergy
    strands: Strands

    def at(self, x: FloatArray, gaps: Gaps, radius: float) -> Touching:
        """Return where a descent begins: a loop on which these gaps are closed."""
        return self._touching(x, gaps, NO_GAPS, radius, 0, 0)

    def moved(
        self, state: Touching, x: FloatArray, gaps: Gaps, radius: float | None = None
    ) -> Touching:
        """Return the state that follows on another loop, or with other gaps closed."""
        wide = state.radius if radius is None else radius
        return self._touching(x, gaps, state.laid, wide, state.iteration + 1, state.changes)

    def _changed(self, state: Touching, gaps: Gaps, laid: Gaps) -> Touching | None:
        """Return the state with other gaps closed in place of its own, if they can be."""
        closed = self.closed(state.model.x, gaps)
        if closed is None:
            return None
        return self._touching(
            *closed, laid, state.radius, state.iteration + 1, state.changes + 1
        )

    def _touching(
        self,
        x: FloatArray,
        gaps: Gaps,
        laid: Gaps,
        radius: float,
        iteration: int,
        changes: int,
    ) -> Touching:
        """Return the state on a loop with these gaps, those of one place only once.

        Strands that come to lie along each other are held there, and touch at no point.
        """
        along = self.strands.laid_along(x, gaps)
        if along.any():
            # Where they were before: along each other they are nearest anywhere.
            laid = laid.joined(gaps[along])
            gaps = replace(gaps, slides=gaps.slides & ~along)
        gaps, _ = self.strands.at(x, gaps)
        gaps = gaps[self.strands.distinct(gaps)]
        model = tangent_model(with_gaps_held(self.energy, self.strands, gaps), x)
        return Touching(model, gaps, laid, radius, iteration, changes)

    def closed(self, x: FloatArray, gaps: Gaps) -> tuple[FloatArray, Gaps] | None:
        """Return the loop next to x with gaps closed, and them: those that met count once.

        None if they cannot be.
        """
        for _ in range(len(gaps) + 1):
            held = with_gaps_held(self.energy, self.strands, gaps).constraint
            found = held.project(x)
            if found is None:
                return None
            try:
                after, _ = self.strands.at(found, gaps)
            except LinAlgError:
                return None
            distinct = self.strands.distinct(after)
            if distinct.all():
                return found, gaps
            gaps = gaps[distinct]
        return None

    def let_go(self, state: Touching, stuck: bool = False) -> Touching | None:
        """Return the state without the strands that pull at each other; None if none do.

        Those whose pull is certain, or would lead down more steeply than all that the loop
        can do with them held; where it is stuck, all of them.
        """
        if not len(state.gaps) or not (state.forces < 0.0).any():
            return None
        least = 0.0
        if not stuck:
            model = state.model
            rows = self.strands.between(model.x, state.gaps).jacobian()
            sizes = np.linalg.norm(rows / model.scale, axis=1)
            steeper = float(np.linalg.norm(model.gradient)) / sizes
            least = (
                steeper if model.residual > _ASKED else np.minimum(steeper, state.uncertain)
            )
        pulling = state.forces < -least
        return self.without(state, pulling) if pulling.any() else None

    def without(self, state: Touching, let_go: BoolArray) -> Touching:
        """Return the state with some of its gaps (k,) no longer closed."""
        return self.moved(state, state.model.x, state.gaps[~let_go])

    def crossing(self, state: Touching) -> Touching | None:
        """Return the state with strands touching at points that no longer lie along.

        None if they do so nowhere, or have done so too often. The energy may rise by a
        force times the tiny gap that is closed.
        """
        x, gaps = state.model.x, state.gaps
        if state.changes >= _CHANGES or gaps.slides.all():
            return None
        crossing = self.strands.crossing(x, gaps)
        if not crossing.any():
            return None
        kept, changed = gaps[~crossing], gaps[crossing]
        laid = state.laid[self.strands.unlike(state.laid, changed, ALONG)]
        try:
            points, _ = self.strands.at(x, replace(changed, slides=crossing[crossing]))
        except LinAlgError:
            return None
        points = points[self.strands.distinct(points)]
        return self._changed(state, kept.joined(points), laid)

    def mended(self, state: Touching) -> Touching | None:
        """Return the state with contacts of the kind, and at the places, they should have.

        None if they are so, or have been mended too often.
        """
        if state.changes >= _CHANGES or not len(state.gaps):
            return None
        return self._parted(state) or self._laid_evenly(state)

    def _parted(self, state: Touching) -> Touching | None:
        """Return the state with points where strands overlap between two vertices' gaps.

        None if they do so nowhere, or by so little that an edge's length accounts for it.
        """
        gaps = state.gaps
        near, _ = self.strands.near(state.model.x, -_BETWEEN * self.strands.diameter)
        points = near[near.slides]
        points = points[self.strands.unlike(points, gaps[gaps.slides])]
        if not len(points):
            return None
        kept = gaps.slides | self.strands.unlike(gaps, points, 1.05)
        return self._changed(state, gaps[kept].joined(points), state.laid)

    def _laid_evenly(self, state: Touching) -> Touching | None:
        """Return the state with strands held along each other at even places, else None."""
        after = evenly(self.strands.knots, state.gaps, state.forces)
        return None if after is None else self._changed(state, after, NO_GAPS)
