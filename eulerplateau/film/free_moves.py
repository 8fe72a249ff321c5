"""A curved film whose vertices inside are free to move, and its way to least area.

Where the film is curved its area depends, weakly, on where its vertices lie; of the places
next to a discrete minimal surface (minimal_surface.py) one is best. Newton's method finds
it, the Hessian shifted where it is not positive definite.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film.condensation import Condensation, factorise
from eulerplateau.film.elimination import Elimination, plan
from eulerplateau.film.indefinite import IndefiniteFactor
from eulerplateau.film.tiling import LIMITS, Tiling, TriangleGeometry
from eulerplateau.film.with_loop import LoopStiffness

_AXES = np.arange(3)
# Rounding of forces of unit tension along an edge, in eps: some twenty of them are summed.
ROUNDING = 20 * float(np.finfo(np.float64).eps)
_STEPS = 60
# The stiffness added against sliding, which inside flat pieces would cost nothing.
STILL = 1e-12
# Where the area curves downwards more is added: at first the least, then so many times as
# much, up to a thousand times what its triangles offer to displacements across them.
_LEAST, _STIFFER, _STIFFEST = 1e-7, 4.0, 1e3
# A shift shrinks after steps that are long, and grows after short ones.
_SOFTER, _LONG, _SHORT = 0.25, 0.5, 0.1
_HALVINGS = 6
# A vertex moves at most this part of the shortest side at it, and no triangle turns farther
# than this cosine.
_FARTHEST = 0.3


@dataclass(frozen=True)
class FreeInterior:
    """All displacements of a curved film: three unknowns for each vertex inside."""

    tiling: Tiling

    @property
    def size(self) -> int:
        """Three for each vertex inside."""
        return 3 * len(self.tiling.interior)

    def displaced(self, u: FloatArray) -> FloatArray:
        """Return u as (n_i, 3)."""
        return u.reshape(-1, 3)

    def work(self, gradient: FloatArray) -> FloatArray:
        """Return the gradient inside (3 n_i,)."""
        return gradient[self.tiling.interior].ravel()

    def stiffened(
        self, sides: TriangleGeometry, shift: float
    ) -> tuple[Condensation, float]:
        """Factorise the Hessian inside plus a shift, the least found that does.

        From the given one on; returns the shift too. Raises LinAlgError if none does.
        """
        blocks = self.tiling.hessian(sides)
        while True:
            shifted = self._stiffened(blocks, shift)[self._pairs_inside]
            try:
                return factorise(self._inside, shifted.ravel()), shift
            except LinAlgError:
                if shift > _STIFFEST:
                    raise
            shift = max(_STIFFER * shift, _LEAST)

    def condense(self, blocks: FloatArray) -> Condensation:
        """Eliminate all displacements inside."""
        return factorise(self._elimination, self._stiffened(blocks, STILL).ravel())

    def with_loop(
        self, blocks: FloatArray, load: float, loop: LoopStiffness, strip: bool
    ) -> IndefiniteFactor:
        """Raise LinAlgError: a free film is condensed."""
        raise LinAlgError("a free film is condensed")

    def followed(self, moved: FloatArray) -> FloatArray:
        """Return a displacement (n_b, 3) of the loop alone (n_v, 3)."""
        whole = np.zeros((self.tiling.n_v, 3))
        whole[self.tiling.loop] = moved
        return whole

    def carried(self, forces: FloatArray) -> FloatArray:
        """Return those on the loop (n_b, 3)."""
        return forces[self.tiling.loop]

    def _stiffened(self, blocks: FloatArray, shift: float) -> FloatArray:
        blocks = blocks.copy()
        blocks[self._own[:, None], _AXES, _AXES] += shift
        return blocks

    @cached_property
    def _own(self) -> IntArray:
        """The pairs of a vertex with itself."""
        i, k = self.tiling.pairs
        return np.flatnonzero(i == k)

    @cached_property
    def _pairs_inside(self) -> IntArray:
        i, k = self.tiling.pairs
        inside = self.tiling.is_inside
        return np.flatnonzero(inside[i] & inside[k])

    @cached_property
    def _pieces(self) -> list[IntArray]:
        small = self.tiling.small_pieces
        return [(3 * piece[:, None] + _AXES).ravel() for piece in small]

    @cached_property
    def _inside(self) -> Elimination:
        return self._planned(self._pairs_inside, np.zeros(0, dtype=np.int64))

    @cached_property
    def _elimination(self) -> Elimination:
        kept = np.arange(self.size, 3 * self.tiling.n_v)
        return self._planned(np.arange(len(self.tiling.pairs[0])), kept)

    def _planned(self, pairs: IntArray, kept: IntArray) -> Elimination:
        i, k = self.tiling.pairs
        number = 3 * self.tiling.numbers[:, None] + _AXES
        row = np.repeat(number[i[pairs]], 3, axis=1)
        column = np.tile(number[k[pairs]], 3)
        return plan(row.ravel(), column.ravel(), self._pieces, kept)


def at_rest(free: FreeInterior, x: FloatArray) -> FloatArray:
    """Return the film of least area near a shape (n_v, 3), its loop and triangles kept.

    Raises LinAlgError where none is found.
    """
    error, shift = np.inf, STILL
    for _ in range(_STEPS):
        sides = free.tiling.sides(x)
        force = free.work(free.tiling.gradient(sides))
        before, error = error, float(np.abs(force).max(initial=0.0))
        if is_rest(sides, error, before, shift == STILL):
            return x
        x, shift = smaller(free, x, sides, force, shift)
    raise LinAlgError("the film does not come to rest")


def is_rest(sides: TriangleGeometry, error: float, before: float, full: bool) -> bool:
    """Whether what is left of forces, after a full step or not, is rounding."""
    scale = sides.scale
    stuck = full and error < 1e-9 * scale and error > 0.25 * before
    return error <= ROUNDING * scale or stuck


def smaller(
    free: FreeInterior,
    x: FloatArray,
    sides: TriangleGeometry,
    force: FloatArray,
    shift: float,
) -> tuple[FloatArray, float]:
    """Return the film (n_v, 3) after one step that makes it smaller, and the next shift.

    force : (3 n_i,), the gradient inside. Raises LinAlgError if no shift helps.
    """
    inverse, shift = free.stiffened(sides, shift)
    step = -inverse.solve(force)
    x, part = _moved(free.tiling, x, sides, free.displaced(step), float(force @ step))
    if part < _SHORT:
        shift = max(_STIFFER * shift, _LEAST)
    elif part > _LONG:
        shift = max(_SOFTER * shift, STILL)
    return x, shift


def _moved(
    tiling: Tiling, x: FloatArray, sides: TriangleGeometry, step: FloatArray, slope: float
) -> tuple[FloatArray, float]:
    """Return the film after the longest part of a step (n_i, 3) that makes it smaller.

    And that part, 0 if there is none.
    """
    room = _shortest_sides(tiling, sides)[tiling.interior]
    farthest = float((np.linalg.norm(step, axis=1) / room).max())
    part = min(1.0, _FARTHEST / farthest)
    negligible = 1e-15 * float(sides.areas.sum())
    for _ in range(_HALVINGS):
        after = x.copy()
        after[tiling.interior] += part * step
        moved = tiling.sides(after)
        turned = (moved.normals * sides.normals).sum(axis=1)
        if (moved.areas > 0).all() and (turned > LIMITS.turned).all():
            gained = tiling.change(x, after)
            if gained <= 0.1 * part * slope or abs(part * slope) < negligible:
                return after, part
        part *= 0.5
    return x, 0.0


def _shortest_sides(tiling: Tiling, sides: TriangleGeometry) -> FloatArray:
    """Return the length (n_v,) of the shortest side at each vertex."""
    lengths = np.linalg.norm(sides.edges, axis=2)
    room = np.full(tiling.n_v, np.inf)
    for corner in range(3):
        # Side j lies opposite corner j.
        at_corner = np.minimum(lengths[:, corner - 1], lengths[:, corner - 2])
        np.minimum.at(room, tiling.triangles[:, corner], at_corner)
    return room
