"""The energy of a rod that is curved by nature beside its bending, without a mesh.

    R = -2 k0 oint k_1 ds + k0^2 + (gamma/2) oint Omega^2 ds,   k0 = 2 pi q, gamma = 2 C/B,

in units of alpha / L; its frame is an unknown beside the loop (frames.py).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.conformal.frames import Frames
from eulerplateau.branches.conformal.terms import Unknowns
from eulerplateau.exact.conformal import Jet
from eulerplateau.loop import Term


@dataclass(frozen=True)
class SmoothRod(Term):
    """The energy R of loop and frame.

    Attributes
    ----------
    ratio : float, C / B
    rest_curvature : float, q
    """

    unknowns: Unknowns
    frames: Frames
    ratio: float
    rest_curvature: float

    @property
    def link(self) -> float:
        """Lk, in turns."""
        return self.frames.link

    def writhe(self, x: FloatArray) -> float:
        """Return Wr: the link less the twist, in turns."""
        return self.link - float(self._parts(x)[1].value.mean())

    def moment(self, x: FloatArray) -> float:
        """Return the twisting moment C Omega at phi = 0, where the rod was welded."""
        coefficients = self.unknowns.loop(x).coefficients
        chi = self.unknowns.others(x)
        return 2 * self.ratio * self.frames.twist_at_weld(coefficients, chi)

    def twist_energy(self, x: FloatArray) -> float:
        """Return the part of R that is due to twist."""
        _, twisted, speed = self._parts(x)
        return 2 * self.ratio * self._integral(_squared(twisted, speed).value)

    def energy(self, x: FloatArray) -> float:
        """Return R."""
        natural = 2 * math.pi * self.rest_curvature
        bent = self._integral(self._parts(x)[0].value)
        return natural**2 - 2 * natural * bent + self.twist_energy(x)

    def force(self, x: FloatArray) -> FloatArray:
        """Return the gradient (size, 1)."""
        return self._slope(self._density(x))

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return the second derivative (size, size)."""
        design, jet = self.frames.design, self._density(x)
        rows = design.reshape(-1, design.shape[2])
        inner = np.matmul(jet.curvature, design).reshape(rows.shape)
        weight, scale = self.unknowns.basis.weight, self.unknowns.scales
        curved: FloatArray = weight * scale[:, None] * (rows.T @ inner) * scale
        return curved

    def rate(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return the derivative of the force by "twist_ratio" or "rest_curvature"."""
        if parameter == "twist_ratio":
            _, twisted, speed = self._parts(x)
            return 2 * self._slope(_squared(twisted, speed))
        if parameter == "rest_curvature":
            return -4 * math.pi * self._slope(self._parts(x)[0])
        return None

    def _density(self, x: FloatArray) -> Jet:
        """Return dR/dphi, but for the constant."""
        bent, twisted, speed = self._parts(x)
        turned = _squared(twisted, speed).times(2 * self.ratio)
        return turned + bent.times(-4 * math.pi * self.rest_curvature)

    def _parts(self, x: FloatArray) -> tuple[Jet, Jet, Jet]:
        loop = self.unknowns.loop(x)
        return self.frames.bent_and_twisted(loop.curve, self.unknowns.others(x))

    def _integral(self, density: FloatArray) -> float:
        return self.unknowns.basis.weight * float(density.sum())

    def _slope(self, jet: Jet) -> FloatArray:
        slope = np.einsum("nk,nkt->t", jet.slope, self.frames.design)
        scaled: FloatArray = self.unknowns.basis.weight * self.unknowns.scales * slope
        return scaled[:, None]


def _squared(twisted: Jet, speed: Jet) -> Jet:
    """Return Omega^2 / 2 ds/dphi of Omega ds/dphi and ds/dphi."""
    return (twisted * twisted / speed).times(0.5)
