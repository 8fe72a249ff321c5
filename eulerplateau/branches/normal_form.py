"""How an energy goes on along modes that are lost: its third and fourth derivatives.

Displacements are projected onto the constraint without a motion along the tangent space,
so that differences of the Hessian between loops x(+-z phi) are
derivatives of the energy by the tangent coordinates (exact for the third, and for the
fourth along phi, where g = 0 and H phi = 0). With the other coordinates eliminated the
slope along phi is

    V'(z) = a_2 z^2 + a_3 z^3 + ...,     a_2 = T.phi / 2,
    a_3 = D4[phi, phi, phi, phi] / 6 - T.w / 2,     T = D3[phi, phi, .],  H w = T, w.phi = 0

(Golubitsky and Schaeffer 1985; Govaerts 2000). Differences are extrapolated
from two steps: most of the fourth is taken back by what yields.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers import TangentModel, directional

# Displacement, r.m.s. in L, between which differences are taken.
_STEP = 5e-4
# Projections that leave next to nothing of what they move along the tangent space.
_PROJECTIONS = 2
# |b.phi| / |b| below which b has no part along phi. Symmetric points reach 1e-8; folds on
# these films have 0.1 and more.
NO_PART = 1e-3
# Part of the film's pull, or of all forces at the parameter's unit, below which what moves
# the loop is rounding: a true film does not move a round one at all, nor does its twist.
_IDLE = 1e-6


@dataclass(frozen=True)
class Neighbourhood:
    """Loops along modes that are lost, next to an equilibrium.

    Attributes
    ----------
    model : at the equilibrium
    modes : (m, k) float, orthonormal null vectors of its Hessian
    parameters : names of parameters by which derivatives are asked for
    """

    energy: LoopEnergy
    model: TangentModel
    modes: FloatArray
    parameters: tuple[str, ...] = ()
    _known: dict[tuple[int, float], FloatArray] = field(default_factory=dict, repr=False)

    def steepness(self) -> FloatArray:
        """Return the mean over the modes of D3[phi, phi, .] (m,).

        The derivative of the mean of phi^T H phi: which way a curve goes on. Of the first
        mode, whose coefficient asks for that anyway, to the step's fourth order.
        """
        others = range(1, self.modes.shape[1])
        changes = [_extrapolated(self._third), *(self._third(n, _STEP) for n in others)]
        mean: FloatArray = np.mean(changes, axis=0)
        return mean

    def quadratic(self) -> float:
        """Return a_2 of the first mode."""
        return 0.5 * float(_extrapolated(self._third) @ self.modes[:, 0])

    def cubic(self) -> float:
        """Return a_3 of the first mode: positive where a pitchfork is supercritical."""
        third = _extrapolated(self._third)
        force, still = third[:, None], np.zeros((self.modes.shape[1], 1))
        yielding, _ = bordered(self.model.hessian, self.modes, force, still)
        fourth = _extrapolated(self._fourth)
        return float(fourth[0]) / 6 - 0.5 * float(third @ yielding[:, 0])

    def mixed(self, parameter: str) -> float:
        """Return phi^T (dH / dparameter) phi, the mean over the modes."""
        which = 1 + self.parameters.index(parameter)
        changes = []
        for number, mode in enumerate(self.modes.T):
            ahead, behind = (self._beside(number, s)[:, which] for s in (_STEP, -_STEP))
            changes.append(float((ahead - behind) @ mode) / (2 * _STEP))
        return float(np.mean(changes))

    def _third(self, number: int, step: float) -> FloatArray:
        """Return D3 (m,) along a mode, good to the step's second order."""
        return (self._pull(number, step) - self._pull(number, -step)) / (2 * step)

    def _pull(self, number: int, step: float) -> FloatArray:
        """Return H phi (m,) at a loop along a mode, in the coordinates here."""
        return self._beside(number, step)[:, 0]

    def _beside(self, number: int, step: float) -> FloatArray:
        """Return H phi and dg/dparameter of each, as columns, at a loop along a mode.

        In the coordinates here. All at once, as a film knows the last loops only. Raises
        LinAlgError if there is no such loop.
        """
        if (number, step) not in self._known:
            mode, energy = self.modes[:, number], self.energy
            there = directional(energy, self._moved(step * mode))
            rates = (energy.rate(name, there.x) for name in self.parameters)
            forces = [there.pull(self.model.displacement(mode)), *map(there.left, rates)]
            columns = np.stack([force.ravel() for force in forces], axis=1)
            self._known[number, step] = self.model.coordinates.slope(columns)
        return self._known[number, step]

    def _moved(self, coefficients: FloatArray) -> FloatArray:
        """Return the loop (n, d) that keeps the constraint and has these coordinates (m,).

        A projection may go along the tangent space, by the square of the displacement.
        """
        x = self.model.x
        for _ in range(_PROJECTIONS):
            missing = coefficients - self.model.coefficients(x - self.model.x)
            kept = self.energy.constraint.project(x + self.model.displacement(missing))
            if kept is None:
                raise LinAlgError("no loop along the mode keeps its length")
            x = kept
        return x

    def _fourth(self, number: int, step: float) -> FloatArray:
        """Return D4 (1,) along a mode, good to the step's second order."""
        mode = self.modes[:, number]
        beside = self._pull(number, step) + self._pull(number, -step)
        changed = beside - 2 * self.model.hessian @ mode
        return np.array([float(mode @ changed) / step**2])


def _extrapolated(difference: Callable[[int, float], FloatArray]) -> FloatArray:
    """Return a difference along the first mode, good to the step's fourth order."""
    fine, coarse = difference(0, _STEP), difference(0, 2 * _STEP)
    better: FloatArray = (4 * fine - coarse) / 3
    return better


def bordered(
    hessian: FloatArray, border: FloatArray, force: FloatArray, amount: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return w (m, j) and mu (k, j): H w + B mu = force, B^T w = amount, for B (m, k)."""
    m, k = border.shape
    matrix = np.block([[hessian, border], [border.T, np.zeros((k, k))]])
    found = np.linalg.solve(matrix, np.vstack([force, amount]))
    return found[:m], found[m:]


def part_along(
    energy: LoopEnergy, model: TangentModel, mode: FloatArray, parameter: str, unit: float
) -> float:
    """Return the part that the pull of a parameter has along a null vector (m,), 0 to 1.

    Parameters
    ----------
    model : of the energy, at an equilibrium
    parameter : that of the branch, or another one of the energy's
    unit : float, a change of it that counts, as a StepControl's
    """
    pull = energy.pull(parameter, model.x, model.tensions)
    slope = model.slope(pull)
    held = energy.constraint.force(model.x, model.tensions)
    forces = [force / unit for force in (*energy.forces(model.x), held)]
    sizes = [float(np.linalg.norm(f.ravel() / model.scale)) for f in (pull, *forces)]
    size = max(float(np.linalg.norm(slope)), _IDLE * max(sizes))
    return abs(float(slope @ mode)) / size
