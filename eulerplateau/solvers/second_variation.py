"""The second variation of an energy of loops, near one loop: gradient, Hessian, spectrum.

With the film's interior eliminated the energy of fixed weights is tr(x_b^T A x_b) / 2,
A = 2 (B + load S). Where J p = 0 and p is no rigid motion, the Lagrangian's Hessian is

    (A + D^T diag(lambda / s) D) (x) I_3,     (D x)_v = x_{v+1} - x_v,

one n_b x n_b matrix for all three coordinates. Coordinates here are y = sqrt(<s>) x, so
that eigenvalues belong to the norm of integral |p|^2 ds and converge with the mesh; their
unit is alpha / L^4, i.e. 1 for L = alpha = 1.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.lapack import dpotrf, dpotrs
from eulerplateau.loop import EdgeTurns, LoopEnergy
from eulerplateau.solvers.equilibrium import Stability
from eulerplateau.solvers.tangent_coordinates import Columns, Coordinates, turned
from eulerplateau.solvers.tangent_space import balanced, normals, orthonormal

# The residual above which tensions that are known otherwise are better than these.
_BALANCED = 1e-4


@dataclass(frozen=True)
class NewtonStep:
    """A displacement (n, d) of a loop, its size, and the change of energy it promises."""

    moved: FloatArray
    size: float
    promised: float


@dataclass(frozen=True)
class TangentModel:
    """Second-order model of an energy of loops (n, d) where its constraint is kept.

    Of a loop in space that keeps its n lengths there are m = 2 n - 6 unknowns, of a plane
    one n - 3, and one less where the loop slides along itself for nothing.

    Attributes
    ----------
    x : (n, d) float
    weights : (n,) float, the length that belongs to each vertex
    tensions : float, one for each equation of the constraint
        Least-squares multipliers lambda.
    residual : float
        |g + J^T lambda|_inf over the largest of the forces that g is the sum of.
    rounding : float
        The residual that rounding alone can leave.
    coordinates : orthonormal ones of the displacements p with J p = 0, no free motion
    gradient : (m,) float
    hessian : (m, m) float
    """

    x: FloatArray
    weights: FloatArray
    tensions: FloatArray
    residual: float
    rounding: float
    coordinates: Coordinates
    gradient: FloatArray
    hessian: FloatArray

    @property
    def dense(self) -> TangentModel:
        """The model on all of the tangent space: this one."""
        return self

    def newton_step(self, radius: float) -> NewtonStep | None:
        """Return the Newton step if the Hessian is positive definite and it fits."""
        step = self._newton
        if step is None or float(np.linalg.norm(step)) > radius:
            return None
        return self.step(step)

    @cached_property
    def _newton(self) -> FloatArray | None:
        """The Newton step's coefficients (m,), None unless the Hessian is definite."""
        factor, failed = dpotrf(self.hessian)
        if failed:
            return None
        step: FloatArray = -dpotrs(factor, self.gradient)[0]
        return step

    def step(self, coefficients: FloatArray) -> NewtonStep:
        """Return the step with these tangent coefficients (m,)."""
        curved = 0.5 * coefficients @ (self.hessian @ coefficients)
        promised = float(self.gradient @ coefficients + curved)
        size = float(np.linalg.norm(coefficients))
        return NewtonStep(self.displacement(coefficients), size, promised)

    @cached_property
    def eigen(self) -> tuple[FloatArray, FloatArray]:
        """Eigenvalues, ascending, and eigenvectors of the Hessian."""
        values, vectors = np.linalg.eigh(self.hessian)
        return values, vectors

    @cached_property
    def eigenvalues(self) -> FloatArray:
        """Eigenvalues of the Hessian, ascending; a third of the work of `eigen`."""
        return np.linalg.eigvalsh(self.hessian).astype(np.float64, copy=False)

    @cached_property
    def basis(self) -> FloatArray:
        """The coordinates' orthonormal columns (d n, m), as `modes` are."""
        return self.modes(np.eye(len(self.gradient)))

    @property
    def scale(self) -> FloatArray:
        """The factor sqrt(<s>) (d n,) of each of the coordinates sqrt(<s>) x."""
        return np.repeat(np.sqrt(self.weights), self.x.shape[1])

    def displacement(self, coefficients: FloatArray) -> FloatArray:
        """Return the loop displacement (n, d) of tangent coefficients (m,)."""
        moved = self.coordinates.displacement(coefficients[:, None])
        return moved.reshape(self.x.shape)

    def slope(self, force: FloatArray) -> FloatArray:
        """Return what a force (n, d) is by the coefficients (m,)."""
        return self.coordinates.slope(force.reshape(-1, 1))[:, 0]

    def coefficients(self, displacement: FloatArray) -> FloatArray:
        """Return the coefficients (m,) of the part of a displacement (n, d) they span."""
        return self.slope(self.weights[:, None] * displacement)

    def modes(self, coefficients: FloatArray) -> FloatArray:
        """Return modes (d n, k) of coefficients (m, k), in the coordinates sqrt(<s>) x."""
        moved = self.coordinates.displacement(coefficients)
        return self.scale[:, None] * moved


def tangent_model(
    energy: LoopEnergy, x: FloatArray, near: FloatArray | None = None
) -> TangentModel:
    """Build the model at loop positions x (n, d) that keep the energy's constraint.

    Tensions are `near`, if they are known and forces do not balance yet.
    """
    forces = energy.forces(x)
    total = sum(forces[1:], start=forces[0])
    coordinates, tensions, gradient, unbalanced = _tangent_space(energy, x, total)
    forces.append(energy.constraint.force(x, tensions))
    largest = max(float(np.abs(force).max()) for force in forces)
    residual = float(np.abs(unbalanced).max()) / largest
    if near is not None and residual > _BALANCED:
        tensions = near
    return TangentModel(
        x=x,
        weights=energy.weights,
        tensions=tensions,
        residual=residual,
        rounding=energy.rounding * float(np.abs(x).max()) / largest,
        coordinates=coordinates,
        gradient=gradient,
        hessian=coordinates.hessian(energy, x, tensions),
    )


def loosened(energy: LoopEnergy, held: LoopEnergy, model: TangentModel) -> TangentModel:
    """Return a model with less held: by an energy's own constraint, of all of `held`.

    `model` is of `held`, whose constraint has more equations, and whose tensions there are.
    """
    x, forces = model.x, energy.forces(model.x)
    total = sum(forces[1:], start=forces[0])
    coordinates, _, gradient, _ = _tangent_space(energy, x, total)
    hessian = coordinates.hessian(held, x, model.tensions)
    return replace(model, coordinates=coordinates, gradient=gradient, hessian=hessian)


def _tangent_space(
    energy: LoopEnergy, x: FloatArray, force: FloatArray
) -> tuple[Coordinates, FloatArray, FloatArray, FloatArray]:
    """Return coordinates, tensions, a force (n, d) by the coordinates, and what is left.

    Tensions do not balance that, and it is not along motions that are free: what a mesh
    leaves of a soap film's force there is a discretisation error.
    """
    free = energy.free_motions(x)
    turns = energy.constraint.turns(x)
    if turns is not None:
        # On a loop that has fallen onto a line turns hang together, and a QR is surer.
        with suppress(LinAlgError):
            return _by_turns(energy, x, force, free, turns)
    return _by_columns(energy, x, force, free)


def _by_turns(
    energy: LoopEnergy,
    x: FloatArray,
    force: FloatArray,
    free: FloatArray,
    turns: EdgeTurns,
) -> tuple[Coordinates, FloatArray, FloatArray, FloatArray]:
    if turns.others is None:
        motions = orthonormal(energy, free)
        tensions, unbalanced = balanced(energy, x, force, motions, turns.metric)
        coordinates = turned(turns, free)
    else:
        tensions, unbalanced = _balanced_by_all(energy, force, free, turns)
        weights = np.repeat(energy.weights, x.shape[1])[:, None]
        coordinates = turned(turns, np.hstack([free, turns.others.T / weights]))
    gradient = coordinates.slope(unbalanced.reshape(-1, 1))[:, 0]
    return coordinates, tensions, gradient, unbalanced


def _balanced_by_all(
    energy: LoopEnergy, force: FloatArray, free: FloatArray, turns: EdgeTurns
) -> tuple[FloatArray, FloatArray]:
    """Return the same of a loop that is held to more than its lengths: tensions (n + k,).

    Tensions balance each other equation's force first, and what they leave is independent.
    """
    assert turns.others is not None
    metric, shape = turns.metric, force.shape
    root = np.repeat(np.sqrt(energy.weights), shape[1])[:, None]
    parts = [force, *turns.others.reshape(-1, *shape)]
    tensions = [metric.balance(part) for part in parts]
    left = [part + metric.force(pull) for part, pull in zip(parts, tensions, strict=True)]
    columns = np.stack([each.ravel() for each in left], axis=1) / root
    others = np.hstack([columns[:, 1:], free * root])
    shares = np.linalg.lstsq(others, -columns[:, 0], rcond=None)[0]
    unbalanced = (columns[:, :1] + others @ shares[:, None]) * root
    pushes = shares[: len(turns.others)]
    pulls = tensions[0] + np.stack(tensions[1:], axis=1) @ pushes
    return np.concatenate([pulls, pushes]), unbalanced.reshape(shape)


def _by_columns(
    energy: LoopEnergy, x: FloatArray, force: FloatArray, free: FloatArray
) -> tuple[Coordinates, FloatArray, FloatArray, FloatArray]:
    scale, columns, m = normals(energy, x, free)
    weighted = force.ravel() / scale
    q, r = np.linalg.qr(columns, mode="complete")
    # What is along free motions is not for tensions to balance.
    known = m + free.shape[1]
    tensions = -np.linalg.solve(r[:known], q[:, :known].T @ weighted)[:m]
    basis = q[:, known:]
    gradient = basis.T @ weighted
    unbalanced = basis @ gradient * scale
    return Columns(basis, scale), tensions, gradient, unbalanced.reshape(x.shape)


def stability(model: TangentModel) -> Stability:
    """Return the spectrum at an equilibrium."""
    return spectrum_of(model.eigenvalues)


def spectrum_of(values: FloatArray) -> Stability:
    """Return all eigenvalues, ascending, with the error they have.

    The bound is the backward error of the symmetric eigensolver and of the projected
    Hessian, a small multiple of eps |H|_2 (Weyl).
    """
    if len(values) == 0:
        return Stability(values, 0.0)
    eps = float(np.finfo(np.float64).eps)
    return Stability(values, 10 * eps * float(np.abs(values).max()))
