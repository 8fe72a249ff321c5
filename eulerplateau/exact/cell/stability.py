"""The second variation of a regular cell against all displacements, wave by wave.

A displacement of a cell with N adhesions that all are alike is a sum of waves: from one
side to the next it is multiplied by exp(i q w), w = 2 pi / N, in axes that turn along by
w. Waves of different q do not mix, and of each only one side has to be looked at:

    its curvature, sum_k a_k P_k / length; its length; its angle A at the adhesion where it
    starts; the place rho of that adhesion,

with the conditions that the next side starts where this one ends and in the direction in
which it ends. q = 0 holds what keeps the cell's symmetry; where a wave with q > 0 loses its
stability sides become unlike, with q = N / 2 in turn, with another q in two ways at once.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.cell.side import HalfSide, Rule, rule

_J = np.array([[0.0, 1.0], [-1.0, 0.0]])


@dataclass(frozen=True)
class Waves:
    """Displacements of one cell as waves; alpha = R_0 = 1.

    Attributes
    ----------
    side : HalfSide, of an equilibrium
    sigma, stiffness, beta : float
    """

    side: HalfSide
    sigma: float
    stiffness: float
    beta: float

    def lowest(self, q: int) -> float:
        """Return the smallest eigenvalue of the waves with this q, 0 <= q <= N / 2."""
        return float(self.eigenvalues(q)[0])

    @property
    def n_unstable(self) -> int:
        """Negative eigenvalues of all waves: the Morse index."""
        n = self.side.adhesions
        counts = [int(np.sum(self.eigenvalues(q) < 0)) for q in range(n // 2 + 1)]
        twice = [1 if q in (0, n / 2) else 2 for q in range(n // 2 + 1)]
        return int(np.dot(counts, twice))

    def eigenvalues(self, q: int) -> FloatArray:
        """Return the eigenvalues of the waves with this q, ascending.

        Signs have a meaning, sizes not: the norm is that of bending without the rest.
        """
        phase = np.exp(2j * np.pi * q / self.side.adhesions)
        hessian = self._local.astype(complex)
        hessian[-2:, -2:] += 0.5 * self.sigma * (self._turned * phase)
        hessian[-2:, -2:] += 0.5 * self.sigma * (self._turned * phase).conj().T
        scale = np.ones(len(hessian))
        scale[:-4] = np.sqrt(self.side.h * (2 * np.arange(len(scale) - 4) + 1))
        hessian *= scale * scale[:, None]
        normals = self._conditions(phase) * scale
        basis = np.linalg.qr(normals.conj().T, mode="complete")[0][:, len(normals) :]
        values: FloatArray = np.linalg.eigvalsh(basis.conj().T @ hessian @ basis)
        return values

    @cached_property
    def _rotation(self) -> FloatArray:
        """The turn by w, from one adhesion's axes to the next one's (2, 2)."""
        w = 2 * self.side.angle
        return np.array([[np.cos(w), -np.sin(w)], [np.sin(w), np.cos(w)]])

    @cached_property
    def _turned(self) -> FloatArray:
        """The polygon's area is sum rho_i . M rho_{i+1} / 2: this is M (2, 2)."""
        turned: FloatArray = _J @ self._rotation
        return turned

    @cached_property
    def _chord(self) -> tuple[FloatArray, FloatArray]:
        """The chord by (a, length, A): its slope (2, m) and curvature (2, m, m)."""
        r, basis, length, coefficients = self._unknowns
        # The chord lies along the first axis: the side starts at minus half its turn.
        start = -self.side.angle
        edge = np.exp(1j * (start + basis @ coefficients)) * r.shares
        whole = edge.sum()
        inner = 1j * (basis.T @ edge)
        slope = np.concatenate([length * inner, [whole, 1j * length * whole]])
        m = len(slope)
        curvature = np.zeros((m, m), dtype=complex)
        curvature[:-2, :-2] = -length * (basis.T * edge) @ basis
        curvature[:-2, -2] = curvature[-2, :-2] = inner
        curvature[:-2, -1] = curvature[-1, :-2] = 1j * length * inner
        curvature[-2, -1] = curvature[-1, -2] = 1j * whole
        curvature[-1, -1] = -length * whole
        return np.stack([slope.real, slope.imag]), np.stack(
            [curvature.real, curvature.imag]
        )

    @cached_property
    def _unknowns(self) -> tuple[Rule, FloatArray, float, FloatArray]:
        """Quadrature, integrals of P_k at its nodes (m, n), length, and a (n,)."""
        even = self.side.z[:-1]
        coefficients = np.zeros(2 * len(even) + 2)
        coefficients[0] = 2 * self.side.angle
        coefficients[2:-1:2] = 2 * even
        r = rule(len(even))
        nodes = 2 * r.places - 1
        n = len(coefficients)
        values = legendre.legvander(nodes, n)
        k = np.arange(1, n)
        basis = np.empty((len(nodes), n))
        basis[:, 0] = r.places
        basis[:, 1:] = (values[:, 2:] - values[:, :-2]) / (4 * k + 2)
        return r, basis, 2 * self.side.h, coefficients

    @cached_property
    def _local(self) -> FloatArray:
        """Second derivative of the Lagrangian by (a, length, A, rho), one side alone."""
        slope, curvature = self._energy
        chord_slope, chord_curvature = self._chord
        # The force in the chord balances the energy's change with length.
        length = 2 * self.side.h
        span = float(chord_slope[0, -2]) * length
        force = slope[-1] * length / span
        m = len(slope) + 1
        local = np.zeros((m + 2, m + 2))
        local[: m - 1, : m - 1] = curvature
        local[:m, :m] -= force * chord_curvature[0]
        local[-2:, -2:] = 2 * self.stiffness * np.eye(2)
        return local

    def _conditions(self, phase: complex) -> NDArray[np.complex128]:
        """Return the slopes (3, m + 2) of what joins a side to the next one."""
        chord_slope, _ = self._chord
        m = chord_slope.shape[1]
        rows = np.zeros((3, m + 2), dtype=complex)
        rows[0, 0], rows[0, m - 1] = -1.0, phase - 1.0
        rows[1:, :m] = -chord_slope
        rows[1:, -2:] = phase * self._rotation - np.eye(2)
        return rows

    @cached_property
    def _energy(self) -> tuple[FloatArray, FloatArray]:
        """Slope and curvature of bending, line tension and film beyond the chord."""
        r, basis, length, a = self._unknowns
        squares = 1.0 / (2 * np.arange(len(a)) + 1)
        bulge, bulge_slope, bulge_curvature = _bulge(r, basis, a)
        square = float(squares @ a**2)
        sigma = self.sigma
        m = len(a) + 1
        slope = np.append(
            2 * squares * a / length + sigma * length**2 * bulge_slope,
            -square / length**2 + self.beta + 2 * sigma * length * bulge,
        )
        curvature = np.zeros((m, m))
        curvature[:-1, :-1] = np.diag(2 * squares / length)
        curvature[:-1, :-1] += sigma * length**2 * bulge_curvature
        mixed = -2 * squares * a / length**2 + 2 * sigma * length * bulge_slope
        curvature[-1, :-1] = curvature[:-1, -1] = mixed
        curvature[-1, -1] = 2 * square / length**3 + 2 * sigma * bulge
        return slope, curvature


def _bulge(
    r: Rule, basis: FloatArray, a: FloatArray
) -> tuple[float, FloatArray, FloatArray]:
    """Return the area between side and chord over length^2, by the coefficients a.

    It is half the integral of sin(phi(u) - phi(v)) over v < u, phi the tangent's angle.
    """
    edge = np.exp(1j * (basis @ a))
    before = r.integral @ edge
    after = r.shares @ edge - before
    density = 0.5 * ((edge * before.conj()).real - (edge.conj() * after).real)
    slope = (r.shares * density) @ basis
    bent = -0.5 * ((edge * before.conj()).imag + (edge.conj() * after).imag)
    curvature = (basis.T * (r.shares * bent)) @ basis
    moved = edge[:, None] * basis
    inner = r.integral @ moved
    outer = r.shares @ moved - inner
    spread = 0.5 * (edge[:, None] * inner.conj() + edge.conj()[:, None] * outer).imag
    curvature += (basis.T * r.shares) @ spread
    value = 0.5 * float(r.shares @ (edge * before.conj()).imag)
    return value, slope, 0.5 * (curvature + curvature.T)
