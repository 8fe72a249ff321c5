"""Which way a rod's cross-sections point along its loop: its material frame.

A direction across the rod that is carried along without turning about it (parallel
transport) comes back turned by the loop's writhe. The rod's own turn with its twist, which
is the same everywhere: together, round the loop, by what it was given before it was welded.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.frame_kernels import carried, turned
from eulerplateau.loop.loop import differences
from eulerplateau.loop.writhe_kernels import tangent_areas, transported


@dataclass(frozen=True)
class Frame:
    """The material frame of a rod along a loop, in the middle of each edge.

    Attributes
    ----------
    x : (n, 3) float, the loop
    turns : float, the whole twist: link less writhe
    tangents, directors : (n, 3) float, t and d1, unit vectors
    lengths : (n,) float, of the edges
    twists : (n,) float
        The angle that d1 turns by at the vertex after each edge, beyond what it must; after
        the last edge, at the weld, that with which it goes on as it began. Right-handed is
        positive.
    """

    x: FloatArray
    turns: float
    tangents: FloatArray
    lengths: FloatArray
    directors: FloatArray
    twists: FloatArray

    @classmethod
    def even(cls, x: FloatArray, turns: float) -> Frame:
        """Return the frame of a rod whose twist is the same everywhere."""
        edges = differences(x)
        lengths = np.linalg.norm(edges, axis=1)
        means = 0.5 * (lengths + np.roll(lengths, -1))
        tangents = edges / lengths[:, None]
        twists = 2 * np.pi * turns * means / lengths.sum()
        return cls(x, turns, tangents, lengths, directors(x, turns), twists)

    def turned(self, angles: FloatArray) -> Frame:
        """Return the frame turned about each edge by angles (n,)."""
        found = turned(self.tangents, self.directors, angles)
        twists = self.twists + np.roll(angles, -1) - angles
        return replace(self, directors=found, twists=twists)

    def carried(self, x: FloatArray) -> Frame:
        """Return the frame on a loop near by, carried there without turning about edges.

        What twist it gains is the area that the tangents lose on the way.
        """
        edges = differences(x)
        lengths = np.linalg.norm(edges, axis=1)
        tangents = edges / lengths[:, None]
        gained = tangent_areas(self.tangents, tangents).sum(axis=1)
        turns = self.turns - float(gained.sum()) / (2 * np.pi)
        found = carried(self.tangents, tangents, self.directors)
        return Frame(x, turns, tangents, lengths, found, self.twists - gained)

    def angles_to(self, other: Frame) -> FloatArray:
        """Return the angles (n,) that turn it into a frame of a loop near by.

        That is carried here, what its whole twist is more or less spread evenly. The first
        is between -pi and pi.
        """
        moved = other.carried(self.x)
        excess = moved.twists - self.twists
        excess -= excess.mean()
        there, here, t = moved.directors[0], self.directors[0], self.tangents[0]
        first = np.arctan2(np.cross(here, there) @ t, here @ there)
        angles: FloatArray = first + np.cumsum(excess) - excess
        return angles


def directors(x: FloatArray, twist: float) -> FloatArray:
    """Return directions (n, 3) across the edges of a loop x (n, 3), turning with the rod.

    In the middle of each edge. `twist` is in turns, right-handed ones positive. The weld is
    at the first vertex, where the first direction and the last differ by what twist and
    writhe together are no whole number of turns.
    """
    edges = differences(x)
    lengths = np.linalg.norm(edges, axis=1)
    tangents = edges / lengths[:, None]
    # Any direction will do to begin with: the axis along which the first edge is shortest.
    first = np.cross(tangents[0], np.eye(3)[np.abs(tangents[0]).argmin()])
    unturned = transported(tangents, first / np.linalg.norm(first))
    middles = (np.cumsum(lengths) - 0.5 * lengths) / lengths.sum()
    angle = 2 * np.pi * twist * middles[:, None]
    found: FloatArray = np.cos(angle) * unturned
    found += np.sin(angle) * np.cross(tangents, unturned)
    return found
