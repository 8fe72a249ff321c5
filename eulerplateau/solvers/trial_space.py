"""What conjugate gradients vary, and what it does to a film's energy.

A film of fixed weights moves with all its vertices and is quadratic in them. A soap film's
vertices move along their normals, on top of how the mesh follows its loop (interior.py):
sliding costs nothing, and a descent along it would end in thin triangles. A film kept in
its plane has no unknowns but its loop's. Of both the loop is kept from sliding along
itself, which costs nothing either (motions.py).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film import AreaFilm, Film, LocalFilm, PlaneFilm, QuadraticFilm
from eulerplateau.loop import Loop, remove_sliding
from eulerplateau.loop.kernels import area_beyond_linear
from eulerplateau.mesh import Shape, polygon_gradient
from eulerplateau.solvers.problem import Problem


class TrialSpace(Protocol):
    """Displacements (n_v, 3) from a base shape, linear in m unknowns."""

    @property
    def size(self) -> int:
        """Number of unknowns m."""

    @property
    def springs(self) -> tuple[IntArray, FloatArray]:
        """Edges (k, 2) and weights (k,) of what is quadratic in the film's energy."""

    def lift(self, forces: FloatArray) -> FloatArray:
        """Return a field (n_v, 3) that does the work on displacements that `forces` do.

        `forces` (n_v, 3) as Film.forces has them, bending and tension added.
        """

    def displacement(self, unknown: FloatArray) -> FloatArray:
        """Return the displacement (n_v, 3) of unknowns (m,)."""

    def collect(self, gradient: FloatArray) -> FloatArray:
        """Return the derivatives (m,) by the unknowns, of a gradient (n_v, 3)."""

    def beyond_linear(self, moved: FloatArray, gradient: FloatArray) -> float:
        """Return what the rest of the film's energy gains, its linear part left out.

        Adds the gradient of that to `gradient` (n_v, 3).
        """

    def holds(self, moved: FloatArray) -> bool:
        """Return whether the film is still close enough to the base shape."""

    def reached(self, moved: FloatArray) -> Shape:
        """Return the shape that a displacement (n_v, 3) leads to."""

    @property
    def stiffness(self) -> FloatArray:
        """How a film at rest resists its loop (n_b, n_b): symmetric, nowhere negative.

        Near enough to the second derivative for variables.py, the same for each coordinate.
        """

    def varied(self, moves: FloatArray) -> FloatArray:
        """Return displacements of the loop (n_b, 3, k) less what is not varied of them."""

    def unfold(self, loop: FloatArray, inside: FloatArray) -> FloatArray:
        """Return the displacement (n_v, 3) of a film that follows its loop (n_b, 3).

        Plus what is varied inside (k,), in variables in which the film's stiffness is 1.
        """

    def fold(self, gradient: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives (n_b, 3) and (k,) by what `unfold` takes."""


def trial_space(problem: Problem, shape: Shape, load: float) -> TrialSpace:
    """Return the trial space at a shape that the film has `prepared`."""
    loop, film = problem.loop, problem.film
    match film:
        case QuadraticFilm():
            return _Everywhere(film, shape, load)
        case PlaneFilm():
            return _InPlane(loop, film.slide(loop, shape.x_loop), film, shape, load)
        case AreaFilm():
            local = film.of_loop(shape).local
            slide = film.slide(loop, shape.x_loop)
            return _AlongNormals(loop, slide, film, local, shape, load)
        case _:
            raise TypeError(f"conjugate gradients do not know how to vary {film}")


def kick_axis(film: Film) -> int:
    """Return the axis of the loop along which a kick is given: across its plane.

    Or along it where there is nothing else.
    """
    match film:
        case PlaneFilm():
            return 0
        case _:
            return 2


@dataclass(frozen=True)
class _Everywhere:
    film: QuadraticFilm
    shape: Shape
    load: float

    @property
    def size(self) -> int:
        return self.shape.x.size

    @property
    def springs(self) -> tuple[IntArray, FloatArray]:
        return self.film.edges, self.load * self.film.weights

    def lift(self, forces: FloatArray) -> FloatArray:
        return forces

    def displacement(self, unknown: FloatArray) -> FloatArray:
        return unknown.reshape(self.shape.x.shape)

    def collect(self, gradient: FloatArray) -> FloatArray:
        return gradient.ravel()

    def beyond_linear(self, moved: FloatArray, gradient: FloatArray) -> float:
        return 0.0

    def holds(self, moved: FloatArray) -> bool:
        return True

    def reached(self, moved: FloatArray) -> Shape:
        return self.shape.moved(self.shape.x + moved)

    @property
    def stiffness(self) -> FloatArray:
        return 2 * self.load * self.film.of_loop(self.shape).condensed.stiffness

    def varied(self, moves: FloatArray) -> FloatArray:
        return moves

    def unfold(self, loop: FloatArray, inside: FloatArray) -> FloatArray:
        own = inside.reshape(-1, 3) * _softness(2 * self.load)
        return self.film.of_loop(self.shape).condensed.unfold(loop, own)

    def fold(self, gradient: FloatArray) -> tuple[FloatArray, FloatArray]:
        loop, inside = self.film.of_loop(self.shape).condensed.fold(gradient)
        return loop, (inside * _softness(2 * self.load)).ravel()


def _softness(load: float) -> float:
    """Return the unit of displacement in which a film's stiffness, the load, is 1."""
    return 1 / float(np.sqrt(load)) if load > 0.0 else 1.0


@dataclass(frozen=True)
class _Sliding:
    """A film that only sees its loop's curve: `slide` (n_b, 3), None if that is rigid."""

    loop: Loop
    slide: FloatArray | None

    def varied(self, moves: FloatArray) -> FloatArray:
        """Return displacements of the loop without their part along `slide`."""
        if self.slide is None:
            return moves
        weights = self.loop.mean_lengths[:, None] * self.slide
        share = np.einsum("vd,vdk->k", weights, moves)
        kept: FloatArray = moves - self.slide[:, :, None] * share
        return kept

    def pulled(self, forces: FloatArray) -> FloatArray:
        """Return forces (n_b, 3) on the loop without what `varied` makes nothing of."""
        return remove_sliding(self.slide, self.loop, forces)

    @property
    def springs(self) -> tuple[IntArray, FloatArray]:
        return np.zeros((0, 2), dtype=np.int64), np.zeros(0)


@dataclass(frozen=True)
class _AlongNormals(_Sliding):
    film: AreaFilm
    local: LocalFilm
    shape: Shape
    load: float

    @property
    def size(self) -> int:
        film = self.film
        return 3 * len(film.loop) + len(film.interior)

    def lift(self, forces: FloatArray) -> FloatArray:
        film = self.film
        lifted = forces.copy()
        # The loop's forces have their share of those inside; the mesh that follows adds it.
        lifted[film.loop] += forces[film.loop] - self.local.carry(forces)
        return lifted

    def displacement(self, unknown: FloatArray) -> FloatArray:
        local, n = self.local, 3 * len(self.film.loop)
        moved = local.follow(self.varied(unknown[:n].reshape(-1, 3, 1))[:, :, 0])
        moved[self.film.interior] += unknown[n:, None] * local.normals
        return moved

    def collect(self, gradient: FloatArray) -> FloatArray:
        local = self.local
        along = (gradient[self.film.interior] * local.normals).sum(axis=1)
        return np.concatenate([self.pulled(local.carry(gradient)).ravel(), along])

    def beyond_linear(self, moved: FloatArray, gradient: FloatArray) -> float:
        local = self.local
        force = np.zeros_like(gradient)
        area = area_beyond_linear(moved, local.x, local.tiling.triangles, force)
        gradient += self.load * force
        return self.load * float(area)

    def holds(self, moved: FloatArray) -> bool:
        return self.local.holds(self.local.tiling.sides(self.local.x + moved))

    def reached(self, moved: FloatArray) -> Shape:
        return self.shape.moved(self.shape.x + moved)

    @property
    def stiffness(self) -> FloatArray:
        # Of Dirichlet's energy, which is the area where the map is conformal, else more.
        return self.load * self.local.follower.condensed.stiffness

    def unfold(self, loop: FloatArray, inside: FloatArray) -> FloatArray:
        local = self.local
        moved = local.follow(loop)
        still, inside = np.zeros((len(loop), 1)), _softness(self.load) * inside[:, None]
        heights = local.follower.condensed.unfold(still, inside)
        moved[self.film.interior] += heights[self.film.interior] * local.normals
        return moved

    def fold(self, gradient: FloatArray) -> tuple[FloatArray, FloatArray]:
        local = self.local
        along = np.zeros((len(gradient), 1))
        inside = gradient[self.film.interior]
        along[self.film.interior, 0] = (inside * local.normals).sum(axis=1)
        heights = local.follower.condensed.fold(along)[1][:, 0]
        return local.carry(gradient), _softness(self.load) * heights


@dataclass(frozen=True)
class _InPlane(_Sliding):
    film: PlaneFilm
    shape: Shape
    load: float

    @property
    def size(self) -> int:
        return 3 * len(self.shape.loop)

    def lift(self, forces: FloatArray) -> FloatArray:
        return forces

    def displacement(self, unknown: FloatArray) -> FloatArray:
        return self.unfold(self.varied(unknown.reshape(-1, 3, 1))[:, :, 0], unknown[:0])

    def collect(self, gradient: FloatArray) -> FloatArray:
        return self.film.flattened(self.pulled(gradient[self.shape.loop])).ravel()

    def beyond_linear(self, moved: FloatArray, gradient: FloatArray) -> float:
        # A polygon's area is quadratic in its corners.
        loop, axes = self.shape.loop, self.film.axes
        step = moved[loop] @ axes.T
        force = self.load * polygon_gradient(step)
        gradient[loop] += force @ axes
        return 0.5 * float(np.vdot(step, force))

    def holds(self, moved: FloatArray) -> bool:
        return True

    def reached(self, moved: FloatArray) -> Shape:
        # The mesh goes with its loop, for whoever looks at it.
        film = self.film.of_loop(self.shape)
        return film.shape(film.project((self.shape.x + moved)[self.shape.loop]))

    @property
    def stiffness(self) -> FloatArray:
        return np.zeros(2 * (len(self.shape.loop),))

    def varied(self, moves: FloatArray) -> FloatArray:
        in_plane = np.einsum("vdk,ad,ae->vek", moves, self.film.axes, self.film.axes)
        return super().varied(in_plane)

    def unfold(self, loop: FloatArray, inside: FloatArray) -> FloatArray:
        moved = np.zeros_like(self.shape.x)
        moved[self.shape.loop] = loop
        return moved

    def fold(self, gradient: FloatArray) -> tuple[FloatArray, FloatArray]:
        return gradient[self.shape.loop], np.zeros(0)
