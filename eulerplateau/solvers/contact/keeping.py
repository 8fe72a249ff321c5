"""Which gaps of a loop are closed, and of which kind they are: what changes of that.

Where strands cross they touch at a point, which slides as they move. Where they lie along
each other they are held once an edge, until forces balance; and then where it takes that to
keep them apart in between (everywhere.py).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.loop import (
    ALONG,
    NEGATIVE,
    NO_GAPS,
    Gaps,
    HeldGaps,
    LoopEnergy,
    Strands,
    contact_spreads,
    with_gaps_held,
)
from eulerplateau.solvers.second_variation import TangentModel, tangent_model
from eulerplateau.solvers.trust_region import FIRST_RADIUS

# By which part of the diameter strands may overlap before they are pushed back.
_DEEP = 0.25
# Rounds in which gaps are closed that the closing of others has made negative.
_ROUNDS = 6
# What counts as pulling, of the largest tension.
_PULLS = 1e-9
# By which part of the diameter strands may overlap between vertices at which they are held
# along each other; and how often that is mended, or strands that part are held at points.
_BETWEEN = 1e-3
# By which part they are not left to on the way.
_FAR = 0.05
CHANGES = 3
# Strands touch at a point where they spread so fast from there, d2D/ds2 in 1 / L, and do so
# until they spread less than that; and than that in their least distance, on the way.
_POINT, _LINE, _FLAT = 2.0, 1.0, 0.2


@dataclass(frozen=True)
class Touching:
    """A loop with the gaps that are closed on it, and the model that keeps them.

    At places of `laid` strands touched at a point on the way, and lay along each other. So
    many `changes` of the kinds of contacts have led to it. In no step has what must fall
    `risen` by more than that, alpha / L: the energy, or the merit function of merit.py.
    """

    model: TangentModel
    gaps: Gaps
    laid: Gaps
    radius: float
    iteration: int
    changes: int = 0
    risen: float = 0.0

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
        spent = state.iteration + 1, state.changes
        after = self._touching(x, gaps, state.laid, wide, *spent)
        return replace(after, risen=state.risen)

    def _changed(self, state: Touching, gaps: Gaps, laid: Gaps) -> Touching | None:
        """Return the state with other gaps closed in place of its own, if they can be."""
        x = state.model.x
        beside = laid.joined(gaps[~gaps.slides])
        cleared = self.cleared(x, x, gaps, beside)
        if cleared is None:
            return None
        spent = state.iteration + 1, state.changes + 1
        after = self._touching(*cleared, laid, FIRST_RADIUS, *spent)
        return replace(after, risen=state.risen)

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
        flat = gaps.slides & (self.strands.parting(x, gaps) < _FLAT)
        if flat.any():
            # Where they were before: along each other they are nearest anywhere.
            gaps = replace(gaps, slides=gaps.slides & ~flat)
            radius = max(radius, FIRST_RADIUS)
        closed, _ = self.strands.at(x, gaps)
        closed = closed[self.strands.distinct(closed)]
        gaps, tensions = self._pushing(x, closed)
        # The places of one contact are an edge from each other, old ones as well.
        laid = laid.joined(closed[~closed.slides])
        laid = laid[self.strands.unlike(laid, gaps[~gaps.slides], ALONG)]
        laid = laid[self.strands.distinct(laid)]
        held = with_gaps_held(self.energy, self.strands, gaps)
        model = tangent_model(held, x, tensions)
        return Touching(model, gaps, laid, radius, iteration, changes)

    def _pushing(self, x: FloatArray, gaps: Gaps) -> tuple[Gaps, FloatArray | None]:
        """Return closed gaps without those whose strands pull, and tensions (n + k,).

        One after another, as the forces of neighbours hang together.
        """
        parts = self.energy.forces(x)
        force = sum(parts[1:], start=parts[0])
        while len(gaps):
            held = HeldGaps(self.energy.constraint, self.strands, gaps)
            try:
                tensions = held.tensions(x, force)
            except LinAlgError:
                break
            forces = -tensions[len(x) :]
            if forces.min() >= -_PULLS * float(np.abs(tensions).max()):
                return gaps, tensions
            gaps = gaps[np.arange(len(gaps)) != forces.argmin()]
        return gaps, None

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

    def cleared(
        self, before: FloatArray, x: FloatArray, gaps: Gaps, beside: Gaps
    ) -> tuple[FloatArray, Gaps] | None:
        """Return the loop next to x with gaps closed, and others that overlap without.

        None if strands overlap too far, or pass each other on the way from `before`.
        """
        for _ in range(_ROUNDS):
            closed = self.closed(x, gaps)
            if closed is None or self.strands.passed(before, closed[0]):
                return None
            x, gaps = closed
            near, widths = self.strands.near(x, NEGATIVE, beside)
            held, _ = self.strands.at(x, gaps)
            new = self.strands.unlike(near, held)
            if not new.any():
                far = self.strands.nearest(x, -_FAR * self.strands.diameter)
                if not len(far):
                    return x, gaps
                if self.strands.at(x, far)[1].min() < -_DEEP * self.strands.diameter:
                    return None
                gaps = gaps[self.strands.unlike(held, far)].joined(far)
                continue
            if widths[new].min() < -_DEEP * self.strands.diameter:
                return None
            gaps = gaps.joined(near[new])
        return None

    def cleared_between(self, state: Touching) -> Touching | None:
        """Return the state with gaps closed where strands overlap between its places.

        None if they do so nowhere, or have been mended too often.
        """
        low = self.strands.nearest(state.model.x, -_BETWEEN * self.strands.diameter)
        if state.changes >= CHANGES or not len(low):
            return None
        kept = self.strands.unlike(state.gaps, low)
        return self._changed(state, state.gaps[kept].joined(low), state.laid)

    def without(self, state: Touching, let_go: BoolArray) -> Touching:
        """Return the state with some of its gaps (k,) no longer closed."""
        return self.moved(state, state.model.x, state.gaps[~let_go])

    def mended(self, state: Touching) -> Touching | None:
        """Return the state with contacts of the kind, and at the places, they should have.

        None if they are so, or have been mended too often.
        """
        if state.changes >= CHANGES or not len(state.gaps):
            return None
        return self._told(state) or self._parted(state)

    def _told(self, state: Touching) -> Touching | None:
        """Return the state with contacts at points, or along strands, as they spread.

        None if all are so.
        """
        x, gaps = state.model.x, state.gaps
        try:
            slides = self._at_points(state)
            points, _ = self.strands.at(x, replace(gaps, slides=slides))
        except LinAlgError:
            return None
        if (slides == gaps.slides).all():
            return None
        laid = state.laid[self.strands.unlike(state.laid, points[slides], ALONG)]
        return self._changed(state, points[self.strands.distinct(points)], laid)

    def _at_points(self, state: Touching) -> BoolArray:
        """Return which gaps (k,) are places of contacts that are points."""
        gaps, contact = state.gaps, self.strands.contacts(state.gaps)
        along = np.isin(contact, contact[~gaps.slides])
        found = contact_spreads(self.strands, state.model.x, gaps, state.forces, contact)
        at_points: BoolArray = found >= np.where(along, _POINT, _LINE)
        return at_points

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
