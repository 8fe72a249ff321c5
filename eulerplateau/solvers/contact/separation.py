"""Strands that overlap are parted, the loop's lengths kept, before energy is looked at.

The rod is made thin enough, and swells to its diameter: each time, strands that then
overlap are moved apart until they touch. Where that comes to no end, and where the loop
turns back on itself within so short a piece that the rod overlaps there, the loop unbends:
downhill in its bending energy, no strands overlapping on the way.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import (
    NEGATIVE,
    NO_GAPS,
    Bending,
    Gaps,
    HeldGaps,
    Lengths,
    LoopEnergy,
    Strands,
    rigid_motions,
)
from eulerplateau.solvers.contact.descent import ContactDescent
from eulerplateau.solvers.contact.program import least_forces
from eulerplateau.solvers.second_variation import TangentModel

_ROUNDS = 40
# The rod swells by this factor at a time, from where its strands are nearest.
_SWELLS = 1.25
# How often a loop unbends, by so many steps, before its strands are parted again; and by
# how many at most where it turns back on itself.
_UNBENDS = 40
_STEPS, _MOST = 5, 300
# Places on each piece of loop where it may turn back, all of them at most, and how often
# they are refined.
_PLACES, _ALL_PLACES, _FINER = 16, 20_000, 3
# By which part of the diameter strands may overlap between places they are parted at, and
# within how many edges two places are the same.
_OVERLAP, _SAME = 1e-8, 0.02


def separated(strands: Strands, x: FloatArray) -> FloatArray | None:
    """Return a loop near x (n, d) on which nothing overlaps; None if there is none."""
    for _ in range(_UNBENDS):
        x, thick = _swollen(strands, x)
        if not thick > 0.0:
            return None
        if thick < strands.diameter:
            thin = replace(strands, diameter=thick / _SWELLS)
            x = _unbent(thin, x, _STEPS, lambda model: False)
        elif turns_back(strands, x):
            x = _unbent(strands, x, _MOST, lambda model: not turns_back(strands, model.x))
        else:
            return x
    return None


def thinnest(strands: Strands, x: FloatArray) -> float:
    """Return the least distance of strands, at most the diameter."""
    _, widths = strands.near(x, 0.0)
    return strands.diameter + float(widths.min(initial=0.0))


def turns_back(strands: Strands, x: FloatArray) -> bool:
    """Return whether a loop (n, d) is nearer to itself than its diameter at a bend.

    That is at places `apart` from each other along it, as near as such that may touch.
    """
    curve, apart, whole = strands.curve(x), strands.apart, float(strands.knots[-1])
    spacing = max(min(whole / len(x), apart) / _PLACES, whole / _ALL_PLACES)
    s = np.arange(0.0, whole, spacing)
    for _ in range(_FINER):
        distances = np.linalg.norm(curve(s % whole) - curve((s + apart) % whole), axis=1)
        lowest = int(distances.argmin())
        if distances[lowest] < strands.diameter:
            return True
        s = s[lowest] + np.linspace(-spacing, spacing, 2 * _PLACES + 1)
        spacing /= _PLACES
    return False


def _swollen(strands: Strands, x: FloatArray) -> tuple[FloatArray, float]:
    """Return a loop near x (n, d), and for how thick a rod its strands are parted on it."""
    diameter, thick = strands.diameter, thinnest(strands, x)
    while thick < diameter:
        swelling = min(_SWELLS * thick, diameter)
        after = _parted(replace(strands, diameter=swelling), x)
        if after is None or strands.passed(x, after):
            break
        x, thick = after, swelling
    return x, thick


def _parted(strands: Strands, x: FloatArray) -> FloatArray | None:
    """Return a loop near x (n, d) on which no strands overlap; None if none is found."""
    lengths, known = Lengths(strands.loop), NO_GAPS
    for _ in range(_ROUNDS):
        near = _overlaps(strands, x)
        new = near[strands.unlike(near, known, _SAME)]
        try:
            known, widths = strands.at(x, known)
            if not len(new) and widths.min(initial=0.0) >= NEGATIVE:
                return x
            known = known.joined(new)
            after = _opened(HeldGaps(lengths, strands, known), x)
        except LinAlgError:
            return None
        if after is None:
            return None
        x = after
    return None


def _opened(held: HeldGaps, x: FloatArray) -> FloatArray | None:
    """Return the loop next to x (n, d) on which none of the gaps is negative; None if lost.

    Lengths are kept. A quadratic program tells, to first order, which gaps are closed for
    that, by forces that push: places that are close to each other cannot all be.
    """
    strands, n, rows = held.strands, len(x), held.jacobian(x)
    moves = held.moves(rows, x.shape)
    gram, (_, widths) = rows @ moves, strands.at(x, held.gaps)
    excess, across = strands.loop.constraint(x), gram[:n, n:]
    shares = cho_solve(cho_factor(gram[:n, :n]), np.column_stack([excess, across]))
    widths = widths - across.T @ shares[:, 0]
    forces = least_forces(gram[n:, n:] - across.T @ shares[:, 1:], widths)
    closed = HeldGaps(held.lengths, strands, held.gaps[forces > 0.0]).project(x)
    if closed is not None:
        return closed
    tensions = -shares[:, 0] - shares[:, 1:] @ forces
    moved = moves @ np.append(tensions, forces)
    return held.lengths.project(x + moved.reshape(x.shape))


def _overlaps(strands: Strands, x: FloatArray) -> Gaps:
    """Return where strands overlap: once an edge, and where they do so most in between."""
    near, _ = strands.near(x, NEGATIVE)
    least = strands.nearest(x, min(NEGATIVE, -_OVERLAP * strands.diameter))
    return near.joined(least[strands.unlike(least, near, _SAME)])


def _unbent(
    strands: Strands, x: FloatArray, steps: int, ends: Callable[[TangentModel], bool]
) -> FloatArray:
    """Return what a loop comes to that unbends by so many steps, or until it `ends`."""
    loop = strands.loop
    energy = LoopEnergy(
        {"bending": Bending(loop)}, Lengths(loop), loop.mean_lengths, rigid_motions
    )
    state, _ = ContactDescent(energy, strands, steps, ends=ends).run(x)
    return state.model.x
