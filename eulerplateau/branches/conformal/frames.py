"""The frame of a rod that is curved by nature, along a loop without a mesh.

With z the axis across the flat film, t the tangent, which is nowhere along z,

    u = (z - (z.t) t) / s,  v = t x u,  s = |z - (z.t) t|,  d_1 = cos(psi) u + sin(psi) v,

the direction d_1 in which the rod is curved by nature turns by the angle psi. Then

    k_1 ds = (cos(psi) t'.z + sin(psi) t'.(t x z)) / s dphi,
    Omega ds = (psi' - (z.t) t'.(t x z) / s^2) dphi,

primes being derivatives by phi. On a flat loop that lies in its own plane by nature d_1 is
its normal, psi = -pi/2, and so psi = -pi/2 + chi, chi a trigonometric polynomial: the rod
was not turned before it was welded. If it was turned `link` times, psi = -pi/2 +
link (phi - pi) + chi for phi from 0, where it was welded, to 2 pi.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal import GENERAL, Basis, Curve, Jet, dot, variables


@dataclass(frozen=True)
class Frames:
    """What stands for chi along the loops of a basis: coefficients of cos and sin k phi.

    With the half-turn about x of the loops of `basis` chi is a sum of sines, with all
    half-turns, which a rod that was turned does not have, of even k.
    """

    basis: Basis
    link: float = 0.0

    @cached_property
    def columns(self) -> tuple[tuple[str, int], ...]:
        """("cos" or "sin", k) of each coefficient."""
        most = self.basis.harmonics
        if self.basis.family is GENERAL:
            every = ((kind, k) for k in range(1, most + 1) for kind in ("cos", "sin"))
            return self.basis.completed((("cos", 0), *every))
        step = 2 if self.basis.keeps_half_turns else 1
        sines = tuple(("sin", k) for k in range(step, most + 1, step))
        return self.basis.completed(sines)

    @cached_property
    def wavenumbers(self) -> FloatArray:
        """The k of each coefficient."""
        return self.basis.waves_in(self.columns)

    @cached_property
    def _values(self) -> tuple[FloatArray, FloatArray]:
        """The columns' values and derivatives at the grid, (n, m) each."""
        values, slopes, _ = self.basis.waves(self.columns)
        return values, slopes

    @cached_property
    def _projector(self) -> FloatArray:
        """What takes angles (n,) to coefficients (m, n)."""
        return self.basis.projector(self._values[0])

    @cached_property
    def design(self) -> FloatArray:
        """The derivative (n, 8, size + m) of (x', x'', psi, psi') by all unknowns."""
        size = self.basis.size
        found = np.zeros((len(self.basis.phi), 8, size + len(self.columns)))
        for axis, part in enumerate(self.basis.slices):
            found[:, axis, part] = self.basis.matrices[axis][1]
            found[:, 3 + axis, part] = self.basis.matrices[axis][2]
        found[:, 6, size:], found[:, 7, size:] = self._values
        return found

    def angle(self, chi: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return psi and its derivative by the grid's variable, (n,) each."""
        (values, slopes), basis = self._values, self.basis
        turned = self.link * (basis.phi % (2 * pi) - pi) - pi / 2
        return values @ chi + turned, slopes @ chi + self.link * basis.spacing

    def bent_and_twisted(self, curve: Curve, chi: FloatArray) -> tuple[Jet, Jet, Jet]:
        """Return k_1 ds/dphi, Omega ds/dphi and ds/dphi by (x', x'', psi, psi')."""
        return _bent_and_twisted(curve, *self.angle(chi))

    def twist_at_weld(self, coefficients: FloatArray, chi: FloatArray) -> float:
        """Return Omega where a rod was welded: at phi = 0."""
        weld = self.basis.phi[:1]
        values, slopes, _ = self.basis.waves_at(self.columns, weld)
        psi = values @ chi + self.link * (weld - pi) - pi / 2
        curve = self.basis.at(coefficients, weld)
        _, twisted, speed = _bent_and_twisted(curve, psi, slopes @ chi + self.link)
        return float(twisted.value[0] / speed.value[0])

    def tail(self, chi: FloatArray) -> float:
        """Return the largest k |c_k| in the last tenth of harmonics, of the largest or 1.

        The error that truncation leaves in the frame's turning, roughly.
        """
        high, every = self.basis.sizes(self.columns, chi)
        return high / max(every, 1.0)

    def embed(self, other: Frames, chi: FloatArray) -> FloatArray:
        """Return the coefficients here of another frame's, harmonic by harmonic."""
        there = dict(zip(other.columns, chi, strict=True))
        return np.array([there.get(column, 0.0) for column in self.columns])

    def even(self, curve: Curve) -> FloatArray:
        """Return the coefficients (m,) of the frame that is twisted evenly along a loop."""
        _, twisted, speed = self.bent_and_twisted(curve, np.zeros(len(self.columns)))
        mean = twisted.value.mean() / speed.value.mean()
        lacking = mean * speed.value - twisted.value
        even: FloatArray = np.linalg.lstsq(self._values[1], lacking, rcond=1e-12)[0]
        return even

    def transfer(self, other: Frames, chi: FloatArray) -> FloatArray:
        """Return the coefficients here of another frame's, theta kept."""
        there = self.basis.phi_of(other.basis)
        values, _, _ = other.basis.waves_at(other.columns, there)
        return self.project(values @ chi)

    def turned(self, curve: Curve, axis: FloatArray) -> FloatArray:
        """Return how psi (n,) changes where loop and frame turn about an axis (3,).

        d_1 turns about t by axis.t, and u by -(z.t) (axis x t).v / s.
        """
        t = curve.x1 / np.linalg.norm(curve.x1, axis=1)[:, None]
        z = np.array([0.0, 0.0, 1.0])
        across = np.cross(t, z)
        swung = (np.cross(axis, t) * across).sum(axis=1) / (across**2).sum(axis=1)
        changed: FloatArray = t @ axis + t[:, 2] * swung
        return changed

    def project(self, angles: FloatArray) -> FloatArray:
        """Return the coefficients (m, ...) of angles (n, ...) at the grid."""
        found: FloatArray = self._projector @ angles
        return found


def _bent_and_twisted(
    curve: Curve, psi: FloatArray, rate: FloatArray
) -> tuple[Jet, Jet, Jet]:
    """Return k_1 ds, Omega ds and ds over the variable that x', x'' and psi' are by."""
    given = np.column_stack([curve.x1, curve.x2, psi, rate])
    px, py, pz, qx, qy, qz, angle, turning = variables(given)
    p, q = [px, py, pz], [qx, qy, qz]
    u = dot(p, p)
    speed = u.power(0.5)
    # s^2 u, and t'.z and t'.(t x z) times u / speed.
    flat = px * px + py * py
    upwards = qz - dot(p, q) * pz / u
    sideways = (qx * py - qy * px) / u
    bent = angle.cos() * upwards + angle.sin() * sideways * speed
    bent = bent / flat.power(0.5)
    twisted = turning - pz * sideways * speed / flat
    return bent, twisted, speed
