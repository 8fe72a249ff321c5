"""Strands that touch, as bounds of a loop: no gap is negative, and none of them pulls.

Loaded only for loops that have a diameter.
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
# followed to where it is; a point where they lie almost along each other, by so much.
_FOLLOWED, _CENTRED = 1.0, 0.02
# d2D/ds2, in 1/L, down to which strands touch at a point, where they are nearest: below,
# that is not told, and they are held where it was.
_FLAT = 0.5

_FORCE, _GAP, _KIND = range(3)


@dataclass(frozen=True)
class Touch:
    """Gaps that are closed, k of them.

    Attributes
    ----------
    line : (k,) bool, whether the contact it is a place of is a line, or a point
    """

    gaps: Gaps
    line: BoolArray

    def __getitem__(self, chosen: BoolArray) -> Touch:
        """Return those of them that are chosen (k,)."""
        return Touch(self.gaps[chosen], self.line[chosen])


NO_TOUCH = Touch(NO_GAPS, NO_GAPS.slides)


@dataclass(frozen=True)
class GapBounds:
    """What keeps strands of a loop apart that touch here and there.

    Its margins: the least of the forces, in parts of the largest tension; the least of the
    other gaps, in diameters; by how much strands spread, or spread less, from where they
    touch at a point, or along a line, 1/L; and by how much more than flat if that slides.
    """

    strands: Strands
    touch: Touch

    def margins(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the margins; those of what there is none of are positive."""
        held = self._at(x)
        parts = (
            self._forces(x, tensions),
            self._others(x, held.gaps)[1],
            self._kinds(x, tensions, held),
            self._slopes(x, held.gaps),
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
        line, or that joins to a point; nothing where a line grows or shrinks by an edge.
        """
        held = self._at(x)
        if which == _FORCE:
            pulls = self._forces(x, tensions) <= _AT_ONCE
            gone, left = held[pulls], held[~pulls]
            parts = self.strands.unlike(gone.gaps, left.gaps, ALONG).any()
            return left, "parts" if parts else ""
        if which == _GAP:
            others, widths = self._others(x, held.gaps)
            return self._joined(held, others[widths <= _AT_ONCE])
        if which == _KIND:
            turned = self._kinds(x, tensions, held) <= _AT_ONCE
            what = "joins" if (turned & held.line).any() else "splits"
            return replace(held, line=held.line ^ turned), what
        flat = self._slopes(x, held.gaps) <= _AT_ONCE
        gaps = replace(held.gaps, slides=held.gaps.slides & ~flat)
        return replace(held, gaps=gaps), ""

    def mended(self, x: FloatArray, tensions: FloatArray) -> Gaps | None:
        """Return what touches once what pulls most is let go, or else what overlaps closed.

        None where nothing pulls or overlaps.
        """
        gaps, forces = self._at(x).gaps, self._forces(x, tensions)
        if forces.min(initial=0.0) < -_ROUNDING:
            return gaps[forces > forces.min()]
        others, widths = self._others(x, gaps)
        overlaps = widths < -_ROUNDING
        return gaps.joined(others[overlaps]) if overlaps.any() else None

    def told(self, x: FloatArray, tensions: FloatArray) -> Touch:
        """Return what touches, told whether at points or along lines."""
        held = self._at(x)
        points = replace(held, line=np.zeros_like(held.line))
        return replace(held, line=self._kinds(x, tensions, points) < 0.0)

    def settled(self, x: FloatArray) -> Touch:
        """Return the gaps as they should be at x: the same object if they are so."""
        gaps, strands = self.touch.gaps, self.strands
        edge = strands.loop.rest_lengths.max()
        at = self._at(x).gaps
        lies = strands.laid_along(x, at)
        points = ~at.slides & single(strands, at) & (strands.spreading(x, at) >= _FLAT)
        crosses = points & strands.crossing(x, at)
        nearest, _ = strands.at(x, replace(at, slides=at.slides | points))
        reach = np.where(points, _CENTRED, _FOLLOWED) * edge
        moved = (np.abs(nearest.s - gaps.s) > reach) & (at.slides | points)
        if not (lies | crosses | moved).any():
            return self.touch
        slides = (at.slides & ~lies) | crosses
        return replace(self.touch, gaps=replace(nearest, slides=slides))

    def _at(self, x: FloatArray) -> Touch:
        """Return the gaps followed to a loop x (n, d)."""
        gaps, _ = self.strands.at(x, self.touch.gaps)
        return replace(self.touch, gaps=gaps)

    def _forces(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return the forces (k,) in parts of the largest tension."""
        forces: FloatArray = -tensions[len(x) :] / float(np.abs(tensions).max())
        return forces

    def _others(self, x: FloatArray, held: Gaps) -> tuple[Gaps, FloatArray]:
        """Return where strands are near that are not held, and how near, in diameters."""
        strands = self.strands
        beside = held[~held.slides]
        near, widths = strands.near(x, _REACH * strands.diameter, beside)
        new = strands.unlike(near, held)
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
            kept = strands.distinct(near) & strands.unlike(near, held)
            near, widths = near[kept], widths[kept]
        return near, widths / strands.diameter

    def _joined(self, held: Touch, new: Gaps) -> tuple[Touch, str]:
        """Return what touches with new places of contact, and whether those are alone."""
        fresh = self.strands.unlike(new, held.gaps, ALONG)
        lines = held.gaps[held.line]
        line = np.append(held.line, ~self.strands.unlike(new, lines, ALONG))
        return Touch(held.gaps.joined(new), line), "touches" if fresh.any() else ""

    def _kinds(self, x: FloatArray, tensions: FloatArray, held: Touch) -> FloatArray:
        """Return by how much each of the contacts (k,) is the point, or the line, it is."""
        gaps, forces = held.gaps, -tensions[len(x) :]
        kinds = contact_spreads(self.strands, x, gaps, forces, self.strands.contacts(gaps))
        return np.where(held.line, -kinds, kinds)

    def _slopes(self, x: FloatArray, held: Gaps) -> FloatArray:
        """Return by how much strands (k,) spread more than flat where a contact slides."""
        return np.where(held.slides, self.strands.spreading(x, held) - _FLAT, np.inf)


def single(strands: Strands, gaps: Gaps) -> BoolArray:
    """Return which places (k,) have no other beside them."""
    contact = strands.contacts(gaps)
    found: BoolArray = np.bincount(contact)[contact] == 1
    return found
