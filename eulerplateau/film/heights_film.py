"""A soap film as a function of its loop, its vertices inside moving along normals only."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.film.condensation import Condensation
from eulerplateau.film.free_moves import is_rest
from eulerplateau.film.interior import FilmAtRest, LocalFilm
from eulerplateau.film.normal_moves import NormalHeights
from eulerplateau.film.tiling import TriangleGeometry

_STEPS = 30
# Part of the error that a step with an old factorised Hessian may leave; of films of few
# vertices inside less, since a new one costs them no more than a step or two.
_SLOW, _FEW, _SLOW_OF_FEW = 0.1, 512, 0.01
# Cosine of the tilt of normals up to which a film counts as being where its reference is.
_NO_TILT = 1 - 1e-10


@dataclass(frozen=True)
class HeightsFilm(LocalFilm):
    """A film whose vertices inside move along normals only."""

    variations: NormalHeights

    @property
    def is_free(self) -> bool:
        """Whether its vertices are free to move: they are not."""
        return False

    def is_central(self, sides: TriangleGeometry) -> bool:
        """Return whether the film's normals are those at which it was made."""
        return self.upright(sides, _NO_TILT)

    def stiffness(self, sides: TriangleGeometry) -> Condensation:
        """Return the factorised interior of a film."""
        return self.variations.stiffness(sides)

    def _settled(self, base: FloatArray, state: FilmAtRest) -> FilmAtRest:
        variations = self.variations
        inverse = self._known()
        slow = _SLOW_OF_FEW if variations.size <= _FEW else _SLOW
        error, fresh = np.inf, False
        for _ in range(_STEPS):
            force = variations.work(state.gradient)
            before, error = error, float(np.abs(force).max(initial=0.0))
            if is_rest(self.sides, error, before, fresh):
                return state
            fresh = inverse is None or error > slow * before
            if inverse is None or fresh:
                inverse = variations.stiffness(state.sides)
                self._inverse[:] = [inverse]
            state = self._descend(base, state, force, inverse)
        raise LinAlgError("the film does not come to rest")

    def _descend(
        self, base: FloatArray, state: FilmAtRest, force: FloatArray, inverse: Condensation
    ) -> FilmAtRest:
        """Return the film after one Newton step, shortened until the area falls."""
        step = -inverse.solve(force)
        slope = float(force @ step)
        for _ in range(20):
            after = self._at(base, state.u + step)
            small = abs(slope) < 1e-15 * state.area
            if after and (small or self.tiling.change(state.x, after.x) <= 0.1 * slope):
                return after
            step, slope = 0.5 * step, 0.5 * slope
        raise LinAlgError("no step makes the film smaller")
