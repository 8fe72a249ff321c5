"""Turn the shapes of a run to lie alike, so that one view does for all their pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.runs import Shape


def aligned(shapes: Sequence[Shape]) -> list[Shape]:
    """Return the shapes free of the rigid motion an equilibrium leaves undetermined.

    Each loop is centred at the origin, its longest principal axis along x and its
    shortest along z, and then turned by half a turn about an axis, or not, to lie as close
    to its predecessor as it can. (Turning it there all the way, by Kabsch's method, as an
    animation must, would stand the flat eight on edge: the two halves of the film it comes
    from turn by a quarter each, in opposite senses.) The first loop has its normal along
    +z. A tie, which only symmetric films can have, falls either way.
    """
    turned: list[Shape] = []
    for shape in shapes:
        x = shape.x - shape.x[shape.loop].mean(axis=0)
        choices = [x @ axes for axes in _principal_axes(x[shape.loop])]
        if turned:
            before = turned[-1].x[shape.loop]
            away = [np.linalg.norm(choice[shape.loop] - before) for choice in choices]
        else:
            away = [-_area_vector(choice[shape.loop])[2] for choice in choices]
        turned.append(replace(shape, x=choices[int(np.argmin(away))]))
    return turned


def _principal_axes(loop: FloatArray) -> list[FloatArray]:
    """Return the four right-handed sets of axes, as columns (3, 3), longest axis first."""
    axes = np.linalg.svd(loop, full_matrices=False)[2].T
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    signs = ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1))
    return [axes * np.array(sign) for sign in signs]


def _area_vector(loop: FloatArray) -> FloatArray:
    area: FloatArray = 0.5 * np.cross(loop, np.roll(loop, -1, axis=0)).sum(axis=0)
    return area
