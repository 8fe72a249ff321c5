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
from eulerplateau.solvers.contact.program import CLOSED
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
        self,
        model: TangentModel,
        step: NewtonStep,
        dearer: float,
        after: FloatArray,
        radius: float,
    ) -> float | None:
        """Return by how much P changes from a model's loop to one that a step has led to.

        Where no strands overlap by more than what is closed: by how much the energy does, if
        that falls as the step promised. None if neither does, or the energy is not good
        there.

        dearer : by how much more strands overlap at most after the step, to first order
        """
        gained = change_of_energy(self.energy, model.x, after)
        if gained is None or not self.energy.holds(after):
            return None
        noise = noise_of(self.energy, model.x, after - model.x, model.tensions)
        overlap = self._overlap(after)
        if overlap <= CLOSED and accepted(step, gained, noise, radius) is not None:
            return gained
        promises = replace(step, promised=step.promised + self.price * dearer)
        gained += self.price * (overlap - self._overlap(model.x))
        noise += _ROUNDING * self.price
        return None if accepted(promises, gained, noise, radius) is None else gained

    def _overlap(self, x: FloatArray) -> float:
        """Return by how much strands overlap at most on a loop (n, d), in units of L."""
        return max(0.0, -self.strands.smallest_gap(x, 0.0))
