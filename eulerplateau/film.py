"""Films as edge weights: which quadratic energy the triangulated disk carries."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csc_array

from eulerplateau.mesh import DiskMesh, FloatArray, IntArray

# sigma = 2 sqrt(3) k on equilateral triangles when the loop is inextensible: the interior
# edges then carry the whole Dirichlet energy (shared/theory of eq. discrete-energy).
SPRING_TENSION = 2 * np.sqrt(3.0)


@dataclass(frozen=True)
class Film:
    """A film whose energy is load * sum_e w_e |e|^2, load = k L^3 / alpha.

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


def springs(mesh: DiskMesh) -> Film:
    """Return the paper's film: one zero-rest-length spring per interior edge."""
    edges = mesh.interior_edges
    return Film(edges, np.ones(len(edges)), SPRING_TENSION)


FILMS = {"springs": springs}
