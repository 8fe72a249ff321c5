"""Bringing a loop back to its rest lengths: the constraint's Jacobian and projection."""

from __future__ import annotations

import numpy as np

from eulerplateau.loop import Loop
from eulerplateau.mesh import FloatArray

# Gauss-Newton converges quadratically: a handful of steps from a nearby shape.
_PROJECTION_STEPS = 30
# Rescaling converges linearly, but from anywhere that is not a point.
_RESCALING_STEPS = 200


def jacobian(loop: Loop, x_loop: FloatArray) -> FloatArray:
    """Return J (n_b, 3 n_b): row v holds -e_v / s_v at vertex v and +e_v / s_v at v + 1."""
    n = len(x_loop)
    direction = loop.chords(x_loop) / loop.rest_lengths[:, None]
    rows = np.zeros((n, n, 3))
    v = np.arange(n)
    rows[v, v] = -direction
    rows[v, (v + 1) % n] = direction
    return rows.reshape(n, 3 * n)


def project_lengths(loop: Loop, x_loop: FloatArray) -> FloatArray | None:
    """Return the nearest loop (n_b, 3) that keeps its lengths, to rounding; None if lost.

    Gauss-Newton in the norm sum_v <s_v> |dx_v|^2.
    """
    mass = np.repeat(loop.mean_lengths, 3)
    x, error = x_loop, np.inf
    for _ in range(_PROJECTION_STEPS):
        excess = loop.constraint(x)
        previous, error = error, float(np.abs(excess / loop.rest_lengths).max())
        if not np.isfinite(error) or error > 1e3:
            return None
        # Quadratic convergence ends where rounding begins: then error stops falling.
        if error < 1e-15 or (error < 1e-12 and error >= 0.25 * previous):
            return x
        rows = jacobian(loop, x)
        weighted = rows / mass
        try:
            shift = weighted.T @ np.linalg.solve(weighted @ rows.T, excess)
        except np.linalg.LinAlgError:
            return None
        x = x - shift.reshape(-1, 3)
    return x if error < 1e-12 else None


def close_with_lengths(loop: Loop, x_loop: FloatArray) -> FloatArray | None:
    """Return a loop that keeps its lengths, from any start, however wrong its lengths.

    Alternates between giving each edge its length and spreading what the loop then fails
    to close by; ends with `project_lengths`.
    """
    s = loop.rest_lengths
    if loop.length_error(x_loop) < 0.1:
        near = project_lengths(loop, x_loop)
        if near is not None:
            return near
    x = x_loop
    for _ in range(_RESCALING_STEPS):
        chords = loop.chords(x)
        lengths = np.linalg.norm(chords, axis=1)
        if not lengths.all():
            return None
        edges = chords * (s / lengths)[:, None]
        edges -= np.outer(s, edges.sum(axis=0)) / s.sum()
        x = x[0] + np.concatenate([np.zeros((1, 3)), np.cumsum(edges, axis=0)[:-1]])
        if loop.length_error(x) < 1e-3:
            break
    return project_lengths(loop, x - x.mean(axis=0) + x_loop.mean(axis=0))
