"""Strands along each other: from which of them, and where on its edges, they are held.

A stretch is held once an edge, from one strand. `knots` (n + 1,) are the vertices'
arclengths, the first again at their end.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.loop.gaps import NO_GAPS, Gaps

# Edges within which strands that lie along each other do so.
ALONG = 2.5
# Places nearer to each other, in parts of the loop, are the same.
_SAME = 1e-7


def offsets(knots: FloatArray, beside: Gaps) -> FloatArray:
    """Return where strands are looked at on each edge, in parts of it (n,).

    Where on its edge the nearest of some places is.
    """
    n, whole = len(knots) - 1, knots[-1]
    if not len(beside):
        return np.zeros(n)
    s = beside.s % whole
    edge = np.clip(np.searchsorted(knots, s, side="right") - 1, 0, n - 1)
    parts = (s - knots[edge]) / np.diff(knots)[edge]
    off = np.abs(knots[:-1, None] - s)
    found: FloatArray = parts[np.minimum(off, whole - off).argmin(axis=1)]
    return found


def of_one_strand(
    knots: FloatArray, s: FloatArray, t: FloatArray, beside: Gaps
) -> BoolArray:
    """Return which of places (k,), each seen from both strands, are to be held.

    Those seen from the strand on which others `beside` are held; or from the one that
    comes first after the longest stretch on which nothing touches.
    """
    whole = float(knots[-1])
    if not len(s):
        return np.zeros(0, dtype=bool)
    if not len(beside):
        origin = _origin(s, whole)
        first: BoolArray = (s - origin) % whole < (t - origin) % whole
        return first

    def off(places: FloatArray, others: FloatArray) -> FloatArray:
        along = np.abs(places[:, None] - others) % whole
        nearest: FloatArray = np.minimum(along, whole - along).min(axis=1)
        return nearest

    as_held = off(s, beside.s) + off(t, beside.t)
    held: BoolArray = as_held < off(s, beside.t) + off(t, beside.s)
    return held


def from_one_strand(knots: FloatArray, gaps: Gaps, beside: Gaps = NO_GAPS) -> Gaps:
    """Return gaps with those along each other seen from one strand: see of_one_strand."""
    held = gaps.slides | of_one_strand(knots, gaps.s, gaps.t, beside)
    s, t = np.where(held, gaps.s, gaps.t), np.where(held, gaps.t, gaps.s)
    return Gaps(s, t, gaps.slides)


def first_of_each(pairs: FloatArray, whole: float) -> BoolArray:
    """Return which pairs of places (k, 2) are the first of those that are the same.

    They are so whichever of the two comes first, on a loop that is so long.
    """
    ordered = np.sort(pairs, axis=1)
    off = np.abs(ordered[:, None] - ordered)
    same = np.all(np.minimum(off, whole - off) < _SAME * whole, axis=2)
    first: BoolArray = np.logical_not(np.any(np.tril(same, -1), axis=1))
    return first


def _origin(places: FloatArray, whole: float) -> float:
    """Return the middle of the longest stretch of loop without one of some places."""
    ordered = np.sort(places % whole)
    lengths = np.diff(ordered, append=ordered[0] + whole)
    longest = int(np.argmax(lengths))
    return float(ordered[longest] + 0.5 * lengths[longest]) % whole
