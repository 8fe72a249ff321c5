"""The second-order model for large loops: a subspace instead of the whole tangent space.

The model of second_variation.py is dense, and its cost grows as (3 n_b)^3. Here the same
model is set up on a small subspace, which (C + tau)^-1 spans from the forces and from a
random field (shifted_inverse.py), with tau above minus the lowest eigenvalue. From the
forces come the steps of every trust region, Newton's first of all; from the random field
the modes in which the forces have no part, such as the ways off a saddle.
"""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.loop import Loop, LoopEnergy
from eulerplateau.solvers.equilibrium import Stability
from eulerplateau.solvers.large_loops.shifted_inverse import (
    ShiftedInverse,
    TangentSpace,
    shifted_inverse,
    tangent_space,
)
from eulerplateau.solvers.second_variation import TangentModel
from eulerplateau.solvers.tangent_coordinates import Columns

# Shift where nothing is unstable: well below the lowest bending modes, 2 (2 pi n)^4.
_SHIFT = 30.0
# How often (C + tau)^-1 is applied for a model: steps are exact to a factor (tau / w)^6
# in modes of stiffness w.
_DEPTH = 6
_ROUNDS = 20
# Eigenvalues below -tau that a subspace for steps can do with.
_FEW = 8
# A column that loses this much of itself to the columns before it adds only rounding.
_DEPENDENT = 1e-10


def subspace_model(
    energy: LoopEnergy,
    loop: Loop,
    matrix: FloatArray,
    x: FloatArray,
    before: TangentModel | None = None,
) -> TangentModel:
    """Build the model at loop positions x (n_b, 3) that keep their lengths.

    Its basis (3 n_b, m) spans a part of the tangent space. The model `before`, of a loop
    near by, says which shift to try first. `matrix` (n_b, n_b) is the energy's constant
    second derivative, the same for all coordinates.
    """
    space = tangent_space(loop, x)
    parts = energy.forces(x)
    gradient = sum(parts[1:], start=parts[0])
    tensions = -space.metric.solve(space.stretch(_weighted(space, gradient)))[:, 0]
    tension = loop.tension_force(x, tensions)
    forces = max(float(np.abs(f).max()) for f in (*parts, tension))
    imbalance = gradient + tension
    operator = _weighted_hessian(loop, matrix, space, tensions)
    lowest = 0.0 if before is None else float(before.eigen[0][0])
    inverse = _inverse(space, operator, lowest, _FEW)
    slope = space.project(_weighted(space, imbalance))
    start = np.concatenate([slope, _random_fields(len(x), 1)], axis=2)
    # The slope itself is the best of short steps, which any trust region may come to.
    basis = _krylov(inverse, start, _DEPTH, slope)
    return TangentModel(
        x=x,
        weights=energy.weights,
        tensions=tensions,
        residual=float(np.abs(imbalance).max()) / forces,
        rounding=0.25 * energy.rounding * float(np.abs(x).max()) / forces,
        coordinates=Columns(basis, np.repeat(space.root, 3)),
        gradient=basis.T @ slope.ravel(),
        hessian=_on_basis(operator, basis),
    )


def lowest_modes(
    loop: Loop, matrix: FloatArray, model: TangentModel
) -> tuple[Stability, FloatArray]:
    """Return the lowest eigenvalues at a model's loop, and their modes (3 n_b, m).

    Modes are in the model's coordinates. All unstable and neutral eigenvalues are among
    them, counted by inertia, and at least one that is neither.
    """
    space = tangent_space(loop, model.x)
    operator = _weighted_hessian(loop, matrix, space, model.tensions)
    eps = float(np.finfo(np.float64).eps)
    bound = 10 * eps * float(np.abs(operator).sum(axis=1).max())
    inverse = shifted_inverse(space, operator, -bound)
    doubtful = inverse.n_below
    if doubtful:
        inverse = _inverse(space, operator, float(model.eigen[0][0]), 0)
    wanted = min(doubtful + 1, 2 * len(model.x) - 6)
    modes = model.modes(model.eigen[1][:, : wanted + 2])
    values = np.full(wanted, np.inf)
    for _ in range(_ROUNDS):
        known = modes.reshape(len(model.x), 3, -1)
        fresh = _random_fields(len(model.x), max(1, wanted + 3 - known.shape[2]))
        basis = _krylov(inverse, np.concatenate([known, fresh], axis=2), 2)
        ritz, vectors = np.linalg.eigh(_on_basis(operator, basis))
        modes = basis @ vectors[:, : wanted + 2]
        fallen = float(np.abs(values - ritz[:wanted]).max())
        values = ritz[:wanted]
        if fallen <= 0.1 * bound and int(np.sum(values <= bound)) == doubtful:
            break
    return Stability(values, bound), modes[:, :wanted]


def _weighted(space: TangentSpace, force: FloatArray) -> FloatArray:
    """Return a force (n_b, 3) as a field (n_b, 3, 1) in the coordinates sqrt(<s>) x."""
    field: FloatArray = (force / space.root[:, None])[:, :, None]
    return field


def _weighted_hessian(
    loop: Loop, matrix: FloatArray, space: TangentSpace, tensions: FloatArray
) -> FloatArray:
    """Return C (n_b, n_b), the Lagrangian's Hessian in the coordinates sqrt(<s>) x."""
    hessian = matrix + loop.tension_stiffness(tensions)
    hessian /= space.root
    hessian /= space.root[:, None]
    return hessian


def _inverse(
    space: TangentSpace, operator: FloatArray, lowest: float, allowed: int
) -> ShiftedInverse:
    """Return (C + tau)^-1, tau > -`lowest`, a guess, with `allowed` eigenvalues below."""
    shift = _SHIFT + 1.5 * max(0.0, -lowest)
    while (inverse := shifted_inverse(space, operator, shift)).n_below > allowed:
        shift *= 8
    return inverse


def _random_fields(n: int, m: int) -> FloatArray:
    return np.random.default_rng(n).standard_normal((n, 3, m))


def _on_basis(operator: FloatArray, basis: FloatArray) -> FloatArray:
    """Return the matrix of C (x) I_3 on orthonormal columns (3 n_b, m)."""
    moved = (operator @ basis.reshape(len(operator), -1)).reshape(basis.shape)
    matrix: FloatArray = basis.T @ moved
    return 0.5 * (matrix + matrix.T)


def _krylov(
    inverse: ShiftedInverse, start: FloatArray, depth: int, first: FloatArray | None = None
) -> FloatArray:
    """Return orthonormal columns (3 n_b, m) that span (C + tau)^-j start, j = 1 ... depth.

    And, if given, the `first` tangent fields.
    """
    basis = np.empty((3 * len(start), 0))
    if first is not None:
        basis = _with(inverse.space, basis, first)
    block = start
    for _ in range(depth):
        known = basis.shape[1]
        basis = _with(inverse.space, basis, inverse.solve(block))
        block = basis[:, known:].reshape(*start.shape[:2], -1)
    return basis


def _with(space: TangentSpace, basis: FloatArray, fields: FloatArray) -> FloatArray:
    """Return the orthonormal columns (3 n_b, m) with what `fields` (n_b, 3, k) add."""
    columns = fields.reshape(len(basis), -1)
    size = np.linalg.norm(columns, axis=0)
    columns = columns[:, size > 0] / size[size > 0]
    for _ in range(2):
        columns = columns - basis @ (basis.T @ columns)
    columns, r = np.linalg.qr(columns)
    columns = columns[:, np.abs(np.diag(r)) > _DEPENDENT]
    # Once more: what little was left of a column may have lost its direction.
    columns = space.project(columns.reshape(*fields.shape[:2], -1)).reshape(len(basis), -1)
    columns = columns - basis @ (basis.T @ columns)
    return np.hstack([basis, columns / np.linalg.norm(columns, axis=0)])
