"""The steps that may be taken from a loop whose strands touch, by a quadratic program."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Gaps, LoopEnergy, Strands, with_gaps_held
from eulerplateau.solvers.contact.program import CLOSED, Program
from eulerplateau.solvers.second_variation import NewtonStep, TangentModel, loosened


@dataclass(frozen=True)
class Steps:
    """Steps from where gaps are closed; `near` what may be: these, others behind them.

    `model` keeps them; `energy` knows no contact.
    """

    energy: LoopEnergy
    strands: Strands
    model: TangentModel
    gaps: Gaps
    near: Gaps

    def overlaps(self, moved: FloatArray, little: float = CLOSED) -> bool:
        """Return whether a step (n, d) makes others overlap by more, to first order."""
        widths = self._widths + self._rows @ moved.ravel()
        others = np.arange(len(widths)) >= len(self.gaps)
        return bool((widths[others] < -little).any())

    def dearer(self, step: NewtonStep) -> float:
        """Return by how much more strands overlap at most after it, to first order."""
        after = self._widths + self._rows @ step.moved.ravel()
        return float(self._widths.min(initial=0.0) - after.min(initial=0.0))

    def programmed(self, radius: float) -> tuple[NewtonStep, Gaps] | None:
        """Return the program's step of at most such a radius, and what it closes."""
        found = self._program.step(radius)
        if found is None:
            return None
        coefficients, closed = found
        return self._loose.step(coefficients), self.near[closed]

    @cached_property
    def _widths(self) -> FloatArray:
        return self.strands.at(self.model.x, self.near)[1]

    @cached_property
    def _rows(self) -> FloatArray:
        return self.strands.between(self.model.x, self.near).jacobian()

    @cached_property
    def _loose(self) -> TangentModel:
        """The model that keeps lengths only."""
        held = with_gaps_held(self.energy, self.strands, self.gaps)
        return loosened(self.energy, held, self.model)

    @cached_property
    def _program(self) -> Program:
        loose, closed = self._loose, np.arange(len(self.near)) < len(self.gaps)
        rows = loose.coordinates.slope(self._rows.T).T
        return Program(loose.gradient, loose.hessian, self._widths, rows, closed)
