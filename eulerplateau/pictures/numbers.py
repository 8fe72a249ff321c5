"""Where the numbers of shapes have room in a panel: beside their places, not on others."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from eulerplateau.arrays import FloatArray

# Points: the radius of a place's mark, the height of a number and the width of a letter,
# and how much farther away each ring of tries is.
MARK, HIGH, WIDE, _RING = 4.0, 8.0, 5.4, 7.0
# How much less the side opposite to that is liked; sideways directions are by their sine.
_OPPOSITE = 0.5
# Rings of tries, and the tries in each beside the one that is wished for.
_RINGS, _AROUND = 12, 16


def joined(places: FloatArray) -> list[list[int]]:
    """Return the numbers of places (n, 2), in points, that share a mark, in groups."""
    groups: list[list[int]] = []
    for number, place in enumerate(places):
        for group in groups:
            if np.hypot(*(place - places[group[0]])) < MARK:
                group.append(number)
                break
        else:
            groups.append([number])
    return groups


def spread(
    places: FloatArray, letters: Sequence[int], wishes: FloatArray, room: FloatArray
) -> FloatArray:
    """Return the middles (n, 2) of labels that overlap neither each other nor a mark.

    Each is as near to its place as can be, in the direction wished for if that is free.

    Parameters
    ----------
    places : (n, 2) float, of the marks in a panel, in points
    letters : (n,) how many there are in each label
    wishes : (n, 2) float, the directions from the places to the labels
    room : (2,) float, the panel's width and height in points
    """
    halves = 0.5 * np.stack(
        [WIDE * np.asarray(letters), np.full(len(places), HIGH)], axis=1
    )
    marks = np.full_like(places, MARK)
    taken = places.astype(float)
    found = np.empty_like(taken)
    for number, (place, half, wish) in enumerate(zip(places, halves, wishes, strict=True)):
        others = np.concatenate([marks, halves[:number]])
        tries = np.array(list(_tries(place, half, wish)))
        over = _overlap(tries, half, taken, others)
        over += np.maximum(np.abs(tries - 0.5 * room) + half - 0.5 * room, 0).sum(axis=1)
        found[number] = tries[np.argmin(over)]
        taken = np.concatenate([taken, found[number : number + 1]])
    return found


def _tries(place: FloatArray, half: FloatArray, wish: FloatArray) -> Iterator[FloatArray]:
    """Yield where a label of a half-width and half-height may be, the nearest first."""
    angle = np.arctan2(wish[1], wish[0])
    turns = 2 * np.pi / _AROUND * np.arange(_AROUND)
    # The opposite side before the sides between, where the curve runs.
    aside = np.abs(np.sin(turns)) + _OPPOSITE * (np.cos(turns) < 0)
    turns = turns[np.argsort(aside, kind="stable")]
    for ring in range(_RINGS):
        for turn in turns:
            way = np.array([np.cos(angle + turn), np.sin(angle + turn)])
            # Clear of the mark's box, whichever side of it that is.
            clear = float(((half + MARK) / np.maximum(np.abs(way), 1e-9)).min())
            yield place + (clear + 1.0 + ring * _RING) * way


def _overlap(
    middles: FloatArray, half: FloatArray, others: FloatArray, halves: FloatArray
) -> FloatArray:
    """Return how much boxes of one size overlap others, (m,) of middles (m, 2)."""
    apart = np.abs(middles[:, None] - others)
    sides = np.maximum(half + halves - apart, 0.0)
    area: FloatArray = sides.prod(axis=2).sum(axis=1)
    return area
