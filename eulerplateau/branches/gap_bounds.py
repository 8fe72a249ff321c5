"""Strands that touch, as bounds of a loop: no gap is negative, and none of them pulls.

Loaded only for loops that have a diameter.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.branches.places import Touch, placed
from eulerplateau.loop import (
    ALONG,
    Gaps,
    HeldGaps,
    Lengths,
    Strands,
    contact_spreads,
    passed,
)

# Gaps are looked at up to this part of the diameter.
_REACH = 0.5
# What changes at once does so at margins that are no larger; those of rounding.
_AT_ONCE, _ROUNDING = 1e-8, 1e-9
# A place at which strands touch at a point may move by so much of an edge before it is
# followed to where it is.
_FOLLOWED = 1.0
# Edges within which a place is one that is held.
_BESIDE = 0.75

_FORCE, _GAP, _KIND = range(3)


@dataclass(frozen=True)
class GapBounds:
    """What keeps strands of a loop apart that touch here and there.

    Its margins: the least of the contacts' forces, in parts of the largest tension; the
    least of the gaps that are none of these, in diameters; and by how much strands spread,
    or spread less, from where they touch at a point, or along a line, 1/L.
    """

    strands: Strands
    touch: Touch

    def margins(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the margins; those of what there is none of are positive."""
        held = self._at(x)
        parts = (
            self._pushes(x, tensions, held),
            self._others(x, held.gaps, ALONG)[1],
            self._kinds(x, tensions, held),
        )
        return np.array([float(each.min(initial=_REACH)) for each in parts])

    def holds(self, x: FloatArray) -> bool:
        """Return whether gaps are of the kind, and at the places, they should be."""
        return self.settled(x) is self.touch

    def reaches(self, x: FloatArray, other: FloatArray) -> bool:
        """Return whether no strand passes through another on a short way."""
        return not passed(x, other)

    def drift(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return how a loop (n, d) moves so that gaps stay closed as the diameter rises."""
        if parameter != "diameter":
            return None
        loop = self.strands.loop
        held = HeldGaps(Lengths(loop), self.strands, self.touch.gaps)
        scale = np.repeat(np.sqrt(loop.mean_lengths), x.shape[1])
        rises = np.repeat([0.0, 1.0], [len(x), len(self.touch.gaps)])
        moved = np.linalg.lstsq(held.jacobian(x) / scale, rises, rcond=None)[0] / scale
        drift: FloatArray = moved.reshape(x.shape)
        return drift

    def beyond(self, x: FloatArray, tensions: FloatArray, which: int) -> tuple[Touch, str]:
        """Return what touches beyond a loop where one of the margins vanishes.

        And what happens there: strands touch or part, a point of contact splits into a
        line, or that joins to a point.
        """
        held = self._at(x)
        if which == _FORCE:
            return held[~_first(self._pushes(x, tensions, held))], "parts"
        if which == _GAP:
            others, widths = self._others(x, held.gaps, ALONG)
            new = others[_first(widths)]
            joined = held.with_places(self.strands, held.gaps.joined(new))
            return placed(self.strands, x, joined), "touches"
        turned = _first(self._kinds(x, tensions, held))
        what = "joins" if (turned & held.line).any() else "splits"
        return replace(held, line=held.line ^ turned), what

    def mended(self, x: FloatArray, tensions: FloatArray) -> Gaps | None:
        """Return what touches once what pulls most is let go, or else what overlaps closed.

        None where nothing pulls or overlaps.
        """
        gaps, forces = self._at(x).gaps, self._forces(x, tensions)
        if forces.min(initial=0.0) < -_ROUNDING:
            return gaps[forces > forces.min()]
        others, widths = self._others(x, gaps, _BESIDE)
        overlaps = widths < -_ROUNDING
        return gaps.joined(others[overlaps]) if overlaps.any() else None

    def told(self, x: FloatArray, tensions: FloatArray) -> Touch:
        """Return what touches, told whether at points or along lines."""
        held = self._at(x)
        points = replace(held, line=np.zeros_like(held.line))
        return replace(held, line=self._kinds(x, tensions, points) < 0.0)

    def settled(self, x: FloatArray) -> Touch:
        """Return the gaps as they should be at x: the same object if they are so."""
        gaps, followed = self.touch.gaps, self._at(x)
        found = placed(self.strands, x, followed)
        reach = _FOLLOWED * self.strands.loop.rest_lengths.max()
        moved = gaps.slides & (np.abs(followed.gaps.s - gaps.s) > reach)
        return found if moved.any() or found is not followed else self.touch

    def _at(self, x: FloatArray) -> Touch:
        """Return the gaps followed to a loop x (n, d)."""
        gaps, _ = self.strands.at(x, self.touch.gaps)
        return replace(self.touch, gaps=gaps)

    def _pushes(self, x: FloatArray, tensions: FloatArray, held: Touch) -> FloatArray:
        """Return the force of the contact (k,) that each place is of, in the same parts."""
        contact = self.strands.contacts(held.gaps)
        sums: FloatArray = (contact[:, None] == contact) @ self._forces(x, tensions)
        return sums

    def _forces(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the forces (k,) in parts of the largest tension."""
        forces: FloatArray = -tensions[len(x) :] / float(np.abs(tensions).max())
        return forces

    def _others(self, x: FloatArray, held: Gaps, edges: float) -> tuple[Gaps, FloatArray]:
        """Return where strands are near that are not held, and how near, in diameters.

        So many edges from where they are.
        """
        strands = self.strands
        beside = held[~held.slides]
        near, widths = strands.near(x, _REACH * strands.diameter, beside)
        new = strands.unlike(near, held, edges)
        near, widths = near[new], widths[new]
        # Alone, they are looked at where they are nearest, and not at a vertex.
        alone = ~near.slides & strands.unlike(near, beside, ALONG)
        if alone.any():
            try:
                points, gaps = strands.at(x, replace(near[alone], slides=alone[alone]))
            except LinAlgError:
                return near, widths / strands.diameter
            near = near[~alone].joined(replace(points, slides=~alone[alone]))
            widths = np.append(widths[~alone], gaps)
            kept = strands.distinct(near) & strands.unlike(near, held, edges)
            near, widths = near[kept], widths[kept]
        return near, widths / strands.diameter

    def _kinds(self, x: FloatArray, tensions: FloatArray, held: Touch) -> FloatArray:
        """Return by how much each of the contacts (k,) is the point, or the line, it is."""
        gaps, forces = held.gaps, -tensions[len(x) :]
        kinds = contact_spreads(self.strands, x, gaps, forces, self.strands.contacts(gaps))
        return np.where(held.line, -kinds, kinds)


def _first(margins: FloatArray) -> BoolArray:
    """Return which of margins (k,) vanish where the first of them does."""
    found: BoolArray = margins <= max(margins.min(), _AT_ONCE)
    return found
