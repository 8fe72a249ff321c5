"""The flat figure eight: two planar lobes whose film is pinched where the strands cross.

No disk of film lies flat in a crossed loop: its two lobes are covered with opposite
orientation, which no conformal map of one disk does. The flat eight is the limit in which
the twisted waist has no width: two films, one in each lobe, that meet in a point.
By symmetry a quarter of the loop says everything: from the crossing, where kappa = 0, to
the tip of a lobe.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import cos, pi, sin
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.exact.checks import finite
from eulerplateau.exact.planar import thresholds

# kappa'(0), the tangent's angle at the crossing and beta without a film: where Newton's
# method starts (to be converged), and the largest step in the load to the next start.
_ELASTICA = (65.3387, -0.71052, 112.4396)
_STEP = 500.0
_TOLERANCE = 1e-13
_MISFIT = 1e-10


@dataclass(frozen=True)
class FlatEight:
    """The flat eight at sigma_hat = load; lengths in L, energies in alpha/L.

    energy = load * area + oint kappa^2 ds, the area being that of both lobes. `slope` is
    dkappa/ds and `angle` the tangent's with the axis of the lobes (negative) where the
    loop enters the right lobe; 2 |angle| is the lobes' angle at the crossing.
    """

    load: float
    energy: float
    area: float
    beta: float
    slope: float
    angle: float

    def quarter(self, s: FloatArray) -> FloatArray:
        """Return kappa, dkappa/ds, tangent angle, x and y (5, n) at arc lengths s (n,).

        0 <= s <= 1/4, from the crossing at the origin, below the x axis, to the tip.
        """
        values: FloatArray = self._solution(s)[:5]
        return values

    @cached_property
    def _solution(self) -> Any:
        return _integrate(self.load, (self.slope, self.angle, self.beta), dense=True).sol


def flat_eight(load: float) -> FlatEight:
    """Return the flat eight; raises SpecError unless 0 <= load < 5127.71.

    There its crossing angle closes: the lobes are those of the planar film with two lobes
    at the onset of line contact.
    """
    most, load = thresholds(2).sigma_line_contact, finite("load", load)
    if not load < most:
        raise SpecError("load", f"found {load}; should be from 0 to below {most:.2f}")
    slope, angle, beta = _solve(load, _start(int(load // _STEP)))
    end = _integrate(load, (slope, angle, beta)).y[:, -1]
    bending, area = 4 * float(end[5]), 4 * float(end[6])
    return FlatEight(load, load * area + bending, area, beta, slope, angle)


@lru_cache(maxsize=64)
def _start(step: int) -> tuple[float, float, float]:
    """Return the solution at load step * _STEP, each from the one before."""
    guess = _ELASTICA if step == 0 else _start(step - 1)
    return _solve(step * _STEP, guess)


def _solve(load: float, guess: tuple[float, float, float]) -> tuple[float, float, float]:
    def misfit(unknowns: FloatArray) -> FloatArray:
        end = _integrate(load, tuple(unknowns)).y[:, -1]
        # At the tip: kappa stationary, tangent upright, on the axis.
        return np.array([end[1], end[2] - pi / 2, end[4]])

    found = root(misfit, guess, tol=_TOLERANCE)
    if np.abs(found.fun).max() > _MISFIT:
        raise ArithmeticError(f"no flat eight found at load {load}")
    slope, angle, beta = map(float, found.x)
    return slope, angle, beta


def _integrate(load: float, unknowns: tuple[float, ...], dense: bool = False) -> Any:
    """Integrate 2 kappa'' + kappa^3 - beta kappa - load = 0, bending and area along.

    Between its steps the solution is known only if it is `dense`.
    """
    slope, angle, beta = unknowns

    def rates(_: float, y: FloatArray) -> list[float]:
        # Python's own numbers are faster than NumPy's, one by one.
        kappa, dkappa, theta, x1, x2 = y[:5].tolist()
        cosine, sine = cos(theta), sin(theta)
        bend = (load + beta * kappa - kappa**3) / 2
        swept = (x1 * sine - x2 * cosine) / 2
        return [dkappa, bend, kappa, cosine, sine, kappa**2, swept]

    start = [0.0, slope, angle, 0.0, 0.0, 0.0, 0.0]
    return solve_ivp(
        rates, [0, 0.25], start, "DOP853", dense_output=dense, rtol=1e-12, atol=1e-13
    )
