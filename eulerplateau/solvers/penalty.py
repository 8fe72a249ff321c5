"""How stiffly an augmented Lagrangian holds the lengths of a loop's edges."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Loop
from eulerplateau.mesh import Shape

_STIFFER_THAN_BENDING = 1000.0
# What rounding may leave of forces, of what they are to be balanced to.
_ROUNDED = 0.3


def first_penalty(loop: Loop, load: float) -> float:
    """Return the stretching stiffness mu, alpha / L^2.

    Its stiffest mode is as stiff as the loop's in bending, 4 mu / s = 16 / s^3: softer lets
    lengths drift, stiffer slows the iteration down. But film and bending are to be weak
    against it, load and 4 pi^2 against mu / 8: else they would draw the loop to a point.
    """
    even = 4.0 / float(np.mean(loop.rest_lengths)) ** 2
    return max(even, 10.0 * load, _STIFFER_THAN_BENDING)


def bearable_penalty(
    loop: Loop, shape: Shape, forces: Iterable[FloatArray], residual: float
) -> float:
    """Return the penalty mu, alpha / L^2, that rounded positions bear.

    Tensions are wrong by mu / s of what edges are rounded by, and the forces on a vertex by
    those of two edges: that is to be small beside the residual, which is all that forces
    may leave of the largest.
    """
    largest = max(float(np.abs(part).max()) for part in forces)
    shortest = float(loop.rest_lengths.min())
    return _ROUNDED * residual * largest * shortest / (2 * rounded(shape))


def rounded(shape: Shape) -> float:
    """Return what the loop's positions, and with them its edges, are rounded by."""
    return float(np.spacing(np.abs(shape.x_loop).max()))
