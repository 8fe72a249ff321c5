"""What an equilibrium on a mesh becomes in the limit of fine ones: deferred correction.

On a mesh loop and film are polygons and triangles, and every number errs by O(h^2). Here
the same equations are written down once more to a higher order on the same mesh: the loop
is the quintic spline through its vertices, whose arcs keep the lengths of the edges; the
film is flat or has curved triangles (film/curved_film.py). What the equilibrium found
leaves of these forces F is its defect, and with the matrix J of its last Newton step

    x <- x - J^-1 F(x)

brings it down by a factor of O(h^2) each time (Fox 1947; Pereyra, Numer. Math. 8, 1966;
Stetter, Numer. Math. 29, 1978). Two things make that good on coarse meshes as well:

- A spline resists waves of a few edges more than a polygon does: of wave number k by about
  1 + (k h)^2 / 6, three times at two edges. The mass matrix of linear elements, with which
  forces are smoothed, is 1 - (k h)^2 / 6 and makes up for it.
- The steps are combined so that the last would be the least: Anderson's mixing (J. ACM 12,
  1965), which is GMRES where the equations are linear. A soft mode that J has wrong, next
  to a transition, then costs two steps and not convergence.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import cast

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import NotConvergedError, SpecError
from eulerplateau.film import (
    AreaFilm,
    AreaOfLoop,
    SmoothFilm,
    SmoothFilmAtRest,
    smooth_film,
)
from eulerplateau.loop import Loop, SplineLoop, Splines
from eulerplateau.mesh import Shape
from eulerplateau.solvers.equilibrium import LENGTH_TOLERANCE, Equilibrium
from eulerplateau.solvers.large_loops.film_models import FilmModel, FilmModels
from eulerplateau.solvers.problem import Problem
from eulerplateau.threads import one_thread

# Steps that are combined, and steps at most.
_DEPTH, _STEPS = 4, 30
# The last step over the square of the first, which is about what a result errs by.
_LAST = 0.01
# A step, in L, that is no correction any more.
_FAR = 0.1
# A step below which there is only rounding, in L; and one that is rounding if others after
# it are no smaller.
_ROUNDING, _STUCK = 1e-12, 1e-9


@dataclass(frozen=True, eq=False, repr=False)
class Corrected:
    """An equilibrium to a higher order than its mesh's. Units: lengths L, energies alpha/L.

    Attributes
    ----------
    found : the equilibrium on the mesh
    shape : its film with vertices where the corrected one has them
    tensions : (n_b,) float, of the loop's edges
    energy, area, bending_energy : float
        energy = load * area + bending_energy
    area_change : float
        What was added to the area: about minus its error on the mesh.
    unevenness : float
        The largest ||dr/ds| - 1| along the loop, whose edges keep their lengths as wholes.
    corrections : int, steps it took
    """

    found: Equilibrium
    shape: Shape
    tensions: FloatArray
    energy: float
    area: float
    area_change: float
    bending_energy: float
    unevenness: float
    corrections: int

    @property
    def load(self) -> float:
        """The load sigma L^3 / alpha."""
        return self.found.load

    @property
    def energy_change(self) -> float:
        """What was added to the energy."""
        return self.energy - self.found.energy

    @property
    def bending_change(self) -> float:
        """What was added to the bending energy."""
        return self.bending_energy - self.found.bending_energy

    @property
    def moved(self) -> float:
        """How far the loop's vertices were moved, root mean square: the shape's error."""
        moved = self.shape.x_loop - self.found.shape.x_loop
        return float(np.sqrt(np.square(moved).sum(axis=1).mean()))

    @property
    def error_estimate(self) -> float:
        """The relative error that is left, of the worst of area and bending energy.

        The square of the larger relative change: what is O(h^2) large leaves O(h^4). It
        is the size of the error, not a bound.
        """
        area, bending = self.area_change / self.area, self.bending_change
        return max(area**2, (bending / self.bending_energy) ** 2)

    def __repr__(self) -> str:
        """Return one line: load, energy, and by how much that changed."""
        return (
            f"<Corrected at load {self.load:.6g}: energy {self.energy:.12g}, "
            f"{self.energy_change:+.2e}, error about {self.error_estimate:.0e}>"
        )


def corrected(problem: Problem, found: Equilibrium) -> Corrected:
    """Return what an equilibrium of a soap film becomes to a higher order in its mesh.

    Its loop is a smooth curve of length 1 exactly, and its numbers err by O(h^4) in place
    of O(h^2), at a fraction of what `solve` costs. It may be stable or not.

    Parameters
    ----------
    problem : of a film "area", in space, whose loop resists bending only
    found : an equilibrium of it that has converged

    Raises
    ------
    SpecError : for another film or loop, or an equilibrium of another problem
    NotConvergedError : where `found` has not converged, or the correction does not
    """
    _check(problem, found)
    with one_thread():
        try:
            return _corrected(problem, found)
        except LinAlgError as error:
            raise NotConvergedError(f"the correction failed: {error}") from None


def _check(problem: Problem, found: Equilibrium) -> None:
    """Refuse what there is no correction of."""
    match problem.film:
        case AreaFilm():
            pass
        case film:
            name = type(film).__name__
            raise SpecError("film", f'found {name}; only "area" in space is corrected')
    if problem.loop.terms:
        names = ", ".join(problem.loop.terms)
        raise SpecError("loop", f"resists {names}; only what bends alone is corrected")
    if problem.loop.diameter is not None:
        raise SpecError("diameter", "should be none: a loop in contact is not corrected")
    if not found.converged:
        said = f"{found.status.value}; only what has converged is corrected"
        raise NotConvergedError(f"the equilibrium is {said}", found.status.value)
    same = np.array_equal(found.shape.loop, problem.disk.loop)
    if not same or problem.length_error(found.shape) > LENGTH_TOLERANCE:
        raise SpecError("found", "is an equilibrium of another problem")


def _corrected(problem: Problem, found: Equilibrium) -> Corrected:
    film = cast(AreaOfLoop, problem.film.of_loop(found.shape))
    x = found.shape.x_loop
    models = FilmModels(
        film.energy(problem.loop, found.load), film, problem.loop, found.load
    )
    model = models.at(x)
    smooth = _Smooth(Splines(problem.loop.rest_lengths), smooth_film(film, x), found.load)
    first, before = 0.0, np.inf
    for number, (state, step) in enumerate(_steps(problem.loop, model, smooth)):
        first = first or step
        stuck = before / 2 < step < _STUCK
        before = step
        if stuck or step <= max(_LAST * first**2, _ROUNDING):
            x = smooth.film.vertices(state.loop, state.film)
            area = film.local.relax(found.shape.x_loop).area
            return _record(found, state, x, state.film.area - area, number)
        if not step < _FAR:
            break
    raise NotConvergedError("the correction does not settle: the mesh is too coarse for it")


@dataclass(frozen=True)
class _State:
    """A smooth loop (n, 3) with its tensions (n,), and the film at rest on it."""

    loop: SplineLoop
    tensions: FloatArray
    film: SmoothFilmAtRest


@dataclass(frozen=True)
class _Smooth:
    """The equations of smooth loops and their films at one load."""

    splines: Splines
    film: SmoothFilm
    load: float

    def at(self, x: FloatArray, tensions: FloatArray, before: _State | None) -> _State:
        """Return the state of a loop through x (n, 3), next to another if one is known."""
        loop = self.splines.through(x)
        film = self.film.at_rest(loop, None if before is None else before.film)
        return _State(loop, tensions, film)

    def force(self, state: _State) -> FloatArray:
        """Return the gradient (n, 3) of the energy and of what tensions add."""
        loop = state.loop
        by_data = loop.bending_gradient + loop.tension_gradient(state.tensions)
        return self.splines.pulled_back(by_data + self.load * state.film.gradient)


def _steps(loop: Loop, model: FilmModel, smooth: _Smooth) -> Iterator[tuple[_State, float]]:
    """Yield one state after another, with the size of the step from it, in L."""
    factor = model.bare
    if factor is None:
        raise LinAlgError("the film is singular")
    n, weights = len(model.x), np.repeat(np.sqrt(loop.mean_lengths), 3)
    z, state = np.concatenate([model.x.ravel(), model.tensions]), None
    known: list[tuple[FloatArray, FloatArray]] = []
    for _ in range(_STEPS):
        state = smooth.at(z[: 3 * n].reshape(n, 3), z[3 * n :], state)
        forces = _smoothed(loop, smooth.force(state))
        moved, pulled = model.answered(factor, -forces, -state.loop.excess)
        known = [*known[1 - _DEPTH :], (z, np.concatenate([moved.ravel(), pulled]))]
        after = _mixed(known, weights)
        yield state, float(np.linalg.norm((after - z)[: 3 * n] * weights))
        z = after


def _smoothed(loop: Loop, forces: FloatArray) -> FloatArray:
    """Return forces (n, 3) smoothed by the mass matrix of linear elements."""
    density = forces / loop.mean_lengths[:, None]
    across: FloatArray = density + np.concatenate([density[1:], density[:1]])
    across *= loop.rest_lengths[:, None] / 6
    across += np.concatenate([across[-1:], across[:-1]])
    return forces / 3 + across


def _mixed(known: list[tuple[FloatArray, FloatArray]], weights: FloatArray) -> FloatArray:
    """Return where to go from iterates and their steps (m,), the last of them last.

    weights : (k,) float, of the first k numbers, in which steps are to be least
    """
    z, step = known[-1]
    if len(known) == 1:
        return z + step
    steps = np.array([step - other for _, other in known[:-1]]).T
    ways = np.array([z - other for other, _ in known[:-1]]).T
    k = len(weights)
    part = np.linalg.lstsq(weights[:, None] * steps[:k], weights * step[:k], rcond=1e-10)[0]
    mixed: FloatArray = z + step - (ways + steps) @ part
    return mixed


def _record(
    found: Equilibrium, state: _State, x: FloatArray, area_change: float, corrections: int
) -> Corrected:
    area, bending = state.film.area, state.loop.bending
    x[found.shape.loop] = state.loop.vertices
    return Corrected(
        found=found,
        shape=found.shape.moved(x),
        tensions=state.tensions,
        energy=found.load * area + bending,
        area=area,
        area_change=area_change,
        bending_energy=bending,
        unevenness=float(np.abs(state.loop.speeds - 1).max()),
        corrections=corrections,
    )
