"""What may not rise where strands are kept apart everywhere: an exact penalty function.

    P(x) = E(x) + price max(0, d - D(x)),     D(x) the least distance of strands

is least at the constrained minimum if the price of overlap, a force, is larger than all
forces of the contacts together: the largest violation of infinitely many inequalities is
dual to the whole measure of their forces (Han 1977; for infinitely many Coope and Watson
1985; Hettich and Kortanek 1993, section 7). A quadratic program's step then leads downhill.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import LoopEnergy, Strands
from eulerplateau.solvers.acceptance import accepted, change_of_energy, noise_of
from eulerplateau.solvers.second_variation import NewtonStep, TangentModel

# How much larger than all forces together the price is where it is set.
_DEARER = 2.0
# What rounding leaves of a gap, in units of L.
_ROUNDING = 1e-14


@dataclass(frozen=True)
class Merit:
    """The merit function P of loops; its price, alpha / L^2, only rises."""

    energy: LoopEnergy
    strands: Strands
    price: float = 0.0

    def above(self, forces: FloatArray) -> Merit:
        """Return the merit function whose price is larger than these forces (k,)."""
        together = max(0.0, float(forces.sum()))
        if self.price > together:
            return self
        return replace(self, price=_DEARER * together)

    def gained(
        self, model: TangentModel, step: NewtonStep, after: FloatArray, radius: float
    ) -> float | None:
        """Return by how much P changes from a model's loop to one that a step has led to.

        None if it does not fall as the step promised, or the energy is not good there.

        step : what it promises is the change of P, to first order in the gaps it looks at
        """
        gained = self._change(model.x, after)
        if gained is None or not self.energy.holds(after):
            return None
        noise = noise_of(self.energy, model.x, after - model.x, model.tensions)
        noise += _ROUNDING * self.price
        return None if accepted(step, gained, noise, radius) is None else gained

    def _change(self, x: FloatArray, after: FloatArray) -> float | None:
        """Return P at another loop less that at x; None where there is no film on it."""
        gained = change_of_energy(self.energy, x, after)
        return None if gained is None else gained + self._cost(after) - self._cost(x)

    def _cost(self, x: FloatArray) -> float:
        """Return what the overlap of strands on a loop (n, d) costs, in alpha / L."""
        return self.price * max(0.0, -self.strands.smallest_gap(x, 0.0))
