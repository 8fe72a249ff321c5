"""Where a cell ends: its edge meets itself, or two of its adhesions meet.

The area of a film is unsigned: where the edge has crossed itself, the polygon's signed area
counts a lobe that runs clockwise as negative, and the energy has no lower bound. As sides
have free lengths, adhesions slide along the edge; what is left where two of them have met
is a side without length.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.cells import touching_kernels as kernels
from eulerplateau.loop import Term, edges_of

# A resolved edge that turns back on itself takes six polygon edges to do so.
_TURNING_BACK = 6.0
# Strands touch that come within one polygon edge of each other. A descent that has come
# within a little more is at its end.
_REACH, _AT_THE_END = 1.0, 1.05
# A side has collapsed that has less than this part of its share of the perimeter.
_COLLAPSED = 1e-2


def crosses_itself(x: FloatArray) -> bool:
    """Return whether two edges of a closed polygon (n, 2) meet that are no neighbours."""
    return kernels.crosses(np.ascontiguousarray(x))


def strands_near(x: FloatArray, reach: float = _AT_THE_END) -> bool:
    """Return whether two stretches of a loop (n, 2) are within `reach` of their edges.

    By default a little more than one edge, which counts as touching.
    """
    lengths = edges_of(x).lengths
    return kernels.near(np.ascontiguousarray(x), lengths, reach, _TURNING_BACK)


def touches(x: FloatArray) -> bool:
    """Return whether a loop (n, 2) meets itself, as near as its edges can tell."""
    return strands_near(x) or crosses_itself(x)


def collapsed(x: FloatArray, shares: FloatArray) -> bool:
    """Return whether a side of a loop (n, 2) has lost its share (N,) of the perimeter."""
    sides = edges_of(x).lengths.reshape(len(shares), -1).sum(axis=1)
    return bool((sides < _COLLAPSED * shares * sides.sum()).any())


@dataclass(frozen=True, eq=False)
class Apart(Term):
    """No energy, but no way through: strands of a loop (n, 2) do not pass each other.

    Attributes
    ----------
    shares : (N,) float, the sides' parts of the perimeter where they are straight
    close : bool
        Whether they may come near each other, though not cross: for a loop that starts
        so, as a polygon with a corner as sharp as a needle does.
    """

    shares: FloatArray
    close: bool = False

    def force(self, x: FloatArray) -> FloatArray:
        """Return no force (n, 2)."""
        return np.zeros_like(x)

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return no stiffness (n, n)."""
        return np.zeros((len(x), len(x)))

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return zero; raise LinAlgError where strands meet at x + step."""
        after = x + step
        if crosses_itself(after) or (not self.close and strands_near(after, _REACH)):
            raise LinAlgError("the edge of the cell meets itself")
        return 0.0

    def holds(self, x: FloatArray) -> bool:
        """Return whether strands are clear of each other, and adhesions of their next."""
        return (self.close or not strands_near(x)) and not collapsed(x, self.shares)
