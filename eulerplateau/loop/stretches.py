"""Strands along each other: from which of them, and where on its edges, they are held.

A stretch is held once an edge, from one strand. `knots` (n + 1,) are the vertices'
arclengths, the first again at their end.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray
from eulerplateau.loop.gaps import Gaps

# Edges within which strands that lie along each other do so.
ALONG = 2.5
# Parts of an edge by which places along a stretch may be off.
_EVEN = 0.02


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


def from_one_strand(knots: FloatArray, gaps: Gaps, beside: Gaps) -> Gaps:
    """Return gaps as seen from the strand on which others `beside` are held."""
    if not len(beside) or not len(gaps):
        return gaps
    held = of_one_strand(knots, gaps.s, gaps.t, beside)
    s, t = np.where(held, gaps.s, gaps.t), np.where(held, gaps.t, gaps.s)
    return Gaps(s, t, gaps.slides)


def evenly(knots: FloatArray, gaps: Gaps, forces: FloatArray) -> Gaps | None:
    """Return gaps where strands lie along each other, an edge from each other.

    The middle of each stretch, by the forces (k,), is one of the places, so that they
    are the same whatever the way there was. None if all are where they should be.
    """
    beside = np.flatnonzero(~gaps.slides)
    if not len(beside):
        return None
    n, whole = len(knots) - 1, float(knots[-1])
    number = np.arange(n + 1, dtype=np.float64)
    origin = _origin(np.concatenate([gaps.s[beside], gaps.t[beside]]), whole)
    # From one strand all of them.
    turned = ~gaps.slides & ((gaps.s - origin) % whole > (gaps.t - origin) % whole)
    one, other = (np.where(turned, gaps.t, gaps.s), np.where(turned, gaps.s, gaps.t))
    begin = float(np.interp(origin, knots, number))
    at = (np.interp(one % whole, knots, number) - begin) % n
    order = beside[np.argsort(at[beside])]
    across = np.unwrap(other[order], period=whole)
    steps = np.maximum(np.diff(at[order]), np.abs(np.diff(across)) * n / whole)
    cuts = np.flatnonzero(steps > ALONG) + 1
    laid, moved = gaps[gaps.slides], False
    for stretch, facing in zip(np.split(order, cuts), np.split(across, cuts), strict=True):
        even = _even(at[stretch], np.maximum(forces[stretch], 0.0))
        t = facing if even is None else np.interp(even, at[stretch], facing)
        moved = moved or even is not None
        places = at[stretch] if even is None else even
        s = np.interp((places + begin) % n, number, knots)
        laid = laid.joined(Gaps(s, t, np.zeros(len(s), dtype=bool)))
    return laid if moved else None


def _even(at: FloatArray, push: FloatArray) -> FloatArray | None:
    """Return where a stretch is held, in edges; None if that is where it is."""
    if len(at) == 1 or not push.any():
        return None
    middle = float(push @ at / push.sum())
    off = at - middle
    if float(np.abs(off - np.round(off)).max()) <= _EVEN:
        return None
    even: FloatArray = middle + np.unique(np.round(off))
    return even


def _origin(places: FloatArray, whole: float) -> float:
    """Return the middle of the longest stretch of loop without one of some places."""
    ordered = np.sort(places % whole)
    lengths = np.diff(ordered, append=ordered[0] + whole)
    longest = int(np.argmax(lengths))
    return float(ordered[longest] + 0.5 * lengths[longest]) % whole
