"""Strands that overlap are parted, the loop's lengths kept, before energy is looked at."""

from __future__ import annotations

from dataclasses import replace

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import NEGATIVE, HeldGaps, Lengths, Strands, passed

_ROUNDS = 40
# The rod swells by this factor at a time, from where its strands are nearest.
_SWELLS = 1.25


def separated(strands: Strands, x: FloatArray) -> FloatArray | None:
    """Return a loop near x (n, d) whose strands do not overlap; None if there is none.

    The rod is made thin enough, and swells to its diameter: each time, strands that then
    overlap are moved apart until they touch.
    """
    least = thinnest(strands, x)
    diameter = strands.diameter
    swelling = strands.diameter if least >= diameter else _SWELLS * least
    if not swelling > 0.0:
        return None
    while True:
        swollen = replace(strands, diameter=min(swelling, diameter))
        after = _parted(swollen, x)
        if after is None or passed(x, after):
            return None
        x = after
        if swelling >= diameter:
            return x
        swelling *= _SWELLS


def thinnest(strands: Strands, x: FloatArray) -> float:
    """Return the least distance of strands, at most the diameter."""
    _, widths = strands.near(x, 0.0)
    return strands.diameter + float(widths.min(initial=0.0))


def _parted(strands: Strands, x: FloatArray) -> FloatArray | None:
    lengths = Lengths(strands.loop)
    near, _ = strands.near(x, NEGATIVE)
    held = near
    for _ in range(_ROUNDS):
        if not len(near):
            return x
        after = HeldGaps(lengths, strands, held).project(x)
        if after is None:
            return None
        x = after
        near, _ = strands.near(x, NEGATIVE)
        held, _ = strands.at(x, held)
        new = near[strands.unlike(near, held)]
        if not len(new):
            return x
        held = held.joined(new)
    return None
