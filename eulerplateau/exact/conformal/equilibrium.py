"""Equilibria of the true film: Newton's method on loop, tension and load together.

A stationary point of

    sigma_hat D + oint kappa^2 ds + beta (length - 1)

over all loops x(phi), reparametrisations included, is conformal; then D is the area of a
minimal surface and x its boundary in equilibrium (paper, eq. euler-plateau). The loop may
slide along itself: an inextensible loop takes every such shape, and its energy does not
see the sliding.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.conformal.basis import Basis, Curve
from eulerplateau.exact.conformal.energy import (
    Terms,
    bending_hessian,
    length_hessian,
    terms,
)
from eulerplateau.exact.conformal.gauge import gauge_modes

# A change of sigma_hat by this much is as long as a change of the loop by one length.
LOAD_UNIT = 1000.0
_CORRECTIONS = 30
# Gradient over the largest of its three parts, at which a film is one in equilibrium; where
# rounding stops Newton's method earlier, it may be so much.
_SETTLED, _STUCK = 1e-13, 1e-9
# Stiffness against motions that change nothing, in units of alpha/L^3.
_GAUGE_STIFFNESS = 1e3
# Largest change of the loop in one step, as a sum of k |dc|, in lengths.
_TRUST = 0.5


@dataclass(frozen=True, repr=False)
class ConformalFilm:
    """A film in equilibrium. Lengths in L, energies in alpha/L.

    Attributes
    ----------
    coefficients : (basis.size,) float
        The loop; the surface is its harmonic extension to the disk of angle theta.
    beta : float
        Multiplier of length, beta_hat of the planar films.
    load : float
        sigma_hat = sigma L^3 / alpha.
    energy : float
        load * area + bending, bending being oint kappa^2 ds, without 1/2.
    residual : float
        Largest component of the gradient over the largest of its parts; gauge left out.
    """

    basis: Basis
    coefficients: FloatArray
    beta: float
    load: float
    energy: float
    area: float
    bending: float
    residual: float
    corrections: int

    def __repr__(self) -> str:
        numbers = f"energy={self.energy:.10g}, area={self.area:.10g}"
        return (
            f"ConformalFilm({self.basis.family.name}, load={self.load:.10g}, {numbers}, "
            f"harmonics={self.basis.harmonics}, residual={self.residual:.1e})"
        )

    @property
    def curve(self) -> Curve:
        """The loop at the basis's grid."""
        return self.basis.curve(self.coefficients)

    @property
    def tail(self) -> float:
        """Estimate of the relative error of truncation (Basis.tail)."""
        return self.basis.tail(self.coefficients)


@dataclass(frozen=True)
class Direction:
    """A direction of a branch: coefficients (size,) and load, of length one in `inner`."""

    coefficients: FloatArray
    load: float

    def reversed(self) -> Direction:
        """Return the opposite direction."""
        return Direction(-self.coefficients, -self.load)


def inner(basis: Basis, a: Direction, b: Direction) -> float:
    """Return the inner product: of the loops' tangents, and of the loads."""
    weighted = basis.wavenumbers**2 * a.coefficients
    return float(weighted @ b.coefficients + a.load * b.load / LOAD_UNIT**2)


def disk(basis: Basis, load: float) -> ConformalFilm:
    """Return the flat disk at sigma_hat = load."""
    theta, radius = basis.theta, 1 / (2 * pi)
    x = radius * np.stack([np.cos(theta), np.sin(theta), 0 * theta], axis=-1)
    beta = radius**-2 - load * radius
    c = basis.project(x)
    if basis.crowding == 1.0:
        # Exact: what rounding leaves in other harmonics the film hardly holds at low loads.
        c = c * (basis.wavenumbers == 1)
    found = correct(basis, c, beta, load)
    if found is None:  # too few harmonics for the grading: still the best approximation
        return _film(basis, c, beta, load, np.inf, 0)
    return found


def correct(
    basis: Basis,
    guess: FloatArray,
    beta: float,
    load: float,
    normal: Direction | None = None,
    limit: int = _CORRECTIONS,
) -> ConformalFilm | None:
    """Return the equilibrium near a guess (size,), at its load or in a hyperplane.

    With `normal`, in the hyperplane through guess and load normal to it, else at the load.
    None if `limit` steps of Newton's method do not lead to one.
    """
    found = newton(basis, guess, beta, load, normal, limit)
    return None if found is None else found[0]


def newton(
    basis: Basis,
    guess: FloatArray,
    beta: float,
    load: float,
    normal: Direction | None,
    limit: int,
) -> tuple[ConformalFilm, NewtonSystem] | None:
    """Return what `correct` does, with the linear system there."""
    start, c, best = Direction(guess, load), guess, np.inf
    for corrections in range(limit):
        system = NewtonSystem.at(basis, c, beta, load, normal)
        residual = system.residual
        stuck = 0.5 * best < residual < _STUCK
        if residual < _SETTLED or stuck:
            return _film(basis, c, beta, load, residual, corrections), system
        if not np.isfinite(residual):
            return None
        best = min(best, residual)
        off = 0.0
        if normal is not None:
            off = inner(basis, normal, Direction(c - guess, load - start.load))
        step, to_beta, to_load = system.solve(system.gradient, system.stretch, off)
        short = min(1.0, _TRUST / float(basis.wavenumbers @ np.abs(step) + 1e-300))
        c, beta, load = c + short * step, beta + short * to_beta, load + short * to_load
    return None


@dataclass(frozen=True)
class NewtonSystem:
    """The linear system of a Newton step or of a branch's direction, preconditioned."""

    matrix: FloatArray
    scale: FloatArray
    gradient: FloatArray
    stretch: float
    residual: float

    @classmethod
    def at(
        cls,
        basis: Basis,
        c: FloatArray,
        beta: float,
        load: float,
        normal: Direction | None,
    ) -> NewtonSystem:
        """Return the system at a loop, bordered by `normal` or holding the load."""
        t, curve, n = terms(basis, c), basis.curve(c), basis.size
        scale = precondition(basis)
        gauge = gauge_modes(basis, curve)
        gradient = _without(gauge, _gradient(t, beta, load))
        largest = max(
            float(np.abs(scale * part).max())
            for part in (
                t.bending_gradient,
                beta * t.length_gradient,
                load * t.area_gradient,
            )
        )
        error = float(np.abs(scale * gradient).max()) / largest
        hessian = lagrangian_hessian(basis, curve, beta, load)
        hessian += _GAUGE_STIFFNESS * gauge @ gauge.T
        matrix = np.zeros((n + 2, n + 2))
        matrix[:n, :n] = scale[:, None] * hessian * scale
        matrix[:n, n] = matrix[n, :n] = scale * t.length_gradient
        matrix[:n, n + 1] = scale * t.area_gradient * LOAD_UNIT
        if normal is None:
            matrix[n + 1, n + 1] = 1.0
        else:
            matrix[n + 1, :n] = scale * basis.wavenumbers**2 * normal.coefficients
            matrix[n + 1, n + 1] = normal.load / LOAD_UNIT
        stretch = t.length - 1
        return cls(matrix, scale, gradient, stretch, max(error, abs(stretch)))

    def solve(
        self, gradient: FloatArray, stretch: float, off: float
    ) -> tuple[FloatArray, float, float]:
        """Return the step in coefficients, beta and load that cancels the arguments."""
        rhs = -np.concatenate([self.scale * gradient, [stretch, off]])
        try:
            step = np.linalg.solve(self.matrix, rhs)
        except np.linalg.LinAlgError:
            return np.full(len(self.scale), np.nan), np.nan, np.nan
        return self.scale * step[:-2], float(step[-2]), LOAD_UNIT * float(step[-1])

    def direction(self, basis: Basis) -> Direction:
        """Return the direction in which films go on, the way of the border."""
        step, _, load = self.solve(np.zeros(basis.size), 0.0, -1.0)
        found = Direction(step, load)
        size = float(np.sqrt(inner(basis, found, found)))
        return Direction(step / size, load / size)


def branch_direction(film: ConformalFilm, last: Direction | None) -> Direction:
    """Return a branch's direction at a film, the way of `last` or to higher loads."""
    basis = film.basis
    system = NewtonSystem.at(basis, film.coefficients, film.beta, film.load, last)
    return system.direction(basis)


def lagrangian_hessian(basis: Basis, curve: Curve, beta: float, load: float) -> FloatArray:
    """Return the Hessian (size, size) of load D + bending + beta length."""
    bending = bending_hessian(basis, curve)
    return bending + beta * length_hessian(basis, curve) + load * basis.dirichlet


def precondition(basis: Basis) -> FloatArray:
    """Return 1 / (k sqrt(1 + k^2)) (size,): bending makes Hessians grow as k^4."""
    k = basis.wavenumbers
    scale: FloatArray = 1 / (k * np.sqrt(1 + k**2))
    return scale


def _gradient(t: Terms, beta: float, load: float) -> FloatArray:
    return t.bending_gradient + beta * t.length_gradient + load * t.area_gradient


def _without(modes: FloatArray, vector: FloatArray) -> FloatArray:
    rest: FloatArray = vector - modes @ (modes.T @ vector)
    return rest


def _film(
    basis: Basis,
    c: FloatArray,
    beta: float,
    load: float,
    residual: float,
    corrections: int,
) -> ConformalFilm:
    t = terms(basis, c)
    return ConformalFilm(
        basis=basis,
        coefficients=c,
        beta=beta,
        load=load,
        energy=t.bending + load * t.area,
        area=t.area,
        bending=t.bending,
        residual=residual,
        corrections=corrections,
    )
