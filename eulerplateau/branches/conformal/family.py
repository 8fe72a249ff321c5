"""Soap films without a mesh as families of energies, for continuation (continuation.py)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.branches.conformal.rod_term import SmoothRod
from eulerplateau.branches.conformal.terms import (
    SmoothBending,
    SmoothFilm,
    SmoothTwist,
    Unknowns,
    WholeLength,
)
from eulerplateau.branches.point import BranchPoint
from eulerplateau.exact.conformal import (
    GENERAL,
    Basis,
    ConformalFilm,
    bending_energy,
    gauge_modes,
    make_basis,
)
from eulerplateau.loop import LoopEnergy, Term
from eulerplateau.solvers import Stability, stability, tangent_model


@dataclass(frozen=True)
class SmoothFamily:
    """Films of true area bounded by a rod, that differ in one parameter.

    Attributes
    ----------
    basis : of the loops, which have its symmetry
    values : of "load", of "twist_ratio", with which at 0 twist costs nothing, and "link"
    parameter : which of them is varied
    """

    basis: Basis
    values: Mapping[str, float]
    parameter: str = "load"

    @cached_property
    def unknowns(self) -> Unknowns:
        """What stands for a loop."""
        return Unknowns.of(self.basis, np.zeros(0))

    def energy(self, value: float) -> LoopEnergy:
        """Return the energy at a value of the parameter."""
        terms: dict[str, Term] = {
            "bending": SmoothBending(self.unknowns),
            "film": SmoothFilm(self.unknowns, self._values(value)["load"]),
            "twist": self.twist(value),
        }
        return LoopEnergy(
            terms=terms,
            constraint=WholeLength(self.unknowns),
            weights=self.unknowns.weights,
            free_motions=self._free_motions,
        )

    def twist(self, value: float) -> SmoothTwist | SmoothRod:
        """Return what the rod's energy has beside its bending at a value."""
        values = self._values(value)
        return SmoothTwist(self.unknowns, values["twist_ratio"], values["link"])

    def with_value(self, parameter: str, value: float) -> SmoothFamily:
        """Return the family at another value of a parameter that it does not vary."""
        return replace(self, values={**self.values, parameter: value})

    def positions(self, x: FloatArray) -> FloatArray:
        """Return the loop (n, 3) at the points of the grid."""
        return self.unknowns.loop(x).curve.x

    def film(self, point: BranchPoint) -> ConformalFilm:
        """Return the film of a point of a branch."""
        loop = self.unknowns.loop(point.x)
        c, load = loop.coefficients, self._values(point.value)["load"]
        area = float(0.5 * c @ self.basis.dirichlet @ c)
        bending = bending_energy(loop.curve)
        return ConformalFilm(
            basis=self.basis,
            coefficients=c,
            beta=float(point.model.tensions[0]),
            load=load,
            energy=bending + load * area,
            area=area,
            bending=bending,
            residual=point.model.residual,
            corrections=0,
        )

    def near(self, x: FloatArray) -> SmoothFamily:
        """Return itself: harmonics are good near every loop."""
        return self

    def released(self, x: FloatArray) -> SmoothFamily:
        """Return itself: the film is a minimal surface."""
        return self

    def kept(self, x: FloatArray) -> Mapping[str, NDArray[Any]]:
        """Return nothing: the family knows all of itself."""
        return {}

    def restored(self, kept: Mapping[str, NDArray[Any]]) -> SmoothFamily:
        """Return itself."""
        return self

    def in_space(self, point: BranchPoint) -> Stability:
        """Return the spectrum among all loops, not those of the basis's symmetry alone."""
        basis = make_basis(self.basis.harmonics, GENERAL, self.basis.crowding)
        family = replace(self, basis=basis)
        energy = family.energy(point.value)
        return stability(tangent_model(energy, family.carried(self, point.x)))

    def tail(self, x: FloatArray) -> float:
        """Return the relative error of truncation in the loop's tangent, roughly."""
        return self.basis.tail(self.unknowns.loop(x).coefficients)

    def carried(self, other: SmoothFamily, x: FloatArray) -> FloatArray:
        """Return what stands here for a film of another family, of the same grid."""
        coefficients = other.unknowns.loop(x).coefficients
        return self.unknowns.x(self.basis.embed(other.basis, coefficients))

    def transferred(self, other: SmoothFamily, x: FloatArray) -> FloatArray:
        """Return what stands here for a film of another family, theta kept."""
        coefficients = other.unknowns.loop(x).coefficients
        return self.unknowns.x(self.basis.transfer(other.basis, coefficients))

    def _values(self, value: float) -> Mapping[str, float]:
        return {**self.values, self.parameter: value}

    def _free_motions(self, x: FloatArray) -> FloatArray:
        u = self.unknowns
        return gauge_modes(u.basis, u.loop(x).curve) / u.scale[:, None]


def smooth_family(point: BranchPoint) -> SmoothFamily:
    """Return the family of a point of a branch of films without a mesh."""
    return cast(SmoothFamily, point.family)
