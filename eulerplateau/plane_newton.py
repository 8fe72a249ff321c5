"""Newton for a film kept in its plane: all that moves is a polygon, and all is local.

The Lagrangian's Hessian couples a vertex to two neighbours on either side, and each length
to its two ends, so a step of

    [ H   J^T  R ] [ p  ]     [ g + J^T lambda ]
    [ J   0    0 ] [ mu ] = - [ c              ]
    [ R^T 0    0 ] [ r  ]     [ 0              ]

costs O(n_b); R are the rigid motions and the loop's sliding along itself. Far from an
equilibrium it has no sense of direction: there a coarse loop is brought to a minimum first
(descent.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from eulerplateau.descent import Descent, State
from eulerplateau.inextensible import close_with_lengths, length_metric, project_lengths
from eulerplateau.loop import Loop
from eulerplateau.mesh import FloatArray, IntArray
from eulerplateau.motions import free_motions, sliding, without
from eulerplateau.plane_energy import PlaneEnergy
from eulerplateau.plane_film import polygon_gradient

# Loop vertices of the coarse loop.
COARSE = 64
_LIMIT = 20
# What is settled on lies this close to where it was started (in L).
_NEAR = 0.1


@dataclass(frozen=True)
class Flat:
    """A polygon (n_b, 2) in equilibrium, its edge tensions (n_b,), and the steps taken."""

    x: FloatArray
    multipliers: FloatArray
    iterations: int


def settle_in_plane(energy: PlaneEnergy, x: FloatArray, limit: int) -> Flat | None:
    """Return the equilibrium next to x (n_b, 2), stable or not; None if none is reached."""
    loop = energy.loop
    multipliers = _tensions(energy, x)
    error = np.inf
    for iteration in range(min(limit, _LIMIT) + 1):
        parts = (
            loop.bending_force(x),
            energy.load * polygon_gradient(x),
            loop.tension_force(x, multipliers),
        )
        slide = sliding(loop, x)
        forces = without(slide, loop, parts[0] + parts[1] + parts[2])
        excess = loop.constraint(x)
        scale = max(float(np.abs(part).max()) for part in parts)
        before = error
        error = max(
            float(np.abs(forces).max()) / scale,
            float(np.abs(excess / loop.rest_lengths).max()),
        )
        if not np.isfinite(error) or error > 10 * max(before, 1.0):
            return None
        # Quadratic convergence ends where rounding begins: then the error stops falling.
        rounding = energy.force_rounding * float(np.abs(x).max()) / scale
        if error < 1e-15 or (error < max(1e-9, 1e3 * rounding) and error > 0.25 * before):
            return Flat(x, multipliers, iteration)
        step, tension = _step(energy, x, multipliers, forces, excess)
        x, multipliers = x + step, multipliers + tension
    return None


def coarse_minimum(
    energy: PlaneEnergy,
    x: FloatArray,
    max_iterations: int,
    observe: Callable[[FloatArray], None],
) -> tuple[State, FloatArray] | None:
    """Return the minimum of a coarse loop near x (n_b, 2), and it on the fine loop."""
    from scipy.interpolate import CubicSpline

    n = len(x)
    arc = np.concatenate([[0.0], np.cumsum(energy.loop.rest_lengths)])
    kept = np.linspace(0, n, COARSE + 1).astype(np.int64)
    loop = Loop(np.diff(arc[kept]))
    start = close_with_lengths(loop, x[kept[:-1]])
    if start is None:
        return None
    coarse = Descent(PlaneEnergy(loop, energy.load), max_iterations, observe)
    state, _ = coarse.run(start)
    closed = np.concatenate([state.model.x, state.model.x[:1]])
    smooth = CubicSpline(arc[kept], closed, bc_type="periodic")(arc[:-1])
    fine = project_lengths(energy.loop, smooth)
    return None if fine is None else (state, fine)


def _tensions(energy: PlaneEnergy, x: FloatArray) -> FloatArray:
    """Return the edge tensions (n_b,) that balance the forces at x best."""
    loop = energy.loop
    force = loop.bending_force(x) + energy.film_force(x)
    eased = force / loop.mean_lengths[:, None]
    direction = loop.chords(x) / loop.rest_lengths[:, None]
    stretch = (direction * (np.roll(eased, -1, axis=0) - eased)).sum(axis=1)
    return -length_metric(loop, x).solve(stretch)


def _step(
    energy: PlaneEnergy,
    x: FloatArray,
    multipliers: FloatArray,
    forces: FloatArray,
    excess: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    n = len(x)
    matrix = _system(energy, x, multipliers)
    known = -np.concatenate([forces.ravel(), excess, np.zeros(matrix.shape[0] - 3 * n)])
    found = splu(matrix).solve(known)
    return found[: 2 * n].reshape(n, 2), found[2 * n : 3 * n]


def _system(energy: PlaneEnergy, x: FloatArray, multipliers: FloatArray) -> csc_array:
    """Return the matrix of a step; vertex v has the rows 2 v and 2 v + 1."""
    n, loop = len(x), energy.loop
    s, mean = loop.rest_lengths, loop.mean_lengths
    v: IntArray = np.arange(n, dtype=np.int64)
    after, before = (v + 1) % n, v - 1
    # Bending: the turn at v is a combination of x_{v-1}, x_v, x_{v+1}.
    back = 1 / np.roll(s, 1)
    turn = np.stack([back, -(back + 1 / s), 1 / s], axis=1)
    around = np.stack([before % n, v, after], axis=1)
    bend = 2 * turn[:, :, None] * turn[:, None, :] / mean[:, None, None]
    stress = multipliers / s
    ends = np.stack([v, after], axis=1)
    pull = stress[:, None, None] * np.array([[1.0, -1.0], [-1.0, 1.0]])
    parts: list[tuple[IntArray, IntArray, FloatArray]] = []

    def add(row: IntArray, column: IntArray, value: FloatArray) -> None:
        parts.append((np.ravel(row), np.ravel(column), np.ravel(value)))

    for d in (0, 1):
        for place, block in ((around, bend), (ends, pull)):
            row = np.broadcast_to(2 * place[:, :, None] + d, block.shape)
            add(row, row.transpose(0, 2, 1), block)
    half = np.full(n, 0.5 * energy.load)
    for i, j, value in ((v, after, half), (after, v, -half)):
        add(2 * i, 2 * j + 1, value)
        add(2 * j + 1, 2 * i, value)
    direction = loop.chords(x) / s[:, None]
    for place, sign in ((v, -1.0), (after, 1.0)):
        for d in (0, 1):
            add(2 * n + v, 2 * place + d, sign * direction[:, d])
            add(2 * place + d, 2 * n + v, sign * direction[:, d])
    free = free_motions(loop, x, slides=True)
    where = np.broadcast_to(3 * n + np.arange(free.shape[1]), free.shape)
    position = np.broadcast_to(np.arange(2 * n)[:, None], free.shape)
    add(position, where, free)
    add(where, position, free)
    row, column, value = (np.concatenate(part) for part in zip(*parts, strict=True))
    size = 3 * n + free.shape[1]
    return csc_array((value, (row, column)), shape=(size, size))
