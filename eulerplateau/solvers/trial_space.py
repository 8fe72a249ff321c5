"""What conjugate gradients vary, and what it does to a film's energy.

A film of fixed weights moves with all its vertices and is quadratic in them. A soap film's
vertices move along their normals, on top of how the mesh follows its loop (chart.py):
sliding costs nothing, and a descent along it would end in thin triangles. A film kept in
its plane has no unknowns but its loop's. Of both the loop is kept from sliding along
itself, which costs nothing either (motions.py).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.film import AreaFilm, Chart, Film, PlaneFilm, polygon_gradient
from eulerplateau.loop import Loop, sliding, without
from eulerplateau.loop.kernels import area_beyond_linear
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

        `forces` (n_v, 3) as Problem.film_forces has them, bending and tension added.
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


def centred(problem: Problem, x: FloatArray) -> tuple[Problem, FloatArray]:
    """Return the problem and a shape (n_v, 3) to vary, a soap film's chart made there.

    A rough film is brought near to rest first, a thin triangle replaced. Raises LinAlgError
    if there is no film to be made at x.
    """
    if not isinstance(problem.film, AreaFilm):
        return problem, x
    here = problem.near(x)
    chart = here.condensed
    assert isinstance(chart, Chart)
    return here, chart.x


def trial_space(problem: Problem, x: FloatArray, load: float) -> TrialSpace:
    """Return the trial space at a shape (n_v, 3) that has been `centred`."""
    film = problem.film
    if isinstance(film, Film):
        return _Everywhere(film, x, load)
    loop, slide = problem.loop, sliding(problem.loop, x[problem.loop_vertices])
    if isinstance(film, PlaneFilm):
        return _InPlane(loop, slide, film, load)
    chart = problem.condensed
    assert isinstance(chart, Chart)
    return _AlongNormals(loop, slide, chart, load)


@dataclass(frozen=True)
class _Everywhere:
    film: Film
    x: FloatArray
    load: float

    @property
    def size(self) -> int:
        return self.x.size

    @property
    def springs(self) -> tuple[IntArray, FloatArray]:
        return self.film.edges, self.load * self.film.weights

    def lift(self, forces: FloatArray) -> FloatArray:
        return forces

    def displacement(self, unknown: FloatArray) -> FloatArray:
        return unknown.reshape(self.x.shape)

    def collect(self, gradient: FloatArray) -> FloatArray:
        return gradient.ravel()

    def beyond_linear(self, moved: FloatArray, gradient: FloatArray) -> float:
        return 0.0

    def holds(self, moved: FloatArray) -> bool:
        return True


@dataclass(frozen=True)
class _Sliding:
    """A film that only sees its loop's curve: `slide` (n_b, 3), None if that is rigid."""

    loop: Loop
    slide: FloatArray | None

    def kept(self, moved: FloatArray) -> FloatArray:
        """Return a displacement (n_b, 3) of the loop without its part along `slide`."""
        if self.slide is None:
            return moved
        share = float(np.sum(self.loop.mean_lengths[:, None] * self.slide * moved))
        return moved - share * self.slide

    def pulled(self, forces: FloatArray) -> FloatArray:
        """Return forces (n_b, 3) on the loop without what `kept` makes nothing of."""
        return without(self.slide, self.loop, forces)

    @property
    def springs(self) -> tuple[IntArray, FloatArray]:
        return np.zeros((0, 2), dtype=np.int64), np.zeros(0)


@dataclass(frozen=True)
class _AlongNormals(_Sliding):
    chart: Chart
    load: float

    @property
    def size(self) -> int:
        film = self.chart.film
        return 3 * len(film.loop) + len(film.interior)

    def lift(self, forces: FloatArray) -> FloatArray:
        film = self.chart.film
        lifted = forces.copy()
        # The loop's forces have their share of those inside; the mesh that follows adds it.
        lifted[film.loop] += forces[film.loop] - self.chart.carry(forces)
        return lifted

    def displacement(self, unknown: FloatArray) -> FloatArray:
        chart, n = self.chart, 3 * len(self.chart.film.loop)
        moved = chart.follow(self.kept(unknown[:n].reshape(-1, 3)))
        moved[chart.film.interior] += unknown[n:, None] * chart.normals
        return moved

    def collect(self, gradient: FloatArray) -> FloatArray:
        chart = self.chart
        along = (gradient[chart.film.interior] * chart.normals).sum(axis=1)
        return np.concatenate([self.pulled(chart.carry(gradient)).ravel(), along])

    def beyond_linear(self, moved: FloatArray, gradient: FloatArray) -> float:
        chart = self.chart
        force = np.zeros_like(gradient)
        area = area_beyond_linear(moved, chart.x, chart.film.triangles, force)
        gradient += self.load * force
        return self.load * float(area)

    def holds(self, moved: FloatArray) -> bool:
        return self.chart.holds(self.chart.film.sides(self.chart.x + moved))


@dataclass(frozen=True)
class _InPlane(_Sliding):
    film: PlaneFilm
    load: float

    @property
    def size(self) -> int:
        return 3 * len(self.film.soap.loop)

    def lift(self, forces: FloatArray) -> FloatArray:
        return forces

    def displacement(self, unknown: FloatArray) -> FloatArray:
        moved = np.zeros((self.film.soap.n_v, 3))
        moved[self.film.soap.loop] = self.kept(self.film.flattened(unknown.reshape(-1, 3)))
        return moved

    def collect(self, gradient: FloatArray) -> FloatArray:
        return self.film.flattened(self.pulled(gradient[self.film.soap.loop])).ravel()

    def beyond_linear(self, moved: FloatArray, gradient: FloatArray) -> float:
        # A polygon's area is quadratic in its corners.
        loop, axes = self.film.soap.loop, self.film.axes
        step = moved[loop] @ axes.T
        force = self.load * polygon_gradient(step)
        gradient[loop] += force @ axes
        return 0.5 * float(np.vdot(step, force))

    def holds(self, moved: FloatArray) -> bool:
        return True
