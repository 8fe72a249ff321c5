"""Which loops are the same: up to rigid motion, reflection, and numbering.

Loops are compared by points that lie evenly along them. Of a film that is tied to its rest
mesh only those numberings change nothing that bring the loop at rest back onto itself; a
soap film's loop slides, and may be numbered from anywhere, either way round. Loops are
(n, d), d = 3, or 2 in a plane, which count as flat in space.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.branches.symmetry import OPERATIONS, in_space, loop_symmetries, numberings
from eulerplateau.loop import Loop

# Points are numbered alike after 1/2, 1/3, 1/4, 1/6 and 1/12 of the way round.
_DIVISIBLE = 12
_SLIDINGS = 5
# Points along each edge, by which symmetries are told.
_BETWEEN = 4


@dataclass(frozen=True)
class Difference:
    """What is left of a loop less the copy of another that comes closest to it.

    Attributes
    ----------
    rest : (m, 3) float, at the points by which they are compared
    """

    rest: FloatArray

    @property
    def square(self) -> float:
        """The mean square of the distance, in units of L^2."""
        return float(np.mean(np.sum(self.rest**2, axis=1)))

    @property
    def distance(self) -> float:
        """The r.m.s. distance, in units of L."""
        return float(np.sqrt(self.square))


@dataclass(frozen=True)
class Likeness:
    """Which copies of a loop (n, d) are the same, by m points along it.

    Attributes
    ----------
    points : (m, n) float, which takes vertices to points
    numberings : (k, m) int, those that change nothing
    slides : bool, whether the loop slides along itself for nothing
    """

    points: FloatArray
    numberings: IntArray
    slides: bool

    def distance(self, x: FloatArray, other: FloatArray) -> float:
        """Return the r.m.s. distance of two loops (n, d), less what makes no difference."""
        return self.difference(x, other).distance

    def difference(self, x: FloatArray, other: FloatArray) -> Difference:
        """Return what is left of a loop less the nearest copy of another, both (n, d).

        Of all copies by rotations and reflections, Kabsch's is the nearest; its square is
        that of both loops less twice the sum of singular values.
        """
        a, b = self._centred(x), self._centred(other)
        copies = b[self.numberings]
        overlap = np.einsum("kmi,mj->kij", copies, a)
        nearest = int(np.linalg.svd(overlap, compute_uv=False).sum(axis=1).argmax())
        copy = copies[nearest]
        moved = _slid(copy, a) if self.slides else copy
        return Difference(a - moved @ _turn(moved, a))

    def slope(self, difference: Difference, moved: FloatArray) -> float:
        """Return how the square of a difference changes as its loop moves (n, d).

        The nearest copy is stationary: to first order it makes no difference that it moves.
        """
        step = self.points @ in_space(moved)
        return 2 * float(np.mean(np.sum(difference.rest * step, axis=1)))

    def turns(self, x: FloatArray, within: float) -> int:
        """Return after how many parts of the way round a loop (n, d) is the same again.

        0 of a loop that is the same anywhere: a circle.
        """
        a = self._centred(x)
        shifts = numberings(len(a))[: len(a)]
        same = _squares(a, shifts) < within**2
        return int(np.sum(same & ~np.roll(same, 1)))

    def _centred(self, x: FloatArray) -> FloatArray:
        points = self.points @ in_space(x)
        centred: FloatArray = points - points.mean(axis=0)
        return centred


def _turn(copy: FloatArray, a: FloatArray) -> FloatArray:
    """Return what turns and reflects centred points (m, 3) to lie closest to others.

    A matrix (3, 3) for rows (Kabsch).
    """
    u, _, vt = np.linalg.svd(copy.T @ a)
    turn: FloatArray = u @ vt
    return turn


def _slid(copy: FloatArray, a: FloatArray) -> FloatArray:
    """Return centred points (m, 3) moved along their loop, towards others.

    By Gauss and Newton's steps in rotations and sliding together. Sliding is in straight
    lines: then the best place is stationary, and `slope` is exact.
    """
    along, slid = np.roll(copy, -1, axis=0) - np.roll(copy, 1, axis=0), 0.0
    for _ in range(_SLIDINGS):
        moved = copy + slid * along
        turn = _turn(moved, a)
        turned = moved @ turn
        rotations = [np.cross(axis, turned) for axis in np.eye(3)]
        moves = np.stack([*rotations, along @ turn], axis=-1).reshape(-1, 4)
        slid += float(np.linalg.lstsq(moves, (a - turned).ravel(), rcond=1e-6)[0][3])
    return copy + slid * along


def likeness(loop: Loop, rest: FloatArray, slides: bool, within: float) -> Likeness:
    """Return which loops are the same.

    Parameters
    ----------
    rest : (n, 3) float, the loop at rest
    slides : bool, whether it slides along itself for nothing
    within : float
        If not, the r.m.s. distance, in units of L, up to which a numbering brings it back
        onto itself at rest.
    """
    # From its farthest vertex: a mirror of a polygon goes through a corner.
    first = int(np.linalg.norm(rest - rest.mean(axis=0), axis=1).argmax())
    points = _evenly(loop.rest_lengths, first)
    every = numberings(len(points))
    if slides:
        return Likeness(points, every, slides)
    return Likeness(points, _symmetries(points @ rest, every, within), slides)


def _symmetries(rest: FloatArray, every: IntArray, within: float) -> IntArray:
    """Return those numberings (k, m) that bring points at rest (m, 3) back onto themselves.

    Their own is the first of them.
    """
    squares = _squares(rest - rest.mean(axis=0), every)
    return every[squares < within**2]


def _squares(a: FloatArray, every: IntArray) -> FloatArray:
    """Return the mean squares (k,) of centred points (m, 3) less themselves renumbered."""
    overlap = np.einsum("kmi,mj->kij", a[every], a)
    gained = np.linalg.svd(overlap, compute_uv=False).sum(axis=1)
    squares: FloatArray = 2 * np.maximum(np.sum(a**2) - gained, 0.0) / len(a)
    return squares


def _evenly(rest_lengths: FloatArray, first: int) -> FloatArray:
    """Return what takes vertices (n, d) to points evenly along their edges (m, d)."""
    n = len(rest_lengths)
    m = _DIVISIBLE * -(-n // _DIVISIBLE)
    s = np.roll(rest_lengths, -first)
    ends = np.concatenate([[0.0], np.cumsum(s)])
    place = ends[-1] * np.arange(m) / m
    edge = np.minimum(np.searchsorted(ends, place, side="right") - 1, n - 1)
    part = (place - ends[edge]) / s[edge]
    points = np.zeros((m, n))
    points[np.arange(m), (edge + first) % n] = 1 - part
    points[np.arange(m), (edge + 1 + first) % n] += part
    return points


def symmetry_of(x: FloatArray, same: Likeness, within: float) -> str:
    """Return what brings a loop (n, 3) back onto itself, in words.

    `round`, and how often it is wound; or into how many parts that are alike it falls, and
    the mirrors, half turns and inversion along its axes, `box` if it has all of them.
    """
    turns = same.turns(x, within)
    if turns == 0:
        times = round(_turning(x) / (2 * np.pi))
        return "round" if times == 1 else f"round; wound {times} times"
    parts = [f"{turns}-fold"] if turns > 1 else []
    own = loop_symmetries(_finer(x), within)
    return "; ".join([*parts, *(["box"] if len(own) == len(OPERATIONS) else own)])


def _turning(x: FloatArray) -> float:
    """Return the sum of the angles between consecutive edges of a loop (n, 3), radians."""
    edges = np.roll(x, -1, axis=0) - x
    edges /= np.linalg.norm(edges, axis=1)[:, None]
    cosines = np.sum(edges * np.roll(edges, 1, axis=0), axis=1)
    return float(np.sum(np.arccos(np.clip(cosines, -1, 1))))


def _finer(x: FloatArray) -> FloatArray:
    """Return a loop (n, 3) with points between its vertices, where an axis may pass."""
    after = np.roll(x, -1, axis=0)
    parts = np.arange(_BETWEEN)[None, :, None] / _BETWEEN
    finer: FloatArray = (x[:, None] + parts * (after - x)[:, None]).reshape(-1, x.shape[1])
    return finer
