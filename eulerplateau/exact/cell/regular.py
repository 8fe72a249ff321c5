"""Cells on regular adhesions, from the boundary-value problem: `regular_cell`.

Between two adhesions the cortex is an elastica under pressure whose length is free,

    2 kappa'' + kappa^3 - beta kappa - sigma = 0     (eq. euler-lagrange, alpha = 1),

with kappa continuous at an adhesion and 4 kappa' = 2 k_s Delta before it (the paper's eq.
discontinuity). It is solved in Ritz's form (side.py), where the equations and what belongs
at the ends follow from the energy, and where its second derivative is the stability.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from functools import cached_property

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve
from scipy.optimize import brentq

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.cell.side import HalfSide, Jet, circle
from eulerplateau.exact.cell.stability import Waves
from eulerplateau.exact.cell.tethered import free_energy, is_resolved
from eulerplateau.exact.checks import finite, whole_number

_ITERATIONS = 30
_COEFFICIENTS, _MOST_COEFFICIENTS = 16, 512
# Steps of log k_s from a weak substrate to the one that is asked for.
_FIRST_STEP, _LARGEST_STEP, _SMALLEST_STEP = 1.5, 3.0, 1e-3
# How well sides are resolved on the way: see is_resolved.
_ON_THE_WAY = 1e-6
# A load of adhesions, times radius^2, that hardly bends a circle.
_WEAK = 0.5


class CellStatus(StrEnum):
    """What a boundary-value solution came to."""

    CONVERGED = "converged"
    COLLAPSED = "collapsed"  # no smooth shape hangs together with the circle here


@dataclass(frozen=True, repr=False)
class RegularCell:
    """A cell on N regular adhesions; units alpha = R_0 = 1.

    Attributes
    ----------
    side : HalfSide
    sigma_hat, ks_hat, beta_hat : sigma R_0^3 / alpha, k_s R_0^3 / alpha, beta R_0^2 / alpha
    status : CONVERGED, or COLLAPSED with a side of no meaning and numbers that are NaN
    """

    side: HalfSide
    sigma_hat: float
    ks_hat: float
    beta_hat: float
    status: CellStatus

    def __repr__(self) -> str:
        """Return one line: the substrate, the cell's size, its traction."""
        return (
            f"<RegularCell on {self.side.adhesions} adhesions, sigma_hat "
            f"{self.sigma_hat:g}, ks_hat {self.ks_hat:g}: {self.status}, perimeter "
            f"{self.perimeter:.9g}, traction {self.traction:.9g}>"
        )

    @property
    def _sides(self) -> float:
        """Half sides of the cell; NaN where there is no cell."""
        return 2.0 * self.side.adhesions if self.status is CellStatus.CONVERGED else np.nan

    @property
    def perimeter(self) -> float:
        """The length of the edge."""
        return self._sides * self.side.h

    @property
    def area(self) -> float:
        """The area it covers."""
        return self._sides * self.side.area().value

    @property
    def bending_energy(self) -> float:
        """The integral of kappa^2."""
        return self._sides * self.side.bending().value

    @property
    def energy(self) -> float:
        """Bending, film, line tension and springs, in units of alpha / R_0."""
        return self._sides * self._jet.value

    @property
    def kappa_adhesion(self) -> float:
        """The curvature at the adhesions."""
        return self._finite(self.side.kappa_adhesion)

    @property
    def kappa_mid(self) -> float:
        """The curvature in the middle of a side: below zero it is inflected."""
        return self._finite(self.side.kappa_mid)

    @property
    def extension(self) -> float:
        """How far the substrate gives way at an adhesion, Delta, inwards positive."""
        return self._finite(1 - self.side.radius().value)

    @property
    def traction(self) -> float:
        """The force 2 k_s Delta of an adhesion on the substrate."""
        return 2 * self.ks_hat * self.extension

    @property
    def width(self) -> float:
        """Its extent along the axis through an adhesion."""
        angle = np.pi / self.side.adhesions
        along = self.outline(64) @ np.array([np.sin(angle), -np.cos(angle)])
        return self._finite(float(np.ptp(along)))

    @cached_property
    def n_unstable(self) -> int:
        """The Morse index: negative eigenvalues of the second variation."""
        return self.waves.n_unstable

    @property
    def symmetric_index(self) -> int:
        """Those of them within the cell's own symmetry."""
        return int(np.sum(np.linalg.eigvalsh(self._jet.curvature) < 0))

    @cached_property
    def waves(self) -> Waves:
        """The second variation against all displacements, wave by wave."""
        return Waves(self.side, self.sigma_hat, self.ks_hat, self.beta_hat)

    @cached_property
    def _jet(self) -> Jet:
        return cell_energy(self.side, self.sigma_hat, self.ks_hat, self.beta_hat)

    def _finite(self, value: float) -> float:
        return value if self.status is CellStatus.CONVERGED else np.nan

    def outline(self, points: int = 64) -> FloatArray:
        """Return the edge (N points, 2), counter-clockwise, evenly spaced side by side.

        The centre is the origin and the first point an adhesion; see also `adhesions`.
        """
        one = self.side.points(np.linspace(-1, 1, points + 1)[:-1])
        turned = one[:, 0] + 1j * one[:, 1]
        n = self.side.adhesions
        turns = np.exp(2j * np.pi * np.arange(n) / n)
        whole = (turns[:, None] * turned).ravel()
        outline: FloatArray = np.stack([whole.real, whole.imag], axis=-1)
        return outline

    def adhesions(self) -> FloatArray:
        """Return the adhesions' places (N, 2) on the substrate at rest, same axes."""
        n = self.side.adhesions
        places = np.exp(2j * np.pi * (np.arange(n) - 0.5) / n - 0.5j * np.pi)
        return np.stack([places.real, places.imag], axis=-1)


def cell_energy(side: HalfSide, sigma: float, stiffness: float, beta: float) -> Jet:
    """Return half a side's share of the energy, and its derivatives by z."""
    return free_energy(side, sigma, beta).plus(side.springs(stiffness))


def regular_cell(
    adhesions: int, sigma_hat: float, ks_hat: float, beta_hat: float = 0.0
) -> RegularCell:
    """Return the smooth cell that hangs together with the circle.

    It is stable within its own symmetry; n_unstable tells about all displacements.

    The substrate is made stiffer step by step, from one so weak that the cell is a circle.
    A cell that finds no shape next to the last one on the way is COLLAPSED: it has passed
    the fold of smooth shapes (transitions.py).

    Parameters
    ----------
    adhesions : int, N_A >= 2, at the corners of a regular polygon of circumradius R_0
    sigma_hat, beta_hat : float, >= 0
    ks_hat : float, > 0

    Raises
    ------
    SpecError : for a wrong argument
    """
    n = whole_number("adhesions", adhesions, 2)
    sigma, beta = finite("sigma_hat", sigma_hat), finite("beta_hat", beta_hat)
    stiffness = finite("ks_hat", ks_hat)
    if stiffness == 0.0:
        raise SpecError("ks_hat", "found 0; should be above 0: nothing holds the cell")
    side, k = _weak_start(n, sigma, stiffness, beta)
    found = settled(side, sigma, k, beta, _ON_THE_WAY)
    step = _FIRST_STEP
    while found is not None and k < stiffness:
        after = min(k * np.exp(step), stiffness)
        guess = _predicted(found, sigma, k, beta, after)
        trial = settled(guess, sigma, after, beta, _ON_THE_WAY)
        if trial is None:
            step *= 0.5
            if step < _SMALLEST_STEP:
                found = None
            continue
        found, k, step = trial, after, min(1.5 * step, _LARGEST_STEP)
    found = None if found is None else settled(found, sigma, stiffness, beta)
    status = CellStatus.COLLAPSED if found is None else CellStatus.CONVERGED
    return RegularCell(found or side, sigma, stiffness, beta, status)


def _weak_start(
    n: int, sigma: float, stiffness: float, beta: float
) -> tuple[HalfSide, float]:
    """Return a circle and a stiffness, at most the given one, that hardly deforms it."""
    k = stiffness
    if sigma or beta:
        radius = _circle_radius(n, sigma, 0.0, beta)
        gap = abs(1 - radius) * radius**2
        k = min(stiffness, 0.5 * _WEAK / gap) if gap else stiffness
    return circle(n, _circle_radius(n, sigma, k, beta), _COEFFICIENTS), k


def _circle_radius(n: int, sigma: float, k: float, beta: float) -> float:
    """Return the radius at which a circle on n springs is in balance."""

    def push(log_radius: float) -> float:
        r = np.exp(log_radius)
        return float(
            2 * np.pi * (sigma * r**3 + beta * r**2 - 1) + 2 * n * k * (r - 1) * r**2
        )

    return float(np.exp(brentq(push, -60.0, 60.0, xtol=1e-14)))


def settled(
    side: HalfSide, sigma: float, stiffness: float, beta: float, smallest: float = 1e-13
) -> HalfSide | None:
    """Return the stable side next to a given one by Newton's method; None without one.

    It has as many coefficients as make the last ones no larger than `smallest`.
    """
    last = np.inf
    for _ in range(_ITERATIONS):
        energy = cell_energy(side, sigma, stiffness, beta)
        try:
            step = cho_solve(cho_factor(energy.curvature), energy.slope)
        except (LinAlgError, ValueError):
            return None
        size = float(np.abs(step).max())
        if not np.isfinite(size) or size > 1.0 + side.h or step[-1] >= side.h:
            return None
        side = HalfSide(side.adhesions, side.z - step)
        if size < 1e-15 or (size < 1e-9 and size > 0.3 * last):
            n = len(side.z) - 1
            if is_resolved(side, smallest) or 2 * n > _MOST_COEFFICIENTS:
                return side
            return settled(side.refined(2 * n), sigma, stiffness, beta, smallest)
        last = size
    return None


def _predicted(
    side: HalfSide, sigma: float, stiffness: float, beta: float, after: float
) -> HalfSide:
    """Return the side on a stiffer substrate, to first order in log k_s."""
    energy = cell_energy(side, sigma, stiffness, beta)
    radius = side.radius()
    pull = -(1 - radius.value) * radius.slope * stiffness
    step = np.linalg.solve(energy.curvature, pull) * np.log(after / stiffness)
    z = side.z - step
    return HalfSide(side.adhesions, z) if 0.5 * side.h < z[-1] < 2 * side.h else side
