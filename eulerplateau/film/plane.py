"""A soap film kept in its plane: its area is its polygon's, and it needs no interior.

Loops are polygons (n_b, 2) here. The mesh is carried along for what is measured and drawn.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from eulerplateau.arrays import FloatArray
from eulerplateau.errors import MeshError
from eulerplateau.film.area import AreaFilm
from eulerplateau.film.folds import is_folded, laid_anew
from eulerplateau.film.harmonic import follower
from eulerplateau.film.load import TENSION, Load
from eulerplateau.film.plane_mesh import carry_in_plane, is_sparse
from eulerplateau.loop import Loop, LoopEnergy, Term, free_motions, inextensible, sliding
from eulerplateau.mesh import Disk, Shape, polygon_area, polygon_gradient

if TYPE_CHECKING:
    from eulerplateau.film.refinement import Finer

# A loop whose extent across its mean plane is a smaller part of the largest is flat.
_FLAT = 1e-9


@dataclass(frozen=True, repr=False)
class PlaneFilm:
    """A flat film whose energy is load * area, load = sigma L^3 / alpha.

    Attributes
    ----------
    soap : the film with its triangles
    axes : (2, 3) float, orthonormal; the loop runs counter-clockwise in them
    """

    soap: AreaFilm
    axes: FloatArray
    load: Load = TENSION

    def __repr__(self) -> str:
        """Return one line: how many vertices the loop has, and the load's name."""
        return f"<PlaneFilm: {len(self.soap.loop)} on the loop, load {self.load.text}>"

    def flattened(self, x: FloatArray) -> FloatArray:
        """Return positions (n, 3) projected onto the plane through the origin."""
        flat: FloatArray = x @ self.axes.T @ self.axes
        return flat

    @property
    def dimension(self) -> int:
        """Coordinates of its loops: 2, in the plane."""
        return 2

    def energy_gradient(self, shape: Shape, load: float) -> tuple[float, FloatArray]:
        """Return load * area of the loop's polygon and its gradient (n_v, 3)."""
        flat = shape.x_loop @ self.axes.T
        gradient = np.zeros_like(shape.x)
        gradient[shape.loop] = load * polygon_gradient(flat) @ self.axes
        return load * polygon_area(flat), gradient

    def forces(self, shape: Shape) -> FloatArray:
        """Return the forces (n_v, 3) of unit load: on the loop only."""
        return self.energy_gradient(shape, 1.0)[1]

    def prepared(self, shape: Shape) -> Shape:
        """Return the shape laid flat without folds, turned over if it runs clockwise."""
        flat = self.flattened(shape.x)
        if polygon_area(shape.x_loop @ self.axes.T) < 0:
            flat -= 2 * np.outer(shape.x @ self.axes[1], self.axes[1])
        tiling = self.soap.tiling(shape.triangles)
        if is_folded(tiling, flat):
            return self.soap.on(*laid_anew(tiling, flat))
        return shape.moved(flat)

    def carried(self, shape: Shape, x_loop: FloatArray) -> Shape:
        """Return the shape after its loop has moved to x_loop (n_b, 3)."""
        return self.soap.carried(shape, x_loop)

    @property
    def refines(self) -> bool:
        """False: its triangles are only looked at."""
        return False

    def refined(self, shape: Shape, finer: Finer) -> Shape:
        """Return the shape as it is."""
        return shape

    def of_loop(self, near: Shape) -> PlaneOfLoop:
        """Return the film as a function of its polygon; its mesh follows from a shape."""
        return PlaneOfLoop(self, near)

    def slide(self, loop: Loop, x_loop: FloatArray) -> FloatArray | None:
        """Return the loop's sliding along itself (n_b, 3): the film only sees its curve."""
        return sliding(loop, x_loop)

    def pinched(self, shape: Shape, loop: Loop) -> bool:
        """Return whether strands of the loop meet, or have passed each other.

        Then the film has been turned inside out.
        """
        inside_out = self.energy_gradient(shape, 1.0)[0] < 0
        return inside_out or loop.strands_meet(shape.x_loop)

    def folded(self, shape: Shape) -> bool:
        """Return whether the mesh shows another area than its polygon has.

        A mesh with hardly a vertex inside cannot but fold; it is only looked at.
        """
        few = is_sparse(self.soap.tiling(shape.triangles))
        return not few and self.soap.folded(shape)

    def touches(self, shape: Shape, diameter: float) -> bool:
        """Return False: in its plane strands meet before a film does."""
        return False


@dataclass(frozen=True)
class PlaneOfLoop:
    """A film kept in its plane as a function of its polygon (n_b, 2)."""

    film: PlaneFilm
    near: Shape

    def project(self, x: FloatArray) -> FloatArray:
        """Return positions (n, 3) in the plane's coordinates (n, 2)."""
        flat: FloatArray = x @ self.film.axes.T
        return flat

    def lift(self, x_loop: FloatArray) -> FloatArray:
        """Return a polygon (n_b, 2) in space (n_b, 3)."""
        lifted: FloatArray = x_loop @ self.film.axes
        return lifted

    def shape(self, x_loop: FloatArray) -> Shape:
        """Return the flat film on a polygon (n_b, 2), its mesh moved along."""
        soap, axes = self.film.soap, self.film.axes
        tiling = soap.tiling(self.near.triangles)
        return soap.on(*carry_in_plane(tiling, self.near.x, x_loop, axes))

    def force(self, x_loop: FloatArray) -> FloatArray:
        """Return the gradient of the area (n_b, 2)."""
        return polygon_gradient(x_loop)

    def displacement(self, x_loop: FloatArray, moved: FloatArray) -> FloatArray:
        """Return how the mesh (n_v, 3) follows a small move (n_b, 2) of its polygon."""
        shape = self.shape(x_loop)
        tiling = self.film.soap.tiling(shape.triangles)
        return follower(tiling, tiling.sides(shape.x)).extend(moved @ self.film.axes)

    def energy(self, loop: Loop, load: float) -> LoopEnergy:
        """Return bending plus load * area of the polygon; it slides along itself freely."""
        return inextensible(
            loop, PolygonArea(load), partial(free_motions, loop, slides=True)
        )

    def made_at(self, x_loop: FloatArray) -> bool:
        """Return True: a polygon's area is known everywhere."""
        return True

    def renewed(self, x_loop: FloatArray) -> PlaneOfLoop:
        """Return the film with its mesh carried to this polygon."""
        return PlaneOfLoop(self.film, self.shape(x_loop))

    def released(self, x_loop: FloatArray) -> PlaneOfLoop:
        """Return the same: in a plane vertices may lie anywhere."""
        return self

    def kept(self, x_loop: FloatArray) -> Mapping[str, NDArray[Any]]:
        """Return where its mesh is carried to on this polygon."""
        shape = self.shape(x_loop)
        return {"x": shape.x, "triangles": shape.triangles}

    def restored(self, kept: Mapping[str, NDArray[Any]]) -> PlaneOfLoop:
        """Return the film with its mesh where it was kept."""
        shape = Shape(kept["x"], kept["triangles"], self.near.loop)
        return PlaneOfLoop(self.film, shape)


@dataclass(frozen=True)
class PolygonArea(Term):
    """load * area of the polygon x (n, 2), counter-clockwise positive."""

    load: float

    @property
    def rounding(self) -> float:
        """What rounding alone leaves of a force, per unit of position."""
        return float(np.finfo(np.float64).eps) * abs(self.load)

    def force(self, x: FloatArray) -> FloatArray:
        """Return the gradient (n, 2)."""
        return self.load * polygon_gradient(x)

    def hessian(self, x: FloatArray) -> FloatArray:
        """Return the second derivative (2 n, 2 n)."""
        n = len(x)
        hessian = np.zeros((n, 2, n, 2))
        # d2A / dx_v dy_{v+1} = 1/2 = -d2A / dy_v dx_{v+1}.
        ahead = np.roll(np.eye(n), 1, axis=1)
        cross = 0.5 * self.load * (ahead - ahead.T)
        hessian[:, 0, :, 1], hessian[:, 1, :, 0] = cross, cross.T
        return hessian.reshape(2 * n, 2 * n)

    def change(self, x: FloatArray, step: FloatArray) -> float:
        """Return the change of a quadratic form: its gradient half-way times the step."""
        return float(np.vdot(step, self.force(x + 0.5 * step)))

    def rate(self, parameter: str, x: FloatArray) -> FloatArray | None:
        """Return the derivative of the force by the load."""
        return polygon_gradient(x) if parameter == "load" else None


def plane_film(disk: Disk) -> PlaneFilm:
    """Return the film that stays in the plane of a disk; MeshError if the loop has none."""
    loop = disk.x[disk.loop] - disk.x[disk.loop].mean(axis=0)
    _, extents, axes = np.linalg.svd(loop, full_matrices=False)
    if extents[2] > _FLAT * extents[0]:
        raise MeshError("mesh", None, "is not flat, as film.plane asks: leave that out")
    axes = axes[:2]
    if polygon_area(loop @ axes.T) < 0:
        axes = axes * np.array([[1.0], [-1.0]])
    return PlaneFilm(AreaFilm(disk.loop, disk.interior), axes)
