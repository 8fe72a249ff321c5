"""What is said of a film without a mesh, with the rod that bounds it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

from eulerplateau.exact.conformal import ConformalFilm


@dataclass(frozen=True)
class WithRod:
    """A film of true area with the rod that bounds it; lengths in L, energies in alpha / L.

    Attributes
    ----------
    film : its loop, whose energy is that of film and bending
    energy : film, bending and twist together
    n_unstable : the Morse index
    """

    film: ConformalFilm
    twist_ratio: float
    link: float
    energy: float
    twist_energy: float
    writhe: float
    twist_moment: float
    n_unstable: int

    def parts(self) -> dict[str, float | int | str]:
        """Return the energy with its parts, and how the rod is turned, by names."""
        return {
            "energy": self.energy,
            "area": self.film.area,
            "bending": self.film.bending,
            "twist_energy": self.twist_energy,
            "writhe": self.writhe,
            "twist_moment": self.twist_moment,
        }

    def mirrored(self) -> Self:
        """Return the mirror image in the plane z = 0, of a rod turned the other way."""
        coefficients = self.film.coefficients.copy()
        coefficients[self.film.basis.slices[2]] *= -1
        return replace(
            self,
            film=replace(self.film, coefficients=coefficients),
            link=-self.link,
            writhe=-self.writhe,
            twist_moment=-self.twist_moment,
        )
