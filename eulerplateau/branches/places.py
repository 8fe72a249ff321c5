"""How contacts are held along a branch: at a point that slides, by a pair, or as a line.

Where strands touch at a point the place slides, as they touch elsewhere once they are
displaced. The flatter their distance there, the farther: where it is all but flat, as
where one point of contact becomes two, a pair of places is held in its stead, a 25th of an
edge apart, which keeps strands from rocking as the point did.

Loaded only for loops that have a diameter.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.loop import ALONG, NO_GAPS, Gaps, Strands

# d2D/ds2, in 1/L, down to which a point of contact slides; and does on the way to another
# loop. Edges that a pair's places are from where it is.
FLAT, _STEADY = 0.05, 2.0
_PAIRED = 0.02


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

    def with_places(self, strands: Strands, gaps: Gaps) -> Touch:
        """Return the same contacts closed at other gaps."""
        return Touch(gaps, ~strands.unlike(gaps, self.gaps[self.line], ALONG))


NO_TOUCH = Touch(NO_GAPS, NO_GAPS.slides)


def single(strands: Strands, gaps: Gaps) -> BoolArray:
    """Return which places (k,) have no other beside them."""
    contact = strands.contacts(gaps)
    found: BoolArray = np.bincount(contact)[contact] == 1
    return found


def steady(strands: Strands, x: FloatArray, touch: Touch) -> Touch:
    """Return gaps as they are held on the way from a loop x (n, d), on which they slide.

    None slides that has another beside it, or may become flat on that way.
    """
    gaps, _ = strands.at(x, touch.gaps)
    gaps = replace(gaps, slides=gaps.slides & single(strands, gaps))
    return placed(strands, x, replace(touch, gaps=gaps), _STEADY)


def placed(strands: Strands, x: FloatArray, touch: Touch, flat: float = FLAT) -> Touch:
    """Return gaps as they are to be held on a loop x (n, d): the same object if they are.

    A pair is held in place of points that are flatter than that.

    touch : gaps followed to that loop
    """
    gaps = touch.gaps
    if not len(gaps):
        return touch
    alone = single(strands, gaps)
    held = ~gaps.slides & alone
    if held.any():
        try:
            points, _ = strands.at(x, replace(gaps, slides=gaps.slides | alone))
        except LinAlgError:
            points = gaps
        gaps = replace(points, slides=gaps.slides | alone)
    low = alone & gaps.slides & (strands.spreading(x, gaps) <= flat)
    if not (held | low).any():
        return touch
    pairs = touch.gaps[low]
    off = np.repeat([-_PAIRED, _PAIRED], len(pairs)) * strands.loop.rest_lengths.mean()
    slides = np.zeros(2 * len(pairs), dtype=bool)
    beside = Gaps(np.tile(pairs.s, 2) + off, np.tile(pairs.t, 2), slides)
    beside, _ = strands.at(x, beside)
    return touch.with_places(strands, gaps[~low].joined(beside))
