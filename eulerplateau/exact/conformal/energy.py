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
class _Invariants:
    """u = |x'|^2, v = |x''|^2, c = x'.x'' and g = u v - c^2 = |x' x x''|^2, each (n,)."""

    u: FloatArray
    v: FloatArray
    c: FloatArray

    @property
    def g(self) -> FloatArray:
        return self.u * self.v - self.c**2


@dataclass(frozen=True)
class Blocks:
    """A second derivative by x' and x'' at each point, (n, 3, 3): pp, pq and qq.

    None where there is nothing but zeros.
    """

    pp: FloatArray
    pq: FloatArray | None
    qq: FloatArray | None

    def matrix(self, basis: Basis) -> FloatArray:
        """Return sum B1^T pp B1 + B1^T pq B2 + B2^T pq^T B1 + B2^T qq B2 over the grid."""
        whole = np.zeros((basis.size, basis.size))
        for a in range(3):
            for b in range(a, 3):
                _, a1, a2 = basis.matrices[a]
                _, b1, b2 = basis.matrices[b]
                block = a1.T @ (self.pp[:, a, b, None] * b1)
                if self.pq is not None:
                    block += a1.T @ (self.pq[:, a, b, None] * b2)
                    block += a2.T @ (self.pq[:, b, a, None] * b1)
                if self.qq is not None:
                    block += a2.T @ (self.qq[:, a, b, None] * b2)
                rows, columns = basis.slices[a], basis.slices[b]
                whole[rows, columns] = basis.weight * block
                whole[columns, rows] = whole[rows, columns].T
        return whole

    def product(self, basis: Basis, step: FloatArray) -> FloatArray:
        """Return that times a step (size,): without the matrix, in O(n size)."""
        moved = basis.curve(step)
        by_x1 = _times(self.pp, moved.x1)
        by_x2 = np.zeros_like(by_x1)
        if self.pq is not None:
            by_x1 += _times(self.pq, moved.x2)
            by_x2 += _times(self.pq.transpose(0, 2, 1), moved.x1)
        if self.qq is not None:
            by_x2 += _times(self.qq, moved.x2)
        return assemble(basis, by_x1, 1) + assemble(basis, by_x2, 2)


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
    i = _invariants(curve)
    return float(2 * pi * (i.g * i.u**-2.5).mean())


def bending_gradient(basis: Basis, curve: Curve) -> FloatArray:
    """Return the gradient (size,) of the bending energy, in the columns of `basis`."""
    by_x1, by_x2 = _bending_slopes(curve, _invariants(curve))
    return assemble(basis, by_x1, 1) + assemble(basis, by_x2, 2)


def loop_length(curve: Curve) -> float:
    """Return the length of a loop."""
    return float(2 * pi * np.linalg.norm(curve.x1, axis=1).mean())


def length_gradient(basis: Basis, curve: Curve) -> FloatArray:
    """Return the gradient (size,) of the length, in the columns of `basis`."""
    return assemble(basis, curve.x1 / np.linalg.norm(curve.x1, axis=1)[:, None], 1)


def bending_hessian(basis: Basis, curve: Curve) -> FloatArray:
    """Return the Hessian (size, size) of oint |x' x x''|^2 / |x'|^5 dphi.

    `basis` may have another symmetry than the loop: then this is the block of the
    displacements that have it.
    """
    return bending_blocks(curve).matrix(basis)


def bending_blocks(curve: Curve) -> Blocks:
    """Return the second derivative of |x' x x''|^2 / |x'|^5."""
    i, (p, q) = _invariants(curve), curve[1:]
    by_p, by_q = _g_slopes(curve, i)
    u5, u7, u9 = (_column(i.u**-power) for power in (2.5, 3.5, 4.5))
    g, eye = _column(i.g), np.eye(3)
    pp = u5 * (2 * _column(i.v) * eye - 2 * _outer(q, q))
    pp += -5 * u7 * (_outer(by_p, p) + _outer(p, by_p) + g * eye)
    pp += 35 * u9 * g * _outer(p, p)
    pq = u5 * (4 * _outer(p, q) - 2 * _outer(q, p) - 2 * _column(i.c) * eye)
    pq += -5 * u7 * _outer(p, by_q)
    qq = 2 * u5 * (_column(i.u) * eye - _outer(p, p))
    return Blocks(pp, pq, qq)


def length_hessian(basis: Basis, curve: Curve) -> FloatArray:
    """Return the Hessian (size, size) of oint |x'| dphi; see `bending_hessian`."""
    return length_blocks(curve).matrix(basis)


def length_blocks(curve: Curve) -> Blocks:
    """Return the second derivative of |x'|."""
    p = curve.x1
    speed = _column(np.linalg.norm(p, axis=1))
    return Blocks(np.eye(3) / speed - _outer(p, p) / speed**3, None, None)


def _invariants(curve: Curve) -> _Invariants:
    p, q = curve.x1, curve.x2
    return _Invariants((p * p).sum(1), (q * q).sum(1), (p * q).sum(1))


def _g_slopes(curve: Curve, i: _Invariants) -> tuple[FloatArray, FloatArray]:
    """Return the derivatives (n, 3) of g by x' and by x''."""
    u, v, c = i.u[:, None], i.v[:, None], i.c[:, None]
    return 2 * (v * curve.x1 - c * curve.x2), 2 * (u * curve.x2 - c * curve.x1)


def _bending_slopes(curve: Curve, i: _Invariants) -> tuple[FloatArray, FloatArray]:
    """Return the derivatives (n, 3) of g u^(-5/2) by x' and by x''."""
    by_p, by_q = _g_slopes(curve, i)
    u = i.u[:, None]
    return by_p * u**-2.5 - 5 * i.g[:, None] * u**-3.5 * curve.x1, by_q * u**-2.5


def _column(values: FloatArray) -> FloatArray:
    return values[:, None, None]


def _outer(a: FloatArray, b: FloatArray) -> FloatArray:
    return a[:, :, None] * b[:, None, :]


def _times(blocks: FloatArray, vectors: FloatArray) -> FloatArray:
    """Return blocks (n, 3, 3) times vectors (n, 3)."""
    products: FloatArray = np.einsum("nab,nb->na", blocks, vectors)
    return products


def assemble(basis: Basis, slopes: FloatArray, order: int) -> FloatArray:
    """Return the gradient (size,) of slopes (n, 3) by the loop's derivative of an order."""
    parts = [m[order].T @ slopes[:, axis] for axis, m in enumerate(basis.matrices)]
    return basis.weight * np.concatenate(parts)
