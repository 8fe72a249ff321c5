"""Synthetic areas, and which intervals hold the truth."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.cell import AreaFit, cell_radius, fit_areas

# In nN/um and um. The paper gives sigma and alpha / R_0^3; the radius only sets the scale.
SIGMA, REST_RADIUS = 1.05, 25.0
ALPHA = 0.16 * REST_RADIUS**3
STIFFNESS = np.geomspace(0.1, 100.0, 10)
NOISE = 0.05 * pi * REST_RADIUS**2
TRUTH = {"sigma": SIGMA, "alpha": ALPHA, "rest_radius": REST_RADIUS}


@dataclass(frozen=True)
class Case:
    """What is known beforehand."""

    rest_radius_given: bool
    noise_known: bool

    @property
    def parameters(self) -> list[str]:
        """The names of what is fitted."""
        return list(TRUTH)[: 2 if self.rest_radius_given else 3]


CASES = [Case(given, known) for given in (True, False) for known in (True, False)]


@dataclass(frozen=True)
class Coverage:
    """The shares of sets whose interval of a parameter holds the truth, and is open."""

    case: Case
    parameter: str
    sets: int
    held: int
    open: int

    @property
    def share(self) -> float:
        """The coverage."""
        return self.held / self.sets

    @property
    def spread(self) -> float:
        """The binomial standard deviation of the coverage, were it as found."""
        return sqrt(self.share * (1 - self.share) / self.sets)


def coverage(case: Case, sets: int, seed: int) -> list[Coverage]:
    """Fit so many sets, the same ones for each case, and count."""
    fits = [fitted(case, noise) for noise in noises(sets, seed)]
    return [counted(case, name, fits) for name in case.parameters]


def noises(sets: int, seed: int) -> FloatArray:
    """Return the noise (sets, n) of the areas."""
    return NOISE * np.random.default_rng(seed).standard_normal((sets, len(STIFFNESS)))


def fitted(case: Case, noise: FloatArray) -> AreaFit:
    """Return the fit to the areas with this noise (n,)."""
    area = pi * cell_radius(STIFFNESS, SIGMA, ALPHA, REST_RADIUS) ** 2 + noise
    error = np.full(len(STIFFNESS), NOISE) if case.noise_known else None
    rest_radius = REST_RADIUS if case.rest_radius_given else None
    return fit_areas(STIFFNESS, area, error, rest_radius)


def counted(case: Case, name: str, fits: list[AreaFit]) -> Coverage:
    """Count the intervals of a parameter."""
    found = [getattr(fit, name) for fit in fits]
    held = sum(one.low <= TRUTH[name] <= one.high for one in found)
    loose = sum(one.low == 0 or one.high == np.inf for one in found)
    return Coverage(case, name, len(fits), held, loose)
