"""A loop of line in a soap film as it stands at a bench, in units of the SI: its load.

A round line of Young's modulus E and diameter d resists bending with B = EI, I = pi d^4/64;
bending energy is alpha kappa^2 per length, so that B = 2 alpha. A soap film has two faces:
its tension is sigma = 2 gamma, gamma being the surface tension of the liquid. The load of a
loop of length L is sigma_hat = sigma L^3 / alpha = 4 gamma L^3 / B.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cbrt, inf, pi

from eulerplateau.errors import SpecError


def bending_rigidity(young: float, diameter: float) -> float:
    """Return EI (N m^2) of a round line of Young's modulus (Pa) and diameter (m)."""
    square = diameter * diameter
    return young * pi * square * square / 64


def isotropic_twist_ratio(poisson: float) -> float:
    """Return C / B of a round line of an isotropic material, by its Poisson's ratio."""
    return 1 / (1 + poisson)


@dataclass(frozen=True)
class Bench:
    """A loop in a film, in units of the SI.

    Attributes
    ----------
    rigidity : float, B = EI in N m^2
    length : float, L in m
    surface_tension : float, gamma of the liquid in N/m
    """

    rigidity: float
    length: float
    surface_tension: float

    def __post_init__(self) -> None:
        """Raise SpecError where the load is no number that a double holds."""
        positive = 0 < self.rigidity < inf and 0 < self.tension < inf
        if not (positive and 0 < self.load < inf):
            problem = "overflows or vanishes: check the units of rod, length and film"
            raise SpecError("sigma_hat", problem)

    @property
    def alpha(self) -> float:
        """The bending modulus, B / 2."""
        return self.rigidity / 2

    @property
    def tension(self) -> float:
        """That of the film, sigma = 2 gamma."""
        return 2 * self.surface_tension

    @property
    def load(self) -> float:
        """sigma_hat = sigma L^3 / alpha."""
        ratio = self.length / self.elastocapillary_length
        return 2 * ratio * ratio * ratio

    @property
    def elastocapillary_length(self) -> float:
        """(EI / sigma)^(1/3) in m; the load is twice the cube of L over it."""
        return cbrt(self.rigidity / self.tension)

    def length_at(self, load: float) -> float:
        """Return the length (m) at which a loop of this line has a load."""
        return self.elastocapillary_length * cbrt(load / 2)

    def width(self, diameter: float) -> float:
        """Return a diameter (m) in units of (alpha / sigma)^(1/3)."""
        return cbrt(2) * diameter / self.elastocapillary_length

    def surface_tension_at(self, load: float) -> float:
        """Return the surface tension (N/m) at which this loop has a load."""
        return self.rigidity / self.length * load / 4 / self.length / self.length
