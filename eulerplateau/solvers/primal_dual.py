"""Newton's method on positions and tensions together: the fast end of a solve.

The equations at a loop x (n_b, 3) with tensions lambda (n_b,) are

    [ H (x) I_3   J^T ] [ p  ]     [ R ]      R = A x + J^T lambda = H x,
    [ J            0  ] [ mu ]  = -[ c ],     H = A + D^T diag(lambda / s) D,

J having the rows E_v = e_v / s_v times the difference D. H is one n_b x n_b matrix for all
three coordinates, so the constraints' Schur complement is an elementwise product,

    J (H^-1 (x) I_3) J^T = (D H^-1 D^T) o (E E^T),

and a step costs one inverse and one solve of the loop's size. But at an equilibrium
H x = 0:
H is singular along 1, x, y, z. With U an orthonormal basis of these, H + rho U U^T is
inverted instead, and Y = U^T p joins the unknowns to undo it (Woodbury); the translations
drop out, and the rotations, which cost nothing, are held.

shifted_inverse.py does the same algebra with the inertia counted; without it a step takes
half the time, and a sweep consists of such steps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.interruption import heed
from eulerplateau.loop import TURNS, Loop, LoopEnergy, backward_differences, differences
from eulerplateau.solvers.equilibrium import Settled

# Deflation strength over the mean diagonal of H: between its soft and its stiff modes.
_DEFLATION = 1e-3
_LIMIT = 12
# Fewer loop vertices have fewer degrees of freedom than U has columns to spare.
_SMALLEST_LOOP = 8


@dataclass(frozen=True)
class _Balance:
    """What is left of the equations: forces R (n_b, 3), lengths c (n_b,), both relative."""

    forces: FloatArray
    excess: FloatArray
    error: float
    rounding: float


def settle(
    energy: LoopEnergy,
    loop: Loop,
    matrix: FloatArray,
    x: FloatArray,
    tensions: FloatArray,
    limit: int,
    observe: Callable[[FloatArray], None],
) -> Settled | None:
    """Return the equilibrium next to x (n_b, 3), stable or not; None if none is reached.

    Quadratically convergent, and only locally: the caller checks what it came to. Takes at
    most `limit` steps and shows the loop to `observe` after each.

    Parameters
    ----------
    energy : bending and a film of fixed weights, of a loop that keeps its lengths
    matrix : (n_b, n_b) float, A, its constant second derivative
    x, tensions : (n_b, 3) and (n_b,) float, where it starts
    """
    if len(x) < _SMALLEST_LOOP:
        return None
    balance = _balance(energy, loop, x, tensions)
    for iteration in range(min(limit, _LIMIT) + 1):
        heed()
        if balance.error <= balance.rounding:
            return Settled(x, tensions, iteration)
        if iteration == limit:
            break
        try:
            step, tension = _step(loop, matrix, x, tensions, balance)
        except np.linalg.LinAlgError:
            return None
        x, tensions = x + step, tensions + tension
        observe(x)
        after = _balance(energy, loop, x, tensions)
        if not after.error < max(1.0, 10 * balance.error):
            return None
        # Quadratic convergence ends where rounding begins: then the error stops falling.
        if after.error < 1e-10 and after.error > 0.25 * balance.error:
            return Settled(x, tensions, iteration + 1)
        balance = after
    return None


def _balance(
    energy: LoopEnergy, loop: Loop, x: FloatArray, tensions: FloatArray
) -> _Balance:
    parts = [*energy.forces(x), loop.tension_force(x, tensions)]
    scale = max(float(np.abs(part).max()) for part in parts)
    forces, excess = sum(parts[1:], start=parts[0]), loop.constraint(x)
    error = max(
        float(np.abs(forces).max()) / scale,
        float(np.abs(excess / loop.rest_lengths).max()),
    )
    rounding = max(energy.rounding * float(np.abs(x).max()) / scale, 1e-15)
    return _Balance(forces, excess, error, rounding)


def _step(
    loop: Loop,
    matrix: FloatArray,
    x: FloatArray,
    tensions: FloatArray,
    balance: _Balance,
) -> tuple[FloatArray, FloatArray]:
    """Return the Newton step: displacement (n_b, 3) and change of the tensions (n_b,)."""
    n = len(x)
    edges = loop.chords(x) / loop.rest_lengths[:, None]
    hessian = matrix + loop.tension_stiffness(tensions)
    rho = _DEFLATION * float(np.trace(hessian)) / n
    soft = np.linalg.qr(np.column_stack([np.ones(n), x]))[0]
    inverse: FloatArray = np.linalg.inv(hessian + rho * (soft @ soft.T))
    soft = soft[:, 1:]  # without the translation, along which nothing pulls
    from_soft, from_forces = inverse @ soft, inverse @ balance.forces
    system = np.zeros((n + 9, n + 9))
    system[:n, :n] = differences(differences(inverse).T) * (edges @ edges.T)
    coupling = -rho * (differences(from_soft)[:, :, None] * edges[:, None, :])
    system[:n, n:] = coupling.reshape(n, 9)
    system[n:, :n] = system[:n, n:].T
    response = rho * (rho * (soft.T @ from_soft) - np.eye(3))
    turns = _rotations(x, soft)
    system[n:, n:] = np.kron(response, np.eye(3)) - rho * (turns @ turns.T)
    stretch = np.sum(edges * differences(from_forces), axis=1)
    known = np.append(balance.excess - stretch, rho * (soft.T @ from_forces))
    found: FloatArray = np.linalg.solve(system, known)
    tension, share = found[:n], found[n:].reshape(3, 3)
    pull = balance.forces - backward_differences(tension[:, None] * edges)
    return inverse @ (rho * (soft @ share) - pull), tension


def _rotations(x: FloatArray, soft: FloatArray) -> FloatArray:
    """Return the three rotations as unit columns (9, 3) in the unknowns Y = U^T p."""
    shape = soft.T @ (x - x.mean(axis=0))
    columns = (shape @ TURNS).reshape(3, 9).T
    unit: FloatArray = columns / np.linalg.norm(columns, axis=0)
    return unit
