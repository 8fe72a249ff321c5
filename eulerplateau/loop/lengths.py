"""How a loop is kept inextensible: the lengths' Jacobian, metric and projection."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.loop.loop import Loop
from eulerplateau.loop.turns import EdgeTurns, LengthMetric, edge_turns

# Gauss-Newton converges quadratically: a handful of steps from a nearby shape.
_PROJECTION_STEPS = 30
# Above this ratio of the longest to the shortest edge, edges are turned one by one.
_UNEVEN = 5.0
_EPS = float(np.finfo(np.float64).eps)
# The gap, in units of L, at which a loop is closed; and how short u + g may become.
_CLOSED = 1e-15
_OPPOSITE = 1e-6
# Rescaling converges linearly, but from anywhere that is not a point.
_RESCALING_STEPS = 200


def jacobian(loop: Loop, x_loop: FloatArray) -> FloatArray:
    """Return J (n_b, d n_b): row v holds -e_v / s_v at vertex v and +e_v / s_v at v + 1.

    For loops (n_b, d), d = 3, or 2 in a plane.
    """
    n, d = x_loop.shape
    direction = loop.chords(x_loop) / loop.rest_lengths[:, None]
    rows = np.zeros((n, n, d))
    v = np.arange(n)
    rows[v, v] = -direction
    rows[v, (v + 1) % n] = direction
    return rows.reshape(n, d * n)


def project_lengths(loop: Loop, x_loop: FloatArray) -> FloatArray | None:
    """Return the nearest loop (n_b, d) that keeps its lengths, to rounding; None if lost.

    Gauss-Newton in the norm sum_v <s_v> |dx_v|^2. Next to a much longer edge, what corrects
    that one's length would throw a short one about: loops of very uneven edges keep each
    edge's direction instead, as well as they can and still close.
    """
    if is_uneven(loop):
        return _turn_edges(loop, x_loop)
    mass = loop.mean_lengths[:, None]
    x, error, s, small = x_loop, np.inf, loop.rest_lengths, _rounded(loop, x_loop)
    for _ in range(_PROJECTION_STEPS):
        chords = loop.chords(x)
        excess = loop.excess(np.sqrt(np.vecdot(chords, chords)))
        previous, error = error, float(np.abs(excess / s).max())
        if not np.isfinite(error) or error > 1e3:
            return None
        # Quadratic convergence ends where rounding begins: then error stops falling.
        if error < 1e-15 or (error < small and error >= 0.25 * previous):
            return x
        metric = LengthMetric(chords / s[:, None], loop.mean_lengths)
        try:
            pull = metric.solve(excess)
        except LinAlgError:
            return None
        x = x - metric.force(pull) / mass
    return x if error < small else None


def quickly_projected(loop: Loop, x_loop: FloatArray) -> FloatArray | None:
    """Return the same by compiled loops, of a loop whose film needs them anyway."""
    if is_uneven(loop):
        return _turn_edges(loop, x_loop)
    from eulerplateau.loop.slide_kernels import give_lengths  # not for springs

    x, small = x_loop.copy(), _rounded(loop, x_loop)
    kept = give_lengths(x, loop.rest_lengths, loop.mean_lengths, small, _PROJECTION_STEPS)
    return x if kept else None


def _rounded(loop: Loop, x_loop: FloatArray) -> float:
    """Return the relative error of lengths from which on it is rounding's."""
    # What rounding of the positions leaves of a short edge's length.
    rounding = 4 * _EPS * float(np.abs(x_loop).max() / loop.rest_lengths.min())
    return max(1e-12, rounding)


def is_uneven(loop: Loop) -> bool:
    """Return whether some edges are so much longer than others that rounding tells."""
    return bool(loop.rest_lengths.max() > _UNEVEN * loop.rest_lengths.min())


def _turn_edges(loop: Loop, x_loop: FloatArray) -> FloatArray | None:
    """Return the loop whose edges s_v (u_v + g) / |u_v + g| close; None if lost.

    u_v are the given edges' unit vectors. The vector g that closes the loop is where the
    convex function sum_v s_v |u_v + g| is least; found by Newton's method.
    """
    s, chords = loop.rest_lengths, loop.chords(x_loop)
    lengths = np.linalg.norm(chords, axis=1)
    if not (np.isfinite(lengths).all() and lengths.all()):
        return None
    if float(np.abs(lengths / s - 1).max()) < _CLOSED:
        return x_loop
    given = chords / lengths[:, None]
    shift, gap = np.zeros(chords.shape[1]), np.inf
    for _ in range(_PROJECTION_STEPS):
        turned = given + shift
        size = np.linalg.norm(turned, axis=1)
        if size.min() < _OPPOSITE:
            return None
        turned /= size[:, None]
        closure = s @ turned
        gap, before = float(np.abs(closure).max()), gap
        if gap < _CLOSED or (gap < 10 * _CLOSED and gap >= 0.25 * before):
            edges = s[:, None] * turned
            x = np.concatenate([np.zeros_like(edges[:1]), np.cumsum(edges, axis=0)[:-1]])
            x += loop.mean_lengths @ (x_loop - x) / loop.mean_lengths.sum()
            return x
        pull = s / size
        across = pull.sum() * np.eye(len(shift)) - (pull[:, None] * turned).T @ turned
        try:
            shift = shift - np.linalg.solve(across, closure)
        except np.linalg.LinAlgError:
            return None
    return None


def close_with_lengths(
    loop: Loop,
    x_loop: FloatArray,
    projected: Callable[[Loop, FloatArray], FloatArray | None] = project_lengths,
) -> FloatArray | None:
    """Return a loop that keeps its lengths, from any start, however wrong its lengths.

    Alternates between giving each edge its length and spreading what the loop then fails
    to close by; ends with what is `projected`.
    """
    s = loop.rest_lengths
    if loop.length_error(x_loop) < 0.1:
        near = projected(loop, x_loop)
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
        x = x[0] + np.concatenate([np.zeros_like(edges[:1]), np.cumsum(edges, axis=0)[:-1]])
        if loop.length_error(x) < 1e-3:
            break
    return projected(loop, x - x.mean(axis=0) + x_loop.mean(axis=0))


@dataclass(frozen=True)
class Lengths:
    """Every edge keeps its length: c_v = (|e_v|^2 - s_v^2) / (2 s_v)."""

    loop: Loop

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Return J (n, d n): see the function of that name."""
        return jacobian(self.loop, x)

    def force(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return J^T tensions (n, d)."""
        return self.loop.tension_force(x, tensions)

    def stiffness(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return D^T diag(tensions / s) D (n, n)."""
        return self.loop.tension_stiffness(tensions)

    def project(self, x: FloatArray) -> FloatArray | None:
        """Return the nearest loop that keeps its lengths."""
        return project_lengths(self.loop, x)

    def turns(self, x: FloatArray) -> EdgeTurns | None:
        """Return the turns of the edges; None of very uneven ones.

        A Gram matrix loses the turns of short edges among those of long ones.
        """
        return None if is_uneven(self.loop) else edge_turns(self.loop, x)

    def split_stiffness(
        self, x: FloatArray, tensions: FloatArray
    ) -> tuple[FloatArray | None, FloatArray]:
        """Return nothing by positions, and tensions / s (n,) by edges."""
        return None, tensions / self.loop.rest_lengths


class FilmLengths(Lengths):
    """The same of a loop whose film needs compiled loops anyway: it makes use of them."""

    def project(self, x: FloatArray) -> FloatArray | None:
        """Return the nearest loop that keeps its lengths."""
        return quickly_projected(self.loop, x)


class Unconstrained:
    """No equation at all: the loop's length is free."""

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Return no rows (0, d n)."""
        return np.zeros((0, x.size))

    def force(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return no force (n, d)."""
        return np.zeros_like(x)

    def stiffness(self, x: FloatArray, tensions: FloatArray) -> FloatArray:
        """Return no stiffness (n, n)."""
        return np.zeros((len(x), len(x)))

    def project(self, x: FloatArray) -> FloatArray | None:
        """Return the loop itself."""
        return x

    def turns(self, x: FloatArray) -> None:
        """Return None: edges are not kept by turning."""

    def split_stiffness(
        self, x: FloatArray, tensions: FloatArray
    ) -> tuple[FloatArray | None, FloatArray]:
        """Return no stiffness."""
        return None, np.zeros(0)
