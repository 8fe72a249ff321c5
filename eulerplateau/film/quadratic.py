"""Films of fixed edge weights: their energy is a quadratic form of the positions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError
from eulerplateau.film.condensation import Condensation, condense
from eulerplateau.film.load import SPRING_LOAD, TENSION, Load
from eulerplateau.loop import Loop, LoopEnergy, Term, free_motions, inextensible
from eulerplateau.mesh import Disk, Shape, cotangents

if TYPE_CHECKING:
    from scipy.sparse import csc_array

    from eulerplateau.film.refinement import Finer

# Cotangents are as large as a triangle is thin; of this size they leave the weights of the
# triangles around it four digits.
_THINNEST = 1e-12


@dataclass(frozen=True, repr=False)
class QuadraticFilm:
    """A film whose energy is load * sum_e w_e |e|^2; which load, load.py says.

    Attributes
    ----------
    edges : (m, 2) int
    weights : (m,) float
    rest : the shape it is tied to
    interior : (n_v - n_b,) int
    load : the load, with its names
    """

    edges: IntArray
    weights: FloatArray
    rest: Shape
    interior: IntArray
    load: Load

    def __repr__(self) -> str:
        """Return one line: how many edges carry weights, and the load's name."""
        return f"<QuadraticFilm: {len(self.edges)} edges, load {self.load.text}>"

    def laplacian(self) -> csc_array:
        """Return the weighted graph Laplacian (n_v, n_v): energy = load * tr(x^T L x)."""
        from scipy.sparse import csc_array  # slow to load, and a sweep can do without

        row, column, values = self._entries
        n_v = len(self.rest.x)
        return csc_array((values, (row, column)), shape=(n_v, n_v))

    @property
    def _entries(self) -> tuple[IntArray, IntArray, FloatArray]:
        """Rows, columns and values (4 m,) that sum up to the Laplacian."""
        (i, j), w = self.edges.T, self.weights
        rows, columns = np.concatenate([i, j, i, j]), np.concatenate([j, i, i, j])
        return rows, columns, np.concatenate([-w, -w, w, w])

    @property
    def dimension(self) -> int:
        """Coordinates of its loops: 3, in space."""
        return 3

    def energy_gradient(self, shape: Shape, load: float) -> tuple[float, FloatArray]:
        """Return the film's energy and its gradient (n_v, 3) on a shape."""
        (i, j), n_v = self.edges.T, len(shape.x)
        span = shape.x[j] - shape.x[i]
        pull = (2 * load * self.weights)[:, None] * span
        gradient = np.empty_like(shape.x)
        for axis, along in enumerate(pull.T):
            gradient[:, axis] = np.bincount(j, along, n_v) - np.bincount(i, along, n_v)
        return 0.5 * float(np.vdot(pull, span)), gradient

    def forces(self, shape: Shape) -> FloatArray:
        """Return the forces (n_v, 3) of unit load: the whole gradient."""
        return self.energy_gradient(shape, 1.0)[1]

    def prepared(self, shape: Shape) -> Shape:
        """Return the shape as it is: springs span any."""
        return shape

    def carried(self, shape: Shape, x_loop: FloatArray) -> Shape:
        """Return the film at rest on a loop (n_b, 3)."""
        return self._eliminated.shape(x_loop)

    @property
    def refines(self) -> bool:
        """False: the mesh is what the film is made of."""
        return False

    def refined(self, shape: Shape, finer: Finer) -> Shape:
        """Return the shape as it is."""
        return shape

    def of_loop(self, near: Shape) -> QuadraticOfLoop:
        """Return the film as a function of its loop, the same near every shape."""
        return self._eliminated

    @cached_property
    def _eliminated(self) -> QuadraticOfLoop:
        condensed = condense(*self._entries, self.rest.loop, self.interior)
        return QuadraticOfLoop(self.rest, condensed)

    def slide(self, loop: Loop, x_loop: FloatArray) -> FloatArray | None:
        """Return None: the rest mesh resists sliding."""
        return None

    def pinched(self, shape: Shape, loop: Loop) -> bool:
        """Return False: springs may cross each other."""
        return False

    def folded(self, shape: Shape) -> bool:
        """Return False: what weights at rest span is known whatever triangles do."""
        return False

    def touches(self, shape: Shape, diameter: float) -> bool:
        """Return False: springs pass through each other, and through the loop."""
        return False


@dataclass(frozen=True)
class QuadraticOfLoop:
    """A film of fixed weights with its interior eliminated exactly (condensation.py)."""

    rest: Shape
    condensed: Condensation

    def project(self, x: FloatArray) -> FloatArray:
        """Return the positions (n, 3) as they are."""
        return x

    def lift(self, x_loop: FloatArray) -> FloatArray:
        """Return the loop (n_b, 3) as it is."""
        return x_loop

    def shape(self, x_loop: FloatArray) -> Shape:
        """Return the film at rest on a loop (n_b, 3)."""
        return self.rest.moved(self.condensed.extend(x_loop))

    def force(self, x_loop: FloatArray) -> FloatArray:
        """Return 2 S x_b (n_b, 3)."""
        return self.condensed.force(x_loop)

    def displacement(self, x_loop: FloatArray, moved: FloatArray) -> FloatArray:
        """Return how the film (n_v, 3) follows a move of its loop (n_b, 3)."""
        return self.condensed.extend(moved)

    def energy(self, loop: Loop, load: float) -> LoopEnergy:
        """Return bending plus load * tr(x_b^T S x_b)."""
        film = Stiffness(self.condensed.stiffness, load)
        return inextensible(loop, film, partial(free_motions, loop, slides=False))

    def made_at(self, x_loop: FloatArray) -> bool:
        """Return True: it is the same everywhere."""
        return True

    def renewed(self, x_loop: FloatArray) -> QuadraticOfLoop:
        """Return the same."""
        return self

    def released(self, x_loop: FloatArray) -> QuadraticOfLoop:
        """Return the same: its vertices are where the weights have them."""
        return self

    def kept(self, x_loop: FloatArray) -> Mapping[str, NDArray[Any]]:
        """Return nothing: it is the same everywhere."""
        return {}

    def restored(self, kept: Mapping[str, NDArray[Any]]) -> QuadraticOfLoop:
        """Return the same."""
        return self


@dataclass(frozen=True)
class Stiffness(Term):
    """load * tr(x^T S x) of a loop x (n, d), S = `stiffness` (n, n) symmetric."""

    stiffness: FloatArray
    load: float

    @cached_property
    def rounding(self) -> float:
        """What rounding alone leaves of the force, per unit of position: eps |2 load S|."""
        largest = float(np.abs(self.stiffness).sum(axis=1).max())
        return float(np.finfo(np.float64).eps) * 2 * abs(self.load) * largest

    def force(self, x: FloatArray) -> FloatArray:
        """Return 2 load S x (n, d)."""
        return 2 * self.load * (self.stiffness @ x)

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return 2 load S (n, n)."""
        return 2 * self.load * self.stiffness

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return the change of a quadratic form: its gradient half-way times the step."""
        return float(np.vdot(step, self.force(x + 0.5 * step)))

    def rate(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return the derivative of the force by the load."""
        return 2 * (self.stiffness @ x) if parameter == "load" else None


def springs(mesh: Disk) -> QuadraticFilm:
    """Return the paper's film: one zero-rest-length spring per interior edge."""
    edges = mesh.interior_edges
    weights = np.ones(len(edges))
    return QuadraticFilm(edges, weights, mesh.shape, mesh.interior, SPRING_LOAD)


def dirichlet(mesh: Disk) -> QuadraticFilm:
    """Return Dirichlet's energy of the map from the rest mesh: cotangent weights.

    With the load sigma_hat, sigma_hat sum_e w_e |e|^2 = sigma_hat/2 int |grad x|^2 dA for x
    linear in each rest triangle; 4 w_e is the sum of the cotangents of the angles opposite
    e. Obtuse angles can make it negative; the energy, an integral of squares, never is. The
    loop's edges are among `edges`: their lengths are kept and their share is constant, but
    the energy is whole.

    Raises MeshError for a triangle so thin that its weights would swallow the others.
    """
    corners = mesh.x[mesh.triangles]
    # side[:, j] lies opposite corner j.
    side = np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1)
    doubled_area = np.linalg.norm(np.cross(side[:, 0], side[:, 1]), axis=1)
    thin = doubled_area < _THINNEST * (side**2).sum(axis=2).max(axis=1)
    if thin.any():
        problem = "is too thin for the film's cotangent weights: mesh the polygon anew"
        raise MeshError("triangle", int(np.flatnonzero(thin)[0]), problem)
    opposite = np.stack([np.roll(mesh.triangles, shift, axis=1) for shift in (-1, 1)], 2)
    key = np.sort(opposite.reshape(-1, 2), axis=1) @ (mesh.n_v, 1)
    place = np.searchsorted(mesh.edges @ (mesh.n_v, 1), key)
    weights = np.zeros(len(mesh.edges))
    np.add.at(weights, place, cotangents(side, doubled_area / 2).ravel() / 4)
    return QuadraticFilm(mesh.edges, weights, mesh.shape, mesh.interior, TENSION)
