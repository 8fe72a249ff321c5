"""A soap film on a smooth loop: what its area is to O(h^4), next to a film of triangles.

A flat one is the area that its loop encloses. Of a curved one the triangles are curved as
well (curved_triangles.py). Inside, its nodes follow the loop and move along normals of the
plane triangles, as these films' vertices do (interior.py). Newton's equations are solved by
conjugate gradients: a displacement is that of the corners, linear between them, plus what
middles have beyond it. The first is preconditioned with the triangles' factorised interior,
the second with its diagonal; the condition of such a splitting does not depend on the mesh
(Axelsson and Gustafsson 1983).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film.area import AreaOfLoop
from eulerplateau.film.curved_triangles import CurvedFilm, CurvedTriangles
from eulerplateau.film.elimination import summed
from eulerplateau.film.interior import FilmAtRest
from eulerplateau.loop import SplineLoop
from eulerplateau.mesh import unit

# The forces along normals, as a part of the largest on a node, of a film at rest.
_AT_REST = 1e-10
# Newton steps to rest; what part of these forces one leaves; how many iterations it takes.
_STEPS, _LEFT, _ITERATIONS = 12, 1e-3, 100


@dataclass(frozen=True)
class SmoothFilmAtRest:
    """A film at rest on a smooth loop.

    Attributes
    ----------
    area : float
    gradient : (6, n_b, 3) float, of its area by the loop's data
    heights : (size,) float, of its nodes over where they follow the loop: to begin the next
    """

    area: float
    gradient: FloatArray
    heights: FloatArray


class SmoothFilm(Protocol):
    """The films on smooth loops next to a film of triangles."""

    def at_rest(
        self, loop: SplineLoop, before: SmoothFilmAtRest | None
    ) -> SmoothFilmAtRest:
        """Return the film on a loop, one on a loop near by being known."""

    def vertices(self, loop: SplineLoop, found: SmoothFilmAtRest) -> FloatArray:
        """Return the vertices (n_v, 3) of a film that was found on a loop."""


def smooth_film(film: AreaOfLoop, x_loop: FloatArray) -> SmoothFilm:
    """Return the films on smooth loops next to that of triangles on a loop (n_b, 3)."""
    plane = film.local.relax(x_loop)
    return FlatFilm(plane) if film.flat_at(x_loop) else CurvedNeighbour(plane)


@dataclass(frozen=True)
class FlatFilm:
    """Films in a plane: all there is to know is the loop."""

    plane: FilmAtRest

    def at_rest(
        self, loop: SplineLoop, before: SmoothFilmAtRest | None
    ) -> SmoothFilmAtRest:
        """Return the film on a loop."""
        spanned = loop.spanned
        area = float(np.linalg.norm(spanned))
        gradient = loop.spanned_gradient(spanned / area)
        return SmoothFilmAtRest(area, gradient, np.zeros(0))

    def vertices(self, loop: SplineLoop, found: SmoothFilmAtRest) -> FloatArray:
        """Return vertices (n_v, 3) that follow the loop: they may lie anywhere."""
        return _following(self.plane, loop)


@dataclass(frozen=True)
class CurvedNeighbour:
    """Films of curved triangles next to one of plane ones."""

    plane: FilmAtRest

    @cached_property
    def triangles(self) -> CurvedTriangles:
        """Its triangles, with middles."""
        tiling = self.plane.local.tiling
        return CurvedTriangles.of(tiling.triangles, tiling.loop, tiling.n_v)

    @cached_property
    def normals(self) -> FloatArray:
        """Along which nodes (size, 3) move; zero on the loop."""
        tiling = self.plane.local.tiling
        at_corners = tiling.vertex_normals(self.plane.sides)
        at_corners[self._inside] = self.plane.local.normals
        normals = unit(self.triangles.spread(at_corners))
        return normals * self.triangles.is_inside[:, None]

    def at_rest(
        self, loop: SplineLoop, before: SmoothFilmAtRest | None
    ) -> SmoothFilmAtRest:
        """Return the film on a loop. Raises LinAlgError if it does not come to rest."""
        base = self.triangles.spread(_following(self.plane, loop))
        base[self._middles] = loop.middles
        heights = np.zeros(self.triangles.size) if before is None else before.heights
        for _ in range(_STEPS):
            film = self.triangles.at(base + heights[:, None] * self.normals)
            forces = (film.gradient * self.normals).sum(axis=1)
            if np.abs(forces).max() <= _AT_REST * np.abs(film.gradient).max():
                return self._found(loop, film, heights)
            heights = heights + self._step(film, -forces)
        raise LinAlgError("the curved film does not come to rest")

    def vertices(self, loop: SplineLoop, found: SmoothFilmAtRest) -> FloatArray:
        """Return the corners (n_v, 3) of its triangles."""
        n_v = self.triangles.n_v
        rising = found.heights[:n_v, None] * self.normals[:n_v]
        return _following(self.plane, loop) + rising

    def _found(
        self, loop: SplineLoop, film: CurvedFilm, heights: FloatArray
    ) -> SmoothFilmAtRest:
        """Return the film at rest, its force by the way in which nodes follow the loop."""
        inside = film.gradient.copy()
        inside[self._middles] = 0.0
        gradient = loop.middles_gradient(film.gradient[self._middles])
        gradient[0] += self.plane.local.carry(self.triangles.gathered(inside))
        return SmoothFilmAtRest(film.area, gradient, heights)

    def _step(self, film: CurvedFilm, forces: FloatArray) -> FloatArray:
        """Return the heights (size,) that balance forces (size,), nearly."""
        stiffness = film.stiffness(self.normals)
        nodes, size = self.triangles.nodes, self.triangles.size
        diagonal = summed(nodes.ravel(), np.einsum("tkk->tk", stiffness).ravel(), size)
        heights, search, left = np.zeros(size), np.zeros(size), forces
        before = first = np.inf
        for _ in range(_ITERATIONS):
            answer = self._preconditioned(left, diagonal)
            work = float(left @ answer)
            first = min(first, work)
            search = answer + work / before * search
            before = work
            pull = np.matmul(stiffness, search[nodes][:, :, None])
            pull = summed(nodes.ravel(), pull.ravel(), size)
            part = work / float(search @ pull)
            heights, left = heights + part * search, left - part * pull
            if np.abs(left).max() <= _LEFT * np.abs(forces).max():
                return heights
        raise LinAlgError("the curved film is not stiff")

    def _preconditioned(self, forces: FloatArray, diagonal: FloatArray) -> FloatArray:
        """Return about the heights (size,) that forces (size,) cause."""
        n_v, inside = self.triangles.n_v, self.triangles.is_inside[self.triangles.n_v :]
        on_corners = self.triangles.gathered(forces)
        linear = np.zeros(n_v)
        linear[self._inside] = self.plane.inside.solve(on_corners[self._inside])
        heights = self.triangles.spread(linear) * self.triangles.is_inside
        heights[n_v:][inside] += forces[n_v:][inside] / diagonal[n_v:][inside]
        return heights

    @property
    def _middles(self) -> IntArray:
        """The nodes (n_b,) in the middles of the loop's edges."""
        return self.triangles.n_v + self.triangles.on_loop

    @property
    def _inside(self) -> IntArray:
        return self.plane.local.tiling.interior


def _following(plane: FilmAtRest, loop: SplineLoop) -> FloatArray:
    """Return a film's vertices (n_v, 3) as they follow its loop."""
    moved = loop.vertices - plane.x[plane.local.tiling.loop]
    return plane.x + plane.local.follow(moved)
