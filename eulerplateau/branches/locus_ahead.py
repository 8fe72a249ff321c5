"""Where a curve of special points goes on.

A point's direction d is of unit arclength. By the way t along another direction w the curve
has the derivative d / (w . d), whose part along w is 1: guesses lie in the hyperplanes in
which they are corrected.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import pairwise, takewhile

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.branches.control import Motion
from eulerplateau.branches.locus_point import LocusPoint

# Points whose directions say where a curve goes on, and the cosine up to which they do.
_KNOWN = 6
_STRAIGHT = 0.8


@dataclass(frozen=True)
class Ahead:
    """Where a curve goes on from its last points.

    By their directions (Adams and Bashforth 1883): what none of them has in it, as rigid
    motions, no step adds. And by what the last step missed (Hamming 1959): films slide on
    their meshes, of which the equations' derivatives know nothing.

    Attributes
    ----------
    points : the last first
    missed : per arclength, by the last step that directions alone say
    """

    points: tuple[LocusPoint, ...]
    missed: Motion

    @classmethod
    def of(cls, point: LocusPoint) -> Ahead:
        """Return what is known of a first point alone."""
        return cls((point,), point.direction * 0.0)

    @property
    def point(self) -> LocusPoint:
        """The last point."""
        return self.points[0]

    def then(self, point: LocusPoint) -> Ahead:
        """Return what is known of the next point."""
        step = self.point.dot(self.point.direction, point.place - self.point.place)
        missed = (point.place - self.guess(step)[0]) * (1 / step) + self.missed
        return Ahead((point, *self.points)[:_KNOWN], missed)

    def guess(self, step: float) -> tuple[Motion, Motion]:
        """Return place and steepness at arclength `step` from the last point.

        By Newton's polynomials 1, t - t_0, (t - t_0)(t - t_1), ... through the points.
        """
        point, way = self.point, self.point.direction
        dot = point.dot
        straight = takewhile(lambda it: dot(way, it.direction) > _STRAIGHT, self.points)
        near = list(straight)
        t = [dot(way, it.place - point.place) for it in near]
        basis = [np.atleast_1d(np.poly(t[:degree])) for degree in range(len(near))]
        slopes = [it.direction * (1 / dot(way, it.direction)) for it in near]
        heights = [it.steepness for it in near]
        ways = [float(np.polyval(np.polyint(each), step)) for each in basis]
        values = [float(np.polyval(each, step)) for each in basis]
        place = point.place + self._sum(_divided(t, slopes), ways)
        return place + self.missed * step, self._sum(_divided(t, heights), values)

    def _sum(self, coefficients: Iterator[Motion], values: list[float]) -> Motion:
        """Return the sum of a polynomial's terms, as long as they get smaller."""
        terms = (each * value for each, value in zip(coefficients, values, strict=True))
        total = next(terms)
        least = self.point.dot(total, total)
        for term in terms:
            size = self.point.dot(term, term)
            if size >= least:
                break
            total, least = total + term, size
        return total

    def reached(self, step: float) -> LocusPoint | None:
        """Return the point at arclength `step` from there; None if it is not corrected."""
        place, steepness = self.guess(step)
        near = replace(self.point, steepness=steepness)
        found = near.next_to(place, self.point.direction)
        with suppress(LinAlgError):
            return found if found is None or np.isfinite(found.coefficient) else None
        return None


def _divided(t: list[float], values: list[Motion]) -> Iterator[Motion]:
    """Yield Newton's divided differences at t: of the first value, the first two, ..."""
    yield values[0]
    for degree in range(1, len(values)):
        spans = zip(t[degree:], t, strict=False)
        steps = [1 / (end - start) for end, start in spans]
        gaps = [after - before for before, after in pairwise(values)]
        values = [gap * step for gap, step in zip(gaps, steps, strict=True)]
        yield values[0]
