"""A curved film as a function of its loop, its vertices free to move inside."""

from __future__ import annotations

from dataclasses import dataclass

from eulerplateau.arrays import FloatArray
from eulerplateau.film.condensation import Condensation
from eulerplateau.film.free_moves import STILL, FreeInterior, at_rest
from eulerplateau.film.interior import FilmAtRest, LocalFilm
from eulerplateau.film.tiling import TriangleGeometry


@dataclass(frozen=True)
class FreeFilm(LocalFilm):
    """A film whose vertices inside are free: a discrete minimal surface."""

    variations: FreeInterior

    @property
    def is_free(self) -> bool:
        """Whether its vertices are free to move: they are."""
        return True

    def is_central(self, sides: TriangleGeometry) -> bool:
        """Return whether the film is where it was made: it is as good anywhere."""
        return True

    def stiffness(self, sides: TriangleGeometry) -> Condensation:
        """Return the factorised interior of a film."""
        return self.variations.stiffened(sides, STILL)[0]

    def _settled(self, base: FloatArray, state: FilmAtRest) -> FilmAtRest:
        x = at_rest(self.variations, state.x)
        sides, u = self.tiling.sides(x), (x - base)[self.tiling.interior].ravel()
        return FilmAtRest(self.alone, x, u, sides, self.tiling.gradient(sides))
