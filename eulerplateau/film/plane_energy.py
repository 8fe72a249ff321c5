"""The energy of a loop whose film is kept in its plane; positions are (n_b, 2)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film.plane import polygon_gradient
from eulerplateau.loop import Loop, SoapEnergy, stress_stiffness


@dataclass(frozen=True)
class PlaneEnergy(SoapEnergy):
    """E(x) = tr(x^T B x) + load * area of the polygon x (n_b, 2).

    Attributes
    ----------
    loop : rest lengths and bending
    load : sigma L^3 / alpha
    """

    loop: Loop
    load: float

    @cached_property
    def force_rounding(self) -> float:
        """What rounding alone leaves of a force, per unit of position."""
        eps = float(np.finfo(np.float64).eps)
        return eps * (float(np.abs(self.bending).sum(axis=1).max()) + self.load)

    def film_force(self, x: FloatArray) -> FloatArray:
        """Return the gradient of the film's energy (n_b, 2)."""
        return self.load * polygon_gradient(x)

    def lagrangian_hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        """Return the Hessian (2 n_b, 2 n_b) of E + lambda . c where J p = 0."""
        n = len(x)
        hessian = np.zeros((n, 2, n, 2))
        same = self.bending + stress_stiffness(self.loop, multipliers)
        hessian[:, 0, :, 0] = hessian[:, 1, :, 1] = same
        # d2A / dx_v dy_{v+1} = 1/2 = -d2A / dy_v dx_{v+1}.
        ahead = np.roll(np.eye(n), 1, axis=1)
        cross = 0.5 * self.load * (ahead - ahead.T)
        hessian[:, 0, :, 1], hessian[:, 1, :, 0] = cross, cross.T
        return hessian.reshape(2 * n, 2 * n)

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return E(x + step) - E(x): both terms are quadratic, so nothing cancels."""
        middle = x + 0.5 * step
        force = self.bending @ middle + self.load * polygon_gradient(middle)
        return float(np.sum(step * force))

    def holds(self, x: FloatArray) -> bool:
        """Return whether x is a loop the energy was made for: always."""
        return True
