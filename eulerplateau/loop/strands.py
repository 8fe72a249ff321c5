"""How far apart the strands of a loop with a thickness are, and how that changes.

Distances are those of the smooth curve through the loop's vertices, the periodic cubic
spline in rest arclength, gamma(s; x) = sum_v phi_v(s) x_v: linear in x, as rest lengths are
fixed. A gap is D - d, d the diameter and D a least distance |gamma(s) - gamma(t)|,

- by s and t, where two strands touch at a point: d2D/ds2 is positive there, D taken as
  least by t at each s;
- by t alone, s being a vertex's, along strands that lie beside each other, where d2D/ds2 is
  nearly 0, and least by s too means nothing.

The arclengths are eliminated (gaps.py). Strands nearer along the loop than pi d / 2 do not
touch where the curvature is below 2 / d.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import pi
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import LinAlgError
from scipy.sparse.csgraph import connected_components

from eulerplateau.arrays import BoolArray, FloatArray, IntArray
from eulerplateau.loop.gaps import NO_GAPS, Between, Gaps
from eulerplateau.loop.loop import Loop
from eulerplateau.loop.minima import flat_minima, rows_of
from eulerplateau.loop.strand_kernels import (
    nearest_pairs,
    nearest_to_places,
    settle_each,
)
from eulerplateau.loop.stretches import ALONG, first_of_each, of_one_strand, offsets
from eulerplateau.loop.twist import passed

# Strands touch at a point where they part at least so fast, d2D/ds2 in units of 1 / L:
# a loop's curvature is 2 pi. One that touches at a point does so until half of that.
_PARTING = 2.0
_STAYS = 0.5
# How much nearer chords may be than their curves are, in curvatures times squared edges.
_SAGGING = 0.5
# Parts of an edge within which two gaps are the same, or depend on each other.
_BESIDE = 0.75
# By how many edges the places of a gap may move while it is followed.
_FOLLOWED = 5.0
# Below which gap, in diameters, strands that touch may lie beside each other.
_FLAT = 1e-3
# Into so many chords edges are cut where their own may be too coarse.
_FINER = 8
# What closes a gap is spread over so much of the loop: over an edge it would be a kink.
_SPREAD = 0.03


class _Curve(NamedTuple):
    """A loop's vertices (n, d), its cubics (n, 4, d) and where they begin (n + 1,)."""

    x: FloatArray
    pieces: FloatArray
    knots: FloatArray


@dataclass(frozen=True)
class Strands:
    """The strands of a loop that is so thick, as functions of its vertices x (n, d).

    Gaps are in units of L; negative where strands overlap. Places that may touch are more
    than `apart` from each other along the loop.
    """

    loop: Loop
    diameter: float
    apart: float

    @cached_property
    def knots(self) -> FloatArray:
        """Where along the loop the vertices are (n + 1,), the first again at its end."""
        return np.concatenate([[0.0], np.cumsum(self.loop.rest_lengths)])

    @cached_property
    def _basis(self) -> CubicSpline:
        """The functions phi_v, as a function of s with values (n,)."""
        unit = np.eye(len(self.loop.rest_lengths))
        return CubicSpline(self.knots, np.vstack([unit, unit[:1]]), bc_type="periodic")

    @cached_property
    def compliance(self) -> FloatArray:
        """The inverse (n, n) of the norm <s> |dx|^2 + l^4 |dx''|^2 in which gaps close."""
        loop = self.loop
        norm = np.diag(loop.mean_lengths) + _SPREAD**4 * loop.bending_matrix
        return np.linalg.inv(norm).astype(np.float64, copy=False)

    def weights(self, s: FloatArray) -> FloatArray:
        """Return phi_v(s) (k, n), by which vertices make the curve at places s (k,)."""
        weights: FloatArray = self._basis(s % self.knots[-1])
        return weights

    def curve(self, x: FloatArray) -> CubicSpline:
        """Return the smooth curve through vertices x (n, d)."""
        return CubicSpline(self.knots, np.vstack([x, x[:1]]), bc_type="periodic")

    def passed(self, x: FloatArray, after: FloatArray) -> bool:
        """Return whether a strand has passed through another on a short way, x (n, d).

        Chords may where their curves do not: of these finer ones are asked then.
        """
        if not passed(x, after):
            return False
        return passed(self._finer @ x, self._finer @ after)

    @cached_property
    def _finer(self) -> FloatArray:
        """The weights (m n, n) of vertices at m places of each edge."""
        parts = np.arange(_FINER) / _FINER
        lengths = self.loop.rest_lengths[:, None]
        return self.weights((self.knots[:-1, None] + lengths * parts).ravel())

    def _pieces(self, x: FloatArray) -> FloatArray:
        """Return the curve's cubics (n, 4, d): a spline made anew costs ten times more."""
        pieces: FloatArray = (self._cubics @ x).reshape(len(x), 4, -1)
        return pieces

    @cached_property
    def _cubics(self) -> FloatArray:
        """The cubics of the functions phi_v (4 n, n), edge by edge."""
        n = len(self.loop.rest_lengths)
        return np.ascontiguousarray(self._basis.c.transpose(1, 0, 2)).reshape(4 * n, n)

    def near(
        self, x: FloatArray, reach: float, beside: Gaps = NO_GAPS
    ) -> tuple[Gaps, FloatArray]:
        """Return the places whose gap is below reach, and the gaps (k,).

        They are all there are: found by looking at all pairs of edges. Near places of
        `beside` strands do not touch at a point, however they part; those are on edges
        where the first of them is on its own.
        """
        curve = self._curve(x)
        pairs = self._least(curve, reach)
        points = Gaps(pairs[:, 0], pairs[:, 1], np.ones(len(pairs), dtype=bool))
        crossing = (pairs[:, 3] >= _PARTING) & self.unlike(points, beside, ALONG)
        looked_for = partial(
            nearest_to_places,
            *curve,
            offsets(self.knots, beside),
            *self._limits(reach),
        )
        rows = rows_of(looked_for, 6)
        least = Gaps(rows[:, 3], rows[:, 4], np.zeros(len(rows), dtype=bool))
        along: BoolArray = rows[:, 5] < _PARTING
        along |= ~self.unlike(least, beside, ALONG)
        rows, pairs = rows[along & (rows[:, 5] > -np.inf)], pairs[crossing]
        rows = rows[of_one_strand(self.knots, rows[:, 0], rows[:, 1], beside)]
        slides = np.arange(len(pairs) + len(rows)) < len(pairs)
        found = np.vstack([pairs[:, :3], rows[:, :3]])
        return Gaps(found[:, 0], found[:, 1], slides), found[:, 2] - self.diameter

    def nearest(self, x: FloatArray, reach: float) -> Gaps:
        """Return where gaps are least and below reach, however strands spread there."""
        curve = self._curve(x)
        least = np.vstack([self._least(curve, reach), self._flat(curve, reach)])
        least = least[first_of_each(least[:, :2], self.knots[-1])]
        return Gaps(least[:, 0], least[:, 1], np.zeros(len(least), dtype=bool))

    def smallest_gap(self, x: FloatArray, reach: float) -> float:
        """Return the least of all gaps, between places where they are held too.

        Infinite if none is below reach.
        """
        curve, flat = self._curve(x), min(reach, _FLAT * self.diameter)
        least = np.vstack([self._least(curve, reach), self._flat(curve, flat)])
        return float(least[:, 2].min(initial=np.inf) - self.diameter)

    def _least(self, curve: _Curve, reach: float) -> FloatArray:
        """Return where distances are least by s and t: rows s, t, D, d2D/ds2 (k, 4)."""
        bends = 2 * np.linalg.norm(curve.pieces[:, 1], axis=1) * self.loop.rest_lengths**2
        sagging = _SAGGING * float(bends.max())
        return rows_of(partial(nearest_pairs, *curve, *self._limits(reach), sagging), 4)

    def _flat(self, curve: _Curve, reach: float) -> FloatArray:
        """Return the same rows where D is flat, along strands beside each other."""
        return flat_minima(*curve, *self._limits(reach))

    def _curve(self, x: FloatArray) -> _Curve:
        return _Curve(np.ascontiguousarray(x), self._pieces(x), self.knots)

    def _limits(self, reach: float) -> tuple[float, float]:
        """Return the distance below which places are looked for, and `apart`."""
        return self.diameter + reach, self.apart

    def unlike(self, gaps: Gaps, others: Gaps, edges: float = _BESIDE) -> BoolArray:
        """Return which of `gaps` (k,) are farther from others than that, on a strand."""
        whole = self.knots[-1]

        def near(places: FloatArray, other: FloatArray) -> BoolArray:
            off = np.abs(places[:, None] - other) % whole
            edge = np.searchsorted(self.knots, places % whole, side="right") - 1
            reach = edges * self.loop.rest_lengths[np.minimum(edge, len(self.knots) - 2)]
            close: BoolArray = np.minimum(off, whole - off) < reach[:, None]
            return close

        same = near(gaps.s, others.s) & near(gaps.t, others.t)
        turned = near(gaps.s, others.t) & near(gaps.t, others.s)
        unlike: BoolArray = np.logical_not(np.any(same | turned, axis=1))
        return unlike

    def distinct(self, gaps: Gaps, edges: float = _BESIDE) -> BoolArray:
        """Return which gaps (k,) are not within so many edges of one before them."""
        kept = np.ones(len(gaps), dtype=bool)
        for k in range(1, len(gaps)):
            before = np.arange(len(gaps)) < k
            one = gaps[np.arange(len(gaps)) == k]
            kept[k] = self.unlike(one, gaps[kept & before], edges)[0]
        return kept

    def contacts(self, gaps: Gaps) -> IntArray:
        """Return the number of the contact (k,) of which each gap is a place."""
        if not len(gaps):
            return np.zeros(0, dtype=np.int64)
        each = np.eye(len(gaps), dtype=bool)
        beside = [~self.unlike(gaps, gaps[here], ALONG) for here in each]
        number: IntArray = connected_components(np.array(beside))[1].astype(np.int64)
        return number

    def parting(self, x: FloatArray, gaps: Gaps) -> FloatArray:
        """Return d2D/ds2 (k,) where D is least near each of the places, by s and t."""
        slides = np.ones(len(gaps), dtype=bool)
        return self._followed(self._pieces(x), replace(gaps, slides=slides))[1]

    def spreading(self, x: FloatArray, gaps: Gaps) -> FloatArray:
        """Return d2D/ds2 (k,) at each of the places, D the least distance by t."""
        held = np.zeros(len(gaps), dtype=bool)
        return self._followed(self._pieces(x), replace(gaps, slides=held))[1]

    def laid_along(self, x: FloatArray, gaps: Gaps) -> BoolArray:
        """Return where (k,) strands touch at a point that lie along each other by now."""
        along: BoolArray = self.parting(x, gaps) < _STAYS * _PARTING
        laid: BoolArray = gaps.slides & along
        return laid

    def at(self, x: FloatArray, gaps: Gaps) -> tuple[Gaps, FloatArray]:
        """Return gaps followed to a loop x (n, d), and how wide they are (k,).

        Raises LinAlgError where one is lost: the loop has moved too far.
        """
        rows, _ = self._followed(self._pieces(x), gaps)
        off = np.maximum(np.abs(rows[:, 0] - gaps.s), np.abs(rows[:, 1] - gaps.t))
        if len(gaps) and float(off.max()) > _FOLLOWED * self.loop.rest_lengths.max():
            raise LinAlgError("a contact has moved too far to be followed")
        return replace(gaps, s=rows[:, 0], t=rows[:, 1]), rows[:, 2] - self.diameter

    def downhill(self, x: FloatArray, gaps: Gaps) -> tuple[Gaps, FloatArray]:
        """Return where strands are nearest from places on, however far, and gaps (k,)."""
        slides = np.ones(len(gaps), dtype=bool)
        rows, _ = self._followed(self._pieces(x), replace(gaps, slides=slides))
        return Gaps(rows[:, 0], rows[:, 1], slides), rows[:, 2] - self.diameter

    def _followed(self, pieces: FloatArray, gaps: Gaps) -> tuple[FloatArray, FloatArray]:
        # Columns of a table would be compiled for a second time.
        s, t = np.ascontiguousarray(gaps.s), np.ascontiguousarray(gaps.t)
        rows = settle_each(pieces, self.knots, s, t, gaps.slides)
        return rows[:, :3], rows[:, 3]

    def between(self, x: FloatArray, gaps: Gaps) -> Between:
        """Return what is known between places that are settled at x (n, d)."""
        whole = self.knots[-1]
        s, t = gaps.s % whole, gaps.t % whole
        weights = self._basis(s) - self._basis(t)
        slopes = np.stack([self._basis(s, 1), -self._basis(t, 1)])
        curved = np.stack([self._basis(s, 2), -self._basis(t, 2)])
        across = weights @ x
        distances = np.linalg.norm(across, axis=1)
        if not distances.all():
            raise LinAlgError("strands of the loop meet")
        normals = across / distances[:, None]
        bends = np.einsum("ekn,nd,kd->ek", curved, x, normals, optimize=True)
        return Between(weights, slopes, normals, distances, slopes @ x, bends)


def strands_of(loop: Loop) -> Strands:
    """Return the strands of a loop that has a diameter."""
    assert loop.diameter is not None
    return Strands(loop, loop.diameter, 0.5 * pi * loop.diameter)
