"""Where a search begins: small pushes in no special direction, shapes of finer meshes."""

from __future__ import annotations

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import SpecError
from eulerplateau.film import FilmOfLoop
from eulerplateau.mesh import Disk, Shape

# How far a kick moves a vertex at most, in L.
KICK = 1e-3


def smooth_kick(
    x_loop: FloatArray, x: FloatArray, rng: np.random.Generator, axis: int
) -> FloatArray:
    """Return a smooth random displacement (n_v, 3) of 1e-3 L along an axis of the loop.

    Axis 2 is across its mean plane, 0 and 1 are its long and short one. A random polynomial
    of degree 2 to 4 in the in-plane coordinates (across the plane lower degrees are rigid
    motions): noise from vertex to vertex would be smoothed away by the bending stiffness
    before it reached the modes that become unstable.
    """
    centre = x_loop.mean(axis=0)
    axes = np.linalg.svd(x_loop - centre)[2]
    a, b = ((x - centre) @ axes[:2].T / np.abs(x_loop - centre).max()).T
    powers = [(i, d - i) for d in (2, 3, 4) for i in range(d + 1)]
    height = sum(rng.standard_normal() * a**i * b**j for i, j in powers)
    return np.outer(height * (KICK / np.abs(height).max()), axes[axis])


def displaced(mesh: Disk, displacement: float, seed: int) -> FloatArray:
    """Return the mesh with every vertex displaced at random across its mean plane."""
    centred = mesh.x[mesh.loop] - mesh.x[mesh.loop].mean(axis=0)
    across = np.linalg.svd(centred)[2][2]
    noise = np.random.default_rng(seed).standard_normal(mesh.n_v)
    return mesh.x + np.outer(displacement * noise, across)


def coarse(tied: FilmOfLoop | None, mesh: Disk, shape: Shape) -> Shape:
    """Return a shape that was refined on the vertices of its mesh and across its loop.

    By a film tied to the mesh at rest, whose triangles it has then. Raises SpecError where
    there is none.
    """
    if tied is None:
        raise SpecError("start", "has other vertices than the mesh, which spans no film")
    return tied.shape(shape.x[mesh.loop])
