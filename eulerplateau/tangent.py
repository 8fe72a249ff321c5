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

from eulerplateau.inextensible import jacobian
from eulerplateau.loop import Loop
from eulerplateau.mesh import FloatArray

RIGID_MOTIONS = 6

# Row k is the matrix G_k with axis_k x r = r G_k.
TURNS = np.array(
    [
        [[0, 0, 0], [0, 0, 1], [0, -1, 0]],
        [[0, 0, -1], [0, 0, 0], [1, 0, 0]],
        [[0, 1, 0], [-1, 0, 0], [0, 0, 0]],
    ],
    dtype=np.float64,
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

    @cached_property
    def matrix(self) -> FloatArray:
        """A (n_b, n_b)."""
        total: FloatArray = self.bending + self.film
        return total

    @cached_property
    def force_rounding(self) -> float:
        """What rounding alone leaves of a force, per unit of position."""
        eps = float(np.finfo(np.float64).eps)
        return eps * float(np.abs(self.matrix).sum(axis=1).max())

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return E(x + step) - E(x) with the relative precision of the difference."""
        return float(np.sum(step * (self.matrix @ (x + 0.5 * step))))


@dataclass(frozen=True)
class TangentModel:
    """Second-order model of the condensed energy at a loop that keeps its lengths.

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
        step: FloatArray = (self.basis @ coefficients / self.scale).reshape(-1, 3)
        return step


def rigid_motions(x: FloatArray) -> FloatArray:
    """Return the three translations and three rotations of x (n, 3) as columns (3 n, 6)."""
    centred = x - x.mean(axis=0)
    motions = np.empty((len(x), 3, RIGID_MOTIONS))
    motions[:, :, :3] = np.eye(3)
    motions[:, :, 3:] = (centred @ TURNS).transpose(1, 2, 0)
    return motions.reshape(-1, RIGID_MOTIONS)


def tangent_model(energy: LoopEnergy, x: FloatArray) -> TangentModel:
    """Build the model at loop positions x (n_b, 3) that keep their lengths."""
    loop, n = energy.loop, len(x)
    scale = np.repeat(np.sqrt(loop.mean_lengths), 3)
    bending, film = loop.bending_force(x), energy.film @ x
    gradient = bending + film
    rows = jacobian(loop, x)
    normals = np.hstack([(rows / scale).T, rigid_motions(x) * scale[:, None]])
    q, r = np.linalg.qr(normals, mode="complete")
    weighted = gradient.ravel() / scale
    multipliers = -np.linalg.solve(r[:n, :n], q[:, :n].T @ weighted)
    tension = (rows.T @ multipliers).reshape(-1, 3)
    forces = max(float(np.abs(f).max()) for f in (bending, film, tension))
    basis = q[:, n + RIGID_MOTIONS :]
    hessian = lagrangian_hessian(energy, multipliers)
    root = scale[::3]
    scaled = hessian / (root * root[:, None])
    projected = basis.T @ (scaled @ basis.reshape(n, -1)).reshape(3 * n, -1)
    return TangentModel(
        x=x,
        multipliers=multipliers,
        residual=float(np.abs(gradient + tension).max()) / forces,
        rounding=energy.force_rounding * float(np.abs(x).max()) / forces,
        basis=basis,
        gradient=basis.T @ weighted,
        hessian=0.5 * (projected + projected.T),
        scale=scale,
    )


def lagrangian_hessian(energy: LoopEnergy, multipliers: FloatArray) -> FloatArray:
    """Return A + D^T diag(lambda / s) D (n_b, n_b)."""
    stress = multipliers / energy.loop.rest_lengths
    n = len(stress)
    hessian: FloatArray = energy.matrix + np.diag(stress + np.roll(stress, 1))
    v = np.arange(n)
    # Not hessian[i, j] -= ...: with three vertices an entry can occur twice.
    np.subtract.at(hessian, (v, (v + 1) % n), stress)
    np.subtract.at(hessian, ((v + 1) % n, v), stress)
    return hessian
