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
# By which part of the diameter strands may overlap where the energy alone is asked.
LITTLE = 1e-7
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

        None if it does not fall as the step promised, or the energy is not good there.

        dearer : by how much more strands overlap at most after the step, to first order
        """
        gained = self._change(model, after)
        if gained is None:
            return None
        gained += self.price * (self._overlap(after) - self._overlap(model.x))
        noise = _noise(self.energy, model, after) + _ROUNDING * self.price
        promises = replace(step, promised=step.promised + self.price * dearer)
        return None if accepted(promises, gained, noise, radius) is None else gained

    def eased(
        self, model: TangentModel, step: NewtonStep, after: FloatArray, radius: float
    ) -> float | None:
        """Return by how much the energy changes, if strands hardly overlap after a step.

        None if it does not fall as the step promised, or they overlap by more.
        """
        gained, little = self._change(model, after), LITTLE * self.strands.diameter
        if gained is None or self._overlap(after) > little:
            return None
        noise = _noise(self.energy, model, after)
        return None if accepted(step, gained, noise, radius) is None else gained

    def _change(self, model: TangentModel, after: FloatArray) -> float | None:
        """Return the change of energy; None where that is not good."""
        gained = change_of_energy(self.energy, model.x, after)
        return gained if self.energy.holds(after) else None

    def _overlap(self, x: FloatArray) -> float:
        """Return by how much strands overlap at most on a loop (n, d), in units of L."""
        return max(0.0, -self.strands.smallest_gap(x, 0.0))


def _noise(energy: LoopEnergy, model: TangentModel, after: FloatArray) -> float:
    return noise_of(energy, model.x, after - model.x, model.tensions)
