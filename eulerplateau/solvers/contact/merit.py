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
from eulerplateau.solvers.contact.steps import Steps
from eulerplateau.solvers.descent import accepted, change_of_energy, noise_of
from eulerplateau.solvers.second_variation import NewtonStep

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
        self, steps: Steps, step: NewtonStep, after: FloatArray, radius: float
    ) -> float | None:
        """Return by how much P changes from a state to a loop that a step has led to.

        None if it does not fall as the step promised, to first order in the gaps it has
        looked at; or if the energy is not good there.
        """
        x, tensions = steps.state.model.x, steps.state.model.tensions
        gained = self._change(x, after)
        if gained is None or not self.energy.holds(after):
            return None
        noise = noise_of(self.energy, x, after - x, tensions) + _ROUNDING * self.price
        dearer = steps.overlap(step.moved) - steps.overlap(0.0 * step.moved)
        promise = replace(step, promised=step.promised + self.price * dearer)
        return None if accepted(promise, gained, noise, radius) is None else gained

    def _change(self, x: FloatArray, after: FloatArray) -> float | None:
        """Return P at another loop less that at x; None where there is no film on it."""
        gained = change_of_energy(self.energy, x, after)
        return None if gained is None else gained + self._cost(after) - self._cost(x)

    def _cost(self, x: FloatArray) -> float:
        """Return what the overlap of strands on a loop (n, d) costs, in alpha / L."""
        return self.price * max(0.0, -self.strands.smallest_gap(x, 0.0))
