"""The condensed problem near one loop: gradient and Hessian on the tangent space.

With the film's interior eliminated the energy is tr(x_b^T A x_b) / 2, A = 2 (B + load S).
Where J p = 0 and p is no rigid motion, the Lagrangian's Hessian is

    (A + D^T diag(lambda / s) D) (x) I_3,     (D x)_v = x_{v+1} - x_v,

one n_b x n_b matrix for all three coordinates. Coordinates here are y = sqrt(<s>) x, so
that eigenvalues belong to the norm of integral |p|^2 ds and converge with the mesh; their
unit is alpha / L^4 times L, i.e. 1 for L = alpha = 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import (
    DENSE_LOOP,
    CondensedEnergy,
    Loop,
    free_motions,
    jacobian,
    stress_stiffness,
)


@dataclass(frozen=True)
class LoopEnergy:
    """The condensed energy of one load: E(x_b) = tr(x_b^T A x_b) / 2.

    Attributes
    ----------
    loop : rest lengths and bending
    bending, film : (n_b, n_b) float, 2 B and 2 load S
    """

    loop: Loop
    bending: FloatArray
    film: FloatArray

    @property
    def slides(self) -> bool:
        """Whether the loop may slide along itself: not where its rest mesh resists."""
        return False

    @cached_property
    def matrix(self) -> FloatArray:
        """A (n_b, n_b)."""
        total: FloatArray = self.bending + self.film
        return total

    @property
    def dense(self) -> bool:
        """Whether the loop is small enough for matrices of all its displacements."""
        return len(self.loop.rest_lengths) <= DENSE_LOOP

    @cached_property
    def force_rounding(self) -> float:
        """What rounding alone leaves of a force, per unit of position."""
        eps = float(np.finfo(np.float64).eps)
        return eps * float(np.abs(self.matrix).sum(axis=1).max())

    def film_force(self, x: FloatArray) -> FloatArray:
        """Return the gradient of the film's energy (n_b, 3)."""
        force: FloatArray = self.film @ x
        return force

    def lagrangian_hessian(self, x: FloatArray, multipliers: FloatArray) -> FloatArray:
        """Return A + D^T diag(lambda / s) D (n_b, n_b), the same for every coordinate."""
        return lagrangian_hessian(self, multipliers)

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return E(x + step) - E(x) with the relative precision of the difference."""
        return float(np.sum(step * (self.matrix @ (x + 0.5 * step))))

    def holds(self, x: FloatArray) -> bool:
        """Return whether x is a loop the energy was made for: always."""
        return True


@dataclass(frozen=True)
class TangentModel:
    """Second-order model of the condensed energy at a loop that keeps its lengths.

    Below for loops in space; of a plane loop (n_b, 2) the basis is (2 n_b, n_b - 3).

    Attributes
    ----------
    x : (n_b, 3) float
    multipliers : (n_b,) float
        Least-squares edge tensions lambda.
    residual : float
        |A x + J^T lambda|_inf over the largest of bending, film and tension force.
    rounding : float
        The residual that rounding alone can leave.
    basis : (3 n_b, 2 n_b - 6) float
        Orthonormal columns in the coordinates sqrt(<s>) x: J p = 0, no rigid motion.
    gradient : (2 n_b - 6,) float
    hessian : (2 n_b - 6, 2 n_b - 6) float
    """

    x: FloatArray
    multipliers: FloatArray
    residual: float
    rounding: float
    basis: FloatArray
    gradient: FloatArray
    hessian: FloatArray
    scale: FloatArray

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


def tangent_model(energy: CondensedEnergy, x: FloatArray) -> TangentModel:
    """Build the model at loop positions x (n_b, 3) that keep their lengths."""
    loop, (n, d) = energy.loop, x.shape
    scale = np.repeat(np.sqrt(loop.mean_lengths), d)
    bending, film = loop.bending_force(x), energy.film_force(x)
    gradient = bending + film
    rows = jacobian(loop, x)
    free = free_motions(loop, x, energy.slides)
    normals = np.hstack([(rows / scale).T, free * scale[:, None]])
    q, r = np.linalg.qr(normals, mode="complete")
    weighted = gradient.ravel() / scale
    multipliers = -np.linalg.solve(r[:n, :n], q[:, :n].T @ weighted)
    tension = (rows.T @ multipliers).reshape(n, d)
    forces = max(float(np.abs(f).max()) for f in (bending, film, tension))
    # Not gradient + tension: along motions that cost a soap film nothing its mesh leaves a
    # discretisation error.
    basis = q[:, n + free.shape[1] :]
    unbalanced = basis @ (basis.T @ weighted) * scale
    hessian = energy.lagrangian_hessian(x, multipliers)
    # One matrix for all coordinates, or one for the displacements of all of them.
    root = scale[:: d * n // len(hessian)]
    scaled = hessian / (root * root[:, None])
    projected = basis.T @ (scaled @ basis.reshape(len(scaled), -1)).reshape(d * n, -1)
    return TangentModel(
        x=x,
        multipliers=multipliers,
        residual=float(np.abs(unbalanced).max()) / forces,
        rounding=energy.force_rounding * float(np.abs(x).max()) / forces,
        basis=basis,
        gradient=basis.T @ weighted,
        hessian=0.5 * (projected + projected.T),
        scale=scale,
    )


def lagrangian_hessian(energy: LoopEnergy, multipliers: FloatArray) -> FloatArray:
    """Return A + D^T diag(lambda / s) D (n_b, n_b)."""
    hessian: FloatArray = energy.matrix + stress_stiffness(energy.loop, multipliers)
    return hessian
