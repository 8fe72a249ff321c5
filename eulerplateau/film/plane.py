"""A soap film kept in its plane: its area is the polygon's, and it needs no interior."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import MeshError
from eulerplateau.film.area import AreaFilm, area
from eulerplateau.mesh import DiskMesh

# A loop whose extent across its mean plane is a smaller part of the largest is flat.
_FLAT = 1e-9


@dataclass(frozen=True)
class PlaneFilm:
    """A flat film whose energy is load * area, load = sigma L^3 / alpha.

    Attributes
    ----------
    soap : the film with its triangles, for what is measured and drawn
    axes : (2, 3) float, orthonormal; the loop runs counter-clockwise in them
    """

    soap: AreaFilm
    axes: FloatArray
    tension_per_load: float = 1.0

    def flattened(self, x: FloatArray) -> FloatArray:
        """Return a shape (n_v, 3) projected onto the plane through the origin."""
        flat: FloatArray = x @ self.axes.T @ self.axes
        return flat

    def laid(self, x: FloatArray) -> FloatArray:
        """Return a shape (n_v, 3) flattened, and turned over if its loop runs clockwise."""
        flat = self.flattened(x)
        if polygon_area(x[self.soap.loop] @ self.axes.T) < 0:
            flat -= 2 * np.outer(x @ self.axes[1], self.axes[1])
        return flat

    def energy_gradient(self, x: FloatArray, load: float) -> tuple[float, FloatArray]:
        """Return load * area of the loop's polygon and its gradient (n_v, 3)."""
        flat = x[self.soap.loop] @ self.axes.T
        gradient = np.zeros_like(x)
        gradient[self.soap.loop] = load * polygon_gradient(flat) @ self.axes
        return load * polygon_area(flat), gradient


def polygon_area(x: FloatArray) -> float:
    """Return the area (signed) of a polygon (n, 2), about its mean to lose no digits."""
    y = x - x.mean(axis=0)
    after = np.roll(y, -1, axis=0)
    return 0.5 * float((y[:, 0] * after[:, 1] - y[:, 1] * after[:, 0]).sum())


def polygon_gradient(x: FloatArray) -> FloatArray:
    """Return the gradient (n, 2) of the area: half the chord across, turned outwards."""
    chord = np.roll(x, -1, axis=0) - np.roll(x, 1, axis=0)
    return 0.5 * np.column_stack([chord[:, 1], -chord[:, 0]])


def plane_film(mesh: DiskMesh) -> PlaneFilm:
    """Return the film that stays in the plane of a mesh; MeshError if the loop has none."""
    loop = mesh.x[mesh.loop] - mesh.x[mesh.loop].mean(axis=0)
    _, extents, axes = np.linalg.svd(loop, full_matrices=False)
    if extents[2] > _FLAT * extents[0]:
        raise MeshError("mesh", None, "is not flat, as film.plane asks: leave that out")
    axes = axes[:2]
    if polygon_area(loop @ axes.T) < 0:
        axes = axes * np.array([[1.0], [-1.0]])
    return PlaneFilm(area(mesh), axes)
