"""How far points of an outline lie from a curve: orthogonal distances, and their slopes.

Unknowns are the curve's shape, the logarithm of its size, its place (2) and its angle. The
foot of a point is the nearest point of the curve within a window about where the outline's
own arc length puts it: where strands touch, the nearest may be another strand's.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Generic, NamedTuple

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.outline.curves import C, Curve, rotation
from eulerplateau.exact.planar.halves import Points

_NODES = 512
# Part of the curve that is searched on either side.
_WINDOW = 0.08
_NEWTON, _FOUND = 8, 1e-15


class Matched(NamedTuple):
    """Points and their feet: arc lengths (n,), distances outwards (n,), slopes (n, p)."""

    t: FloatArray
    distances: FloatArray
    slopes: FloatArray


@dataclass(frozen=True)
class Matching(Generic[C]):
    """Points (n, 2) of an outline beside curves of a family.

    Attributes
    ----------
    near : (n,) where on the curve each point's foot is sought
    offset : float, of the outline outwards from the centreline
    """

    points: FloatArray
    curves: C
    near: FloatArray
    offset: float = 0.0
    _grid: FloatArray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Lay the nodes among which feet are sought first."""
        reach = self.curves.reach
        grid = np.linspace(-reach, reach, _NODES, endpoint=not self.curves.closed)
        object.__setattr__(self, "_grid", grid)

    def at(self, unknowns: FloatArray) -> Matched:
        """Return the feet, the distances and their derivatives by the unknowns (p,)."""
        count = self.curves.numbers
        shape, (log_size, *place, angle) = unknowns[:count], unknowns[count:]
        curve, size = self.curves.curve(shape), float(np.exp(log_size))
        turn = rotation(angle)
        own = (self.points - place) @ turn / size
        t = self._feet(curve, own)
        foot = curve.points(t)
        outwards = np.stack([np.sin(foot.angle), -np.cos(foot.angle)], -1)
        distances = size * np.einsum("nd,nd->n", own - foot.x, outwards) - self.offset
        across = size * np.einsum("cnd,nd->cn", self.curves.slopes(shape, t), outwards)
        turned = np.stack([-foot.x[:, 1], foot.x[:, 0]], -1)
        slopes = np.stack(
            [
                *across,
                size * np.einsum("nd,nd->n", foot.x, outwards),
                *(outwards @ turn.T).T,
                size * np.einsum("nd,nd->n", turned, outwards),
            ],
            axis=1,
        )
        return Matched(t, distances, -slopes)

    def followed(self, t: FloatArray) -> Matching[C]:
        """Return the matching whose feet are sought about the arc lengths t (n,)."""
        return replace(self, near=t)

    def _feet(self, curve: Curve, own: FloatArray) -> FloatArray:
        """Return the arc lengths (n,) of the feet of points (n, 2) in the curve's frame."""
        nodes, grid = curve.points(self._grid).x, self._grid
        half = int(_WINDOW * _NODES)
        spacing = grid[1] - grid[0]
        middle = np.rint((self.near - grid[0]) / spacing).astype(int)
        window = middle[:, None] + np.arange(-half, half + 1)
        if self.curves.closed:
            window %= _NODES
        else:
            window = np.clip(window, 0, _NODES - 1)
        square = ((own[:, None, :] - nodes[window]) ** 2).sum(axis=-1)
        nearest = square.argmin(axis=1)
        t = grid[window[np.arange(len(own)), nearest]]
        for _ in range(_NEWTON):
            step = np.clip(_ahead(curve.points(t), own), -spacing, spacing)
            t = t + step
            if np.abs(step).max(initial=0.0) < _FOUND:
                break
        return np.asarray(t)


def _ahead(foot: Points, own: FloatArray) -> FloatArray:
    """Return Newton's step (n,) along the curve to where the line to a point is normal."""
    away = own - foot.x
    cosine, sine = np.cos(foot.angle), np.sin(foot.angle)
    along = away[:, 0] * cosine + away[:, 1] * sine
    inwards = -away[:, 0] * sine + away[:, 1] * cosine
    # Beyond the centre of curvature the nearest point is no minimum of its neighbours.
    return np.asarray(along / np.maximum(1 - foot.kappa * inwards, 0.2))
