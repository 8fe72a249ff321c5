"""Bending, length and area of a film given by its loop, with two derivatives of each.

The area is the Dirichlet energy of the loop's harmonic extension: equal to it where the
parametrisation is conformal, larger elsewhere, and stationary under reparametrisations
only where it is conformal (Douglas 1931). Units: length of the loop 1, energies alpha/L.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal.basis import Basis, Curve
from eulerplateau.exact.conformal.integrand_kernels import (
    assemble,
    bending_second,
    bending_slopes,
    length_second,
    spread,
)


@dataclass(frozen=True)
class Terms:
    """Bending oint kappa^2 ds (no 1/2), length and area, and their gradients (size,)."""

    bending: float
    length: float
    area: float
    bending_gradient: FloatArray
    length_gradient: FloatArray
    area_gradient: FloatArray


@dataclass(frozen=True)
class Blocks:
    """The second derivative of an integrand by x', and by x'' where it depends on that.

    Attributes
    ----------
    second : (points, m, 3, m, 3) float
        By the first m derivatives of the loop, at the first points of a basis's grid.
    """

    second: FloatArray

    def matrix(self, basis: Basis) -> FloatArray:
        """Return the second derivative (size, size) of the integral."""
        columns, m = basis.stacked[1:], self.second.shape[1]
        moved = spread(self.second, basis.weights, columns, basis.starts)
        moved = moved.reshape(3, -1, basis.size)
        found = np.empty((basis.size, basis.size))
        for part, by in zip(basis.slices, moved, strict=True):
            left = columns[:m, :, part].reshape(by.shape[0], -1)
            found[part, part.start :] = left.T @ by[:, part.start :]
            found[part.start :, part] = found[part, part.start :].T
        return found

    def product(self, basis: Basis, step: FloatArray) -> FloatArray:
        """Return that times a step (size,): without the matrix, in O(points size)."""
        moved = np.stack(basis.part(step)[1 : 1 + self.second.shape[1]], axis=1)
        return _assemble(basis, np.einsum("npaqb,nqb->npa", self.second, moved))


def terms(basis: Basis, coefficients: FloatArray) -> Terms:
    """Return the energies of a loop (size,) and their gradients."""
    curve = basis.curve(coefficients)
    area_gradient = basis.dirichlet @ coefficients
    return Terms(
        bending=bending_energy(curve),
        length=loop_length(curve),
        area=float(0.5 * coefficients @ area_gradient),
        bending_gradient=bending_gradient(basis, curve),
        length_gradient=length_gradient(basis, curve),
        area_gradient=area_gradient,
    )


def bending_energy(curve: Curve) -> float:
    """Return the bending energy of a loop."""
    p, q = curve.x1, curve.x2
    u, v, w = (np.einsum("na,na->n", *pair) for pair in ((p, p), (q, q), (p, q)))
    return float(2 * pi * ((u * v - w**2) * u**-2.5).mean())


def bending_gradient(basis: Basis, curve: Curve) -> FloatArray:
    """Return the gradient (size,) of the bending energy, in the columns of `basis`."""
    return gradient(basis, bending_slopes(*curve.first(basis.points)[1:]))


def loop_length(curve: Curve) -> float:
    """Return the length of a loop."""
    return float(2 * pi * np.linalg.norm(curve.x1, axis=1).mean())


def length_gradient(basis: Basis, curve: Curve) -> FloatArray:
    """Return the gradient (size,) of the length, in the columns of `basis`."""
    p = curve.x1[: basis.points]
    return gradient(basis, (p / np.linalg.norm(p, axis=1)[:, None])[:, None])


def bending_hessian(basis: Basis, curve: Curve) -> FloatArray:
    """Return the Hessian (size, size) of oint |x' x x''|^2 / |x'|^5 dphi.

    `basis` may have another symmetry than the loop: then this is the block of the
    displacements that have it.
    """
    return bending_blocks(basis, curve).matrix(basis)


def bending_blocks(basis: Basis, curve: Curve) -> Blocks:
    """Return the second derivative of |x' x x''|^2 / |x'|^5."""
    return Blocks(bending_second(*curve.first(basis.points)[1:]))


def length_hessian(basis: Basis, curve: Curve) -> FloatArray:
    """Return the Hessian (size, size) of oint |x'| dphi; see `bending_hessian`."""
    return length_blocks(basis, curve).matrix(basis)


def length_blocks(basis: Basis, curve: Curve) -> Blocks:
    """Return the second derivative of |x'|."""
    return Blocks(length_second(curve.x1[: basis.points]))


def gradient(basis: Basis, slopes: FloatArray) -> FloatArray:
    """Return the gradient (size,) of an integral of x', or of x' and x''.

    slopes : (points, m, 3), of what is integrated, by m of these. To displacements that
    keep another half-turn than others a loop with all of them is as it is: what these add
    in one quarter they take in the next.
    """
    if basis.is_quartered and not basis.keeps_half_turns:
        return np.zeros(basis.size)
    return _assemble(basis, slopes)


def _assemble(basis: Basis, slopes: FloatArray) -> FloatArray:
    return assemble(slopes, basis.weights, basis.stacked[1:], basis.starts)
