"""Films as edge weights: which quadratic energy the triangulated disk carries."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError
from eulerplateau.film.area import AreaFilm, area
from eulerplateau.film.load import SPRING_LOAD, TENSION
from eulerplateau.loop.kernels import film_energy_gradient
from eulerplateau.mesh import DiskMesh

# Cotangents are as large as a triangle is thin; of this size they leave the weights of the
# triangles around it four digits.
_THINNEST = 1e-12


@dataclass(frozen=True)
class Film:
    """A film whose energy is load * sum_e w_e |e|^2; which load, load.py says.

    Attributes
    ----------
    edges : (m, 2) int
    weights : (m,) float
    tension_per_load : float
        Effective sigma L^3 / alpha per unit of load.
    """

    edges: IntArray
    weights: FloatArray
    tension_per_load: float

    def laplacian(self, n_v: int) -> csc_array:
        """Return the weighted graph Laplacian (n_v, n_v): energy = load * tr(x^T L x)."""
        i, j = self.edges.T
        w = self.weights
        rows = np.concatenate([i, j, i, j])
        columns = np.concatenate([j, i, i, j])
        values = np.concatenate([-w, -w, w, w])
        return csc_array((values, (rows, columns)), shape=(n_v, n_v))

    def energy_gradient(self, x: FloatArray, load: float) -> tuple[float, FloatArray]:
        """Return the film's energy and its gradient (n_v, 3) at x (n_v, 3)."""
        gradient = np.zeros_like(x)
        energy = film_energy_gradient(x, self.edges, load * self.weights, gradient)
        return energy, gradient


def springs(mesh: DiskMesh) -> Film:
    """Return the paper's film: one zero-rest-length spring per interior edge."""
    edges = mesh.interior_edges
    return Film(edges, np.ones(len(edges)), SPRING_LOAD.tension_per_load)


def dirichlet(mesh: DiskMesh) -> Film:
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
    # One area for all three corners: its rounding in a sliver then scales the sliver's
    # energy and cannot make it indefinite.
    dots = -(np.roll(side, -1, axis=1) * np.roll(side, 1, axis=1)).sum(axis=2)
    cotangents = dots / doubled_area[:, None]
    opposite = np.stack([np.roll(mesh.triangles, shift, axis=1) for shift in (-1, 1)], 2)
    key = np.sort(opposite.reshape(-1, 2), axis=1) @ (mesh.n_v, 1)
    place = np.searchsorted(mesh.edges @ (mesh.n_v, 1), key)
    weights = np.zeros(len(mesh.edges))
    np.add.at(weights, place, cotangents.ravel() / 4)
    return Film(mesh.edges, weights, TENSION.tension_per_load)


FILMS: dict[str, Callable[[DiskMesh], Film | AreaFilm]] = {
    "springs": springs,
    "dirichlet": dirichlet,
    "area": area,
}
