"""The condensed energy of a true soap film: bending plus the area of the film at rest."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.film.interior import Chart
from eulerplateau.loop import Loop, SoapEnergy, stress_stiffness


@dataclass(frozen=True)
class AreaEnergy(SoapEnergy):
    """E(x_b) = tr(x_b^T B x_b) + load A(x_b), A the least area in a chart (chart.py).

    The film's Hessian is a full (3 n_b, 3 n_b) matrix that changes with the loop, unlike
    that of a film of fixed weights (tangent.LoopEnergy).

    Attributes
    ----------
    loop : rest lengths and bending
    chart : where the film's interior is sought
    load : sigma L^3 / alpha
    """

    loop: Loop
    chart: Chart
    load: float

    @cached_property
    def force_rounding(self) -> float:
        """What rounding alone leaves of a force, per unit of position.

        A film of tension 1 pulls with the sum of half the sides across a vertex.
        """
        eps = float(np.finfo(np.float64).eps)
        return eps * (float(np.abs(self.bending).sum(axis=1).max()) + 8 * self.load)

    def film_force(self, x: FloatArray) -> FloatArray:
        """Return the gradient of the film's energy (n_b, 3)."""
        return self.load * self.chart.relax(x).force

    def lagrangian_hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        """Return the Hessian (3 n_b, 3 n_b) of E + lambda . c where J p = 0."""
        same = self.bending + stress_stiffness(self.loop, multipliers)
        hessian = self.load * self.chart.relax(x).hessian
        n = len(x)
        blocks = hessian.reshape(n, 3, n, 3)
        for d in range(3):
            blocks[:, d, :, d] += same
        return hessian

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return E(x + step) - E(x) with the relative precision of the difference."""
        before, after = self.chart.relax(x), self.chart.relax(x + step)
        bending = float(np.sum(step * (self.bending @ (x + 0.5 * step))))
        return bending + self.load * self.chart.film.change(before.x, after.x)

    def holds(self, x: FloatArray) -> bool:
        """Return whether the film is still close enough to its chart."""
        return self.chart.holds(self.chart.relax(x).sides)

    def at_centre(self, x: FloatArray) -> bool:
        """Return whether the film is where its chart was made."""
        return self.chart.relax(x).central
