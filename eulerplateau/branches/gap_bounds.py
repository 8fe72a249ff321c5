"""Strands that touch, as bounds of a loop: no gap is negative, and none of them pulls.

Loaded only for loops that have a diameter.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.loop import ALONG, NO_GAPS, Gaps, Strands, passed

# Gaps are looked at up to this part of the diameter.
_REACH = 0.5
# What changes at once does so at margins that are no larger; those of rounding.
_AT_ONCE, _ROUNDING = 1e-8, 1e-9
# A place at which strands touch at a point may move by so much of an edge before it is
# followed to where it is; a point where they lie almost along each other, by so much.
_FOLLOWED, _CENTRED = 1.0, 0.02
# d2D/ds2, in 1/L, below which strands that touch at a point are held as those that lie
# along each other are, at the latest.
_FLAT = 0.5

FORCE, GAP, SPREAD = range(3)


@dataclass(frozen=True)
class Touch:
    """Gaps that are closed, k of them, and where the strands lie along each other.

    Attributes
    ----------
    line : (k,) bool
        Whether the contact is a line there: with d2D/ds2 no longer positive a point would
        not be enough.
    """

    gaps: Gaps
    line: BoolArray

    def __getitem__(self, chosen: BoolArray) -> Touch:
        """Return those of them that are chosen (k,)."""
        return Touch(self.gaps[chosen], self.line[chosen])

    def joined(self, other: Touch) -> Touch:
        """Return these and others behind them."""
        line = np.concatenate([self.line, other.line])
        return Touch(self.gaps.joined(other.gaps), line)


NO_TOUCH = Touch(NO_GAPS, np.zeros(0, dtype=bool))


@dataclass(frozen=True)
class GapBounds:
    """What keeps strands of a loop apart that touch here and there.

    Its margins: the least of the forces, in parts of the largest tension; the least of the
    other gaps, in diameters; and the least d2D/ds2, in 1/L, where strands touch at a point,
    or less it where that has become a line.
    """

    strands: Strands
    touch: Touch

    def margins(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the three margins; those of what there is none of are positive."""
        forces = self._forces(x, tensions)
        _, widths = self._others(x)
        spread = self._spread(x)
        least = (float(each.min(initial=_REACH)) for each in (forces, widths, spread))
        return np.array(list(least))

    def holds(self, x: FloatArray) -> bool:
        """Return whether gaps are of the kind, and at the places, they should be."""
        return self.settled(x) is self.touch

    def reaches(self, x: FloatArray, other: FloatArray) -> bool:
        """Return whether no strand passes through another on a short way."""
        return not passed(x, other)

    def changed(
        self, x: FloatArray, tensions: FloatArray, which: int
    ) -> tuple[Touch, str]:
        """Return what touches beyond a loop where one of the margins vanishes.

        And what happens there: strands touch or part, or a point of contact splits, or a
        line of contact joins again; nothing where a line grows or shrinks.
        """
        held = self._at(x)
        if which == FORCE:
            return self._parted(held, self._forces(x, tensions) <= _AT_ONCE)
        if which == GAP:
            others, widths = self._others(x)
            return self._joined(held, others[widths <= _AT_ONCE])
        return self._spread_out(held, self._spread(x) <= _AT_ONCE)

    def mended(self, x: FloatArray, tensions: FloatArray) -> Gaps | None:
        """Return what touches if what pulls most is let go, or else what overlaps is closed.

        None where nothing does either.
        """
        gaps, forces = self._at(x).gaps, self._forces(x, tensions)
        if forces.min(initial=0.0) < -_ROUNDING:
            return gaps[forces > forces.min()]
        others, widths = self._others(x)
        overlaps = widths < -_ROUNDING
        return gaps.joined(others.gaps[overlaps]) if overlaps.any() else None

    def with_lines(self, x: FloatArray) -> Touch:
        """Return what touches, where a contact is a line told by how it lies alone."""
        gaps = self._at(x).gaps
        alone = self._alone(gaps)
        flat = self.strands.spreading(x, gaps) < 0.0
        return Touch(gaps, ~gaps.slides & (flat | ~alone))

    def _forces(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the forces (k,) in parts of the largest tension."""
        scale = float(np.abs(tensions).max())
        forces: FloatArray = -tensions[len(x) :] / scale
        return forces

    def _at(self, x: FloatArray) -> Touch:
        """Return the gaps followed to a loop x (n, d)."""
        gaps, _ = self.strands.at(x, self.touch.gaps)
        return replace(self.touch, gaps=gaps)

    def _others(self, x: FloatArray) -> tuple[Touch, FloatArray]:
        """Return where else strands are near, and how near, in diameters."""
        strands, held = self.strands, self._at(x).gaps
        beside = held[~held.slides]
        near, widths = strands.near(x, _REACH * strands.diameter, beside)
        new = strands.unlike(near, held)
        near, widths = near[new], widths[new]
        # Alone, they are looked at where they are nearest, and not at a vertex.
        alone = ~near.slides & strands.unlike(near, beside, ALONG)
        line = ~near.slides & ~alone
        if alone.any():
            nearest = replace(near[alone], slides=alone[alone])
            try:
                nearest, gaps = strands.at(x, nearest)
            except LinAlgError:
                return Touch(near, line), widths / strands.diameter
            points = replace(nearest, slides=~alone[alone])
            near, line = near[~alone].joined(points), np.append(line[~alone], points.slides)
            widths = np.append(widths[~alone], gaps)
            kept = strands.distinct(near) & strands.unlike(near, held)
            near, line, widths = near[kept], line[kept], widths[kept]
        return Touch(near, line), widths / strands.diameter

    def _alone(self, gaps: Gaps) -> BoolArray:
        """Return which places (k,) have no other beside them."""
        near = [
            not self.strands.unlike(gaps[here], gaps[~here], ALONG)[0]
            for here in np.eye(len(gaps), dtype=bool)
        ]
        return ~np.array(near, dtype=bool)

    def _spread(self, x: FloatArray) -> FloatArray:
        """Return by how much the kind of each of the contacts (k,) is what it should be."""
        held = self._at(x)
        gaps, line = held.gaps, held.line
        spread = self.strands.spreading(x, gaps)
        spread[gaps.slides] -= _FLAT
        spread[line] *= -1
        spread[~gaps.slides & ~self._alone(gaps)] = np.inf
        return spread

    def _parted(self, held: Touch, pulls: BoolArray) -> tuple[Touch, str]:
        gone, left = held[pulls], held[~pulls]
        parts = self.strands.unlike(gone.gaps, left.gaps, ALONG).any()
        return left, "parts" if parts else ""

    def _joined(self, held: Touch, new: Touch) -> tuple[Touch, str]:
        fresh = self.strands.unlike(new.gaps, held.gaps, ALONG)
        beside = ~self.strands.unlike(held.gaps, new.gaps, ALONG)
        splits = bool((beside & ~held.line).any())
        held, new = replace(held, line=held.line | beside), replace(new, line=~fresh)
        what = "touches" if fresh.any() else "splits" if splits else ""
        return held.joined(new), what

    def _spread_out(self, held: Touch, changes: BoolArray) -> tuple[Touch, str]:
        points = changes & held.gaps.slides
        turned = changes & ~held.gaps.slides
        gaps = replace(held.gaps, slides=held.gaps.slides & ~points)
        joins = turned & held.line
        what = "joins" if joins.any() else "splits" if turned.any() else ""
        return Touch(gaps, held.line ^ turned), what

    def settled(self, x: FloatArray) -> Touch:
        """Return the gaps as they should be at x: the same object if they are so."""
        touch, strands = self.touch, self.strands
        edge = strands.loop.rest_lengths.max()
        at = self._at(x).gaps
        lies = strands.laid_along(x, at)
        single = ~at.slides & ~touch.line & self._alone(at)
        crosses = single & strands.crossing(x, at)
        nearest, _ = strands.at(x, replace(at, slides=at.slides | single))
        reach = np.where(single, _CENTRED, _FOLLOWED) * edge
        moved = (np.abs(nearest.s - touch.gaps.s) > reach) & (at.slides | single)
        if not (lies | crosses | moved).any():
            return touch
        slides = (at.slides & ~lies) | crosses
        return replace(touch, gaps=replace(nearest, slides=slides))
