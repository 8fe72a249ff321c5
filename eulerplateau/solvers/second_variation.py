"""The second variation of an energy of loops, near one loop: gradient, Hessian, spectrum.

With the film's interior eliminated the energy of fixed weights is tr(x_b^T A x_b) / 2,
A = 2 (B + load S). Where J p = 0 and p is no rigid motion, the Lagrangian's Hessian is

    (A + D^T diag(lambda / s) D) (x) I_3,     (D x)_v = x_{v+1} - x_v,

one n_b x n_b matrix for all three coordinates. Coordinates here are y = sqrt(<s>) x, so
that eigenvalues belong to the norm of integral |p|^2 ds and converge with the mesh; their
unit is alpha / L^4, i.e. 1 for L = alpha = 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import LoopEnergy
from eulerplateau.solvers.equilibrium import Stability


@dataclass(frozen=True)
class TangentModel:
    """Second-order model of an energy of loops (n, d) where its constraint is kept.

    Of a loop in space that keeps its n lengths there are m = 2 n - 6 unknowns, of a plane
    one n - 3, and one less where the loop slides along itself for nothing.

    Attributes
    ----------
    x : (n, d) float
    tensions : float, one for each equation of the constraint
        Least-squares multipliers lambda.
    residual : float
        |g + J^T lambda|_inf over the largest of the forces that g is the sum of.
    rounding : float
        The residual that rounding alone can leave.
    basis : (d n, m) float
        Orthonormal columns in the coordinates sqrt(<s>) x: J p = 0, no free motion.
    gradient : (m,) float
    hessian : (m, m) float
    scale : (d n,) float, sqrt(<s>)
    """

    x: FloatArray
    tensions: FloatArray
    residual: float
    rounding: float
    basis: FloatArray
    gradient: FloatArray
    hessian: FloatArray
    scale: FloatArray

    @property
    def weights(self) -> FloatArray:
        """The length (n,) that belongs to each vertex."""
        weights: FloatArray = self.scale[:: self.x.shape[1]] ** 2
        return weights

    @cached_property
    def eigen(self) -> tuple[FloatArray, FloatArray]:
        """Eigenvalues, ascending, and eigenvectors of the Hessian."""
        values, vectors = np.linalg.eigh(self.hessian)
        return values, vectors

    @cached_property
    def eigenvalues(self) -> FloatArray:
        """Eigenvalues of the Hessian, ascending; a third of the work of `eigen`."""
        return np.linalg.eigvalsh(self.hessian).astype(np.float64, copy=False)

    def displacement(self, coefficients: FloatArray) -> FloatArray:
        """Return the loop displacement (n_b, 3) of tangent coefficients."""
        step: FloatArray = (self.basis @ coefficients / self.scale).reshape(self.x.shape)
        return step


def tangent_model(energy: LoopEnergy, x: FloatArray) -> TangentModel:
    """Build the model at loop positions x (n, d) that keep the energy's constraint."""
    n, d = x.shape
    scale = np.repeat(np.sqrt(energy.weights), d)
    forces = energy.forces(x)
    weighted = sum(forces[1:], start=forces[0]).ravel() / scale
    rows = energy.constraint.jacobian(x)
    free = energy.free_motions(x)
    m = len(rows)
    normals = np.hstack([(rows / scale).T, free * scale[:, None]])
    q, r = np.linalg.qr(normals, mode="complete")
    tensions = -np.linalg.solve(r[:m, :m], q[:, :m].T @ weighted)
    forces.append((rows.T @ tensions).reshape(n, d))
    largest = max(float(np.abs(force).max()) for force in forces)
    # Not gradient + tension: along motions that cost a soap film nothing its mesh leaves a
    # discretisation error.
    basis = q[:, m + free.shape[1] :]
    unbalanced = basis @ (basis.T @ weighted) * scale
    hessian = energy.lagrangian_hessian(x, tensions)
    # One matrix for all coordinates, or one for the displacements of all of them.
    root = scale[:: d * n // len(hessian)]
    scaled = hessian / (root * root[:, None])
    projected = basis.T @ (scaled @ basis.reshape(len(scaled), -1)).reshape(d * n, -1)
    return TangentModel(
        x=x,
        tensions=tensions,
        residual=float(np.abs(unbalanced).max()) / largest,
        rounding=energy.rounding * float(np.abs(x).max()) / largest,
        basis=basis,
        gradient=basis.T @ weighted,
        hessian=0.5 * (projected + projected.T),
        scale=scale,
    )


def stability(model: TangentModel) -> Stability:
    """Return the spectrum at an equilibrium.

    The error bound is the backward error of the symmetric eigensolver and of the projected
    Hessian, a small multiple of eps |H|_2 (Weyl).
    """
    values = model.eigenvalues
    if len(values) == 0:
        return Stability(values, 0.0)
    eps = float(np.finfo(np.float64).eps)
    return Stability(values, 10 * eps * float(np.abs(values).max()))
