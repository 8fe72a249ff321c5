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
    SmoothLoop,
    SmoothTwist,
    Unknowns,
    WholeLength,
)
from eulerplateau.branches.family import UnboundedFamily
from eulerplateau.branches.point import BranchPoint
from eulerplateau.exact.conformal import (
    GENERAL,
    HALF_TURNS,
    TWISTED,
    Basis,
    ConformalFilm,
    Family,
    bending_energy,
    gauge_modes,
    make_basis,
)
from eulerplateau.loop import LoopEnergy, Term
from eulerplateau.solvers import (
    Columns,
    Stability,
    TangentModel,
    spectrum_of,
    stability,
    tangent_model,
)


@dataclass(frozen=True)
class SmoothFamily(UnboundedFamily):
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

    def rests(self, model: TangentModel, value: float) -> bool:
        """Return True."""
        return True

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
        """Return the spectrum among all loops, not those of the basis's symmetry alone.

        Of a loop with all half-turns the second variation mixes no displacements that keep
        different ones of them.
        """
        others = HALF_TURNS[1:] if self.basis.family is TWISTED else ()
        values = [point.model.eigenvalues]
        values += [self._beside(family, point) for family in others]
        return spectrum_of(np.sort(np.concatenate(values)))

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

    def at_once(self, point: BranchPoint) -> Stability:
        """Return the spectrum among all loops by one matrix, whatever the energy is."""
        basis = self.basis.like(self.basis.harmonics, GENERAL, self.basis.crowding)
        family = replace(self, basis=basis)
        energy = family.energy(point.value)
        return stability(tangent_model(energy, family.carried(self, point.x)))

    def _beside(self, symmetry: Family, point: BranchPoint) -> FloatArray:
        """Return the eigenvalues of displacements of another symmetry than the loop's.

        They keep its length to first order, each of them.
        """
        basis = make_basis(self.basis.harmonics, symmetry, self.basis.crowding)
        loop = self.unknowns.loop(point.x)
        family = _Beside(basis, self.values, self.parameter, loop=loop)
        energy, still = family.energy(point.value), np.zeros((basis.size, 1))
        free, scale = energy.free_motions(still), np.sqrt(energy.weights)
        moves = np.linalg.qr(free * scale[:, None], mode="complete")[0][:, free.shape[1] :]
        coordinates = Columns(moves, scale)
        hessian = coordinates.hessian(energy, still, point.model.tensions)
        return np.linalg.eigvalsh(hessian).astype(np.float64, copy=False)

    def _values(self, value: float) -> Mapping[str, float]:
        return {**self.values, self.parameter: value}

    def _free_motions(self, x: FloatArray) -> FloatArray:
        u = self.unknowns
        return gauge_modes(u.basis, u.loop(x).curve) / u.scale[:, None]


@dataclass(frozen=True, kw_only=True)
class _Beside(SmoothFamily):
    """Displacements of another symmetry from a loop, which is at x = 0."""

    loop: SmoothLoop

    @cached_property
    def unknowns(self) -> Unknowns:
        """What stands for a displacement."""
        return Unknowns.beside(self.basis, self.loop)


def smooth_family(point: BranchPoint) -> SmoothFamily:
    """Return the family of a point of a branch of films without a mesh."""
    return cast(SmoothFamily, point.family)
