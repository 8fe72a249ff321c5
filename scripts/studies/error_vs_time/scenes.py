"""What is computed: scenes, their meshes and starts, and their errors.

No reference is tuned. For `area` it is the exact planar film (eulerplateau.exact.planar)
or the disk's exact threshold; for quadratic films the limit of their own values under
refinement.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar

from eulerplateau.arrays import FloatArray
from eulerplateau.exact.planar import PlanarFilm, planar_film
from eulerplateau.film import make_film
from eulerplateau.mesh import Disk
from eulerplateau.mesh.polygon import ellipse, stretched_hexagon
from scripts.studies.common import make_mesh

# Edge length deep inside over edge length at the loop, of graded meshes.
GRADING = 4.0
# Out-of-plane displacement of the starts, z = SADDLE x y / L: 0.01 L at the most.
SADDLE = 0.4


@dataclass(frozen=True)
class Scene:
    """One equilibrium to compute.

    Attributes
    ----------
    load : float
        sigma L^3 / alpha of `area` and `dirichlet` films, k L^3 / alpha of `springs`.
    polygon : dict
        The rest polygon, which is the start too: an "ellipse", a "stretched-hexagon" or
        "lobes".
    in_plane : bool
        Whether the film is kept in the plane, where it is its polygon's area.
    lobes : int or None
        Lobes of the exact planar film; None where there is no exact solution.
    threshold : float or None
        Not an equilibrium but this load is sought, at which the disk buckles out of its
        plane (`transverse`) or within it.
    saddle : bool
        Whether the equilibrium is unstable, so that a minimiser would leave it.
    """

    name: str
    film: str
    load: float
    polygon: tuple[tuple[str, Any], ...]
    in_plane: bool = False
    lobes: int | None = None
    threshold: float | None = None
    transverse: bool = False
    saddle: bool = False

    @property
    def exact(self) -> PlanarFilm | None:
        """The exact planar film, if the scene has one."""
        return None if self.lobes is None else _planar_film(self.lobes, self.load)

    @property
    def answer(self) -> float | None:
        """The exact energy or threshold, None where neither is known."""
        return self.threshold if self.exact is None else self.exact.energy

    def parts(self, area: float, bending: float) -> dict[str, float]:
        """Return the relative errors of an area and a bending energy, nan if unknown."""
        exact = self.exact
        if exact is None:
            return {"area_error": math.nan, "bending_error": math.nan}
        bent = exact.energy - self.load * exact.area
        return {
            "area_error": abs(area / exact.area - 1),
            "bending_error": abs(bending / bent - 1),
        }

    def mesh(self, kind: str, loop_edges: int) -> Disk:
        """Return the rest mesh of a kind with so many loop edges.

        "uniform", "graded", "lattice", or "fan": one vertex inside, which is more than a
        film kept in its plane needs.
        """
        polygon = dict(self.polygon)
        if kind == "lattice":
            return lattice(loop_edges // 6, float(polygon["factor"]))
        corners = chain(polygon, loop_edges)
        if kind == "fan":
            return fan(corners)
        edge = float(np.linalg.norm(np.diff(corners, axis=0), axis=1).max())
        polygon = {"kind": "corners", "points": corners.tolist()}
        grading = GRADING if kind == "graded" else 1.0
        return make_mesh(polygon=polygon, edge_length=edge, grading=grading)

    def start(self, mesh: Disk) -> FloatArray:
        """Return every solver's start (n_v, 3): the rest mesh, bent out of its plane."""
        x = mesh.x.copy()
        if not self.in_plane:
            x[:, 2] += SADDLE * x[:, 0] * x[:, 1]
        return x


_planar_film = cache(planar_film)


def fan(corners: FloatArray) -> Disk:
    """Return the polygon (n, 2) with one vertex inside, at its mean."""
    n = len(corners)
    points = np.zeros((n + 1, 3))
    points[:n, :2] = corners
    points[n, :2] = corners.mean(axis=0)
    v = np.arange(n)
    rim = np.column_stack([v, (v + 1) % n, np.full(n, n)])
    return Disk.from_triangles(points, rim)


def chain(polygon: dict[str, Any], loop_edges: int) -> FloatArray:
    """Return the loop's vertices (loop_edges, 2), as many as asked for.

    Equally spaced on a circle, an ellipse or r = 1 + cos(n angle) / 5; on a hexagon
    stretched by 2 in the ratio 5 : 8 of its sides, so that every finer chain halves the
    edges of the one before.
    """
    if polygon["kind"] == "lobes":
        return lobed(polygon["n"], loop_edges)
    if polygon["kind"] == "ellipse":
        return ellipse(polygon["aspect"], loop_edges)
    corners = stretched_hexagon(polygon["factor"])
    parts = np.array([5, 8, 5, 5, 8, 5]) * (loop_edges // 36)
    ends = np.concatenate([corners, corners[:1]])
    at = np.concatenate([np.arange(n) / n + side for side, n in enumerate(parts)])
    return np.stack([np.interp(at, np.arange(7), ends[:, d]) for d in range(2)], axis=1)


def lobed(n: int, loop_edges: int) -> FloatArray:
    """Return corners (loop_edges, 2) at equal arc length on r = 1 + cos(n angle) / 5."""
    angle = np.linspace(0, 2 * np.pi, 200 * loop_edges + 1)
    radius = 1 + 0.2 * np.cos(n * angle)
    curve = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    steps = np.linalg.norm(np.diff(curve, axis=0), axis=1)
    length = np.concatenate([[0.0], np.cumsum(steps)])
    places = length[-1] * np.arange(loop_edges) / loop_edges
    return np.stack([np.interp(places, length, curve[:, d]) for d in range(2)], axis=1)


def lattice(parts: int, factor: float) -> Disk:
    """Return the triangular lattice in a hexagon, every side in `parts`, then stretched.

    On nested lattices spring films have a limit.
    """
    i, j = (grid.ravel() for grid in np.mgrid[-parts : parts + 1, -parts : parts + 1])
    inside = np.abs(i + j) <= parts
    number = np.full((2 * parts + 2, 2 * parts + 2), -1)
    number[i[inside] + parts, j[inside] + parts] = np.arange(inside.sum())
    x = np.stack([i + 0.5 * j, np.sqrt(0.75) * j, 0.0 * i], axis=1)[inside] / parts
    steps = ((0, 0), (1, 0), (0, 1), (1, -1))
    a, b, c, d = (number[i + parts + di, j + parts + dj] for di, dj in steps)
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, d, b], axis=1)])
    whole = (triangles >= 0).all(axis=1)
    return Disk.from_triangles(x * (factor, 1.0, 1.0), triangles[whole])


def prolong(coarse: Disk, loop: FloatArray, fine: Disk, in_plane: bool) -> FloatArray:
    """Return a shape (n_v, 3) on `fine` with the shape of `loop` (n_b, 3) on `coarse`.

    The loop is a periodic cubic spline in the arc length from its first vertex, which both
    meshes share; the film is the harmonic extension, or in the plane stays where it was.
    """
    length = np.concatenate([[0.0], np.cumsum(coarse.rest_lengths)])
    closed = np.concatenate([loop, loop[:1]])
    spline = CubicSpline(length / length[-1], closed, bc_type="periodic")
    x_loop = spline(np.concatenate([[0.0], np.cumsum(fine.rest_lengths)[:-1]]))
    if not in_plane:
        return make_film(fine, "dirichlet").carried(fine.shape, x_loop).x
    x = fine.x.copy()
    x[fine.loop] = x_loop
    return x


def shape_error(lengths: FloatArray, loop: FloatArray, exact: PlanarFilm) -> float:
    """Return the root mean square distance, in L, of `loop` (n_b, 3) from the exact loop.

    After the best rigid motion, and the best place on the loop to start counting from;
    lengths : (n_b,), of the loop from vertex to vertex.
    """
    places = np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
    weights = 0.5 * (lengths + np.roll(lengths, 1))

    def distance(phase: float) -> float:
        target = np.pad(exact.positions(places + phase), ((0, 0), (0, 1)))
        return _distance_up_to_motion(loop, target, weights)

    # The exact loop has a mirror and n equal lobes: half a lobe would do.
    first = np.linspace(0, 1 / exact.lobes, 24, endpoint=False)
    nearest = first[np.argmin([distance(phase) for phase in first])]
    width = 1 / (24 * exact.lobes)
    found = minimize_scalar(
        distance,
        bounds=(nearest - width, nearest + width),
        method="bounded",
        options={"xatol": 1e-10},
    )
    return float(min(found.fun, distance(float(nearest))))


def _distance_up_to_motion(x: FloatArray, y: FloatArray, weights: FloatArray) -> float:
    """Kabsch: the least root mean square distance of x and y (n, 3) after a motion."""
    a, b = x - weights @ x / weights.sum(), y - weights @ y / weights.sum()
    u, _, v = np.linalg.svd((a * weights[:, None]).T @ b)
    gap = np.square(a @ (u @ v) - b).sum(axis=1)
    return float(np.sqrt(weights @ gap / weights.sum()))


def gyration(lengths: FloatArray, loop: FloatArray) -> float:
    """Return the root mean square distance of a loop (n_b, 3) from its centre, in L.

    It stands for the shape where only a limit of numbers is to be had.
    """
    weights = 0.5 * (lengths + np.roll(lengths, 1))
    return float(np.sqrt(weights @ np.square(loop - weights @ loop).sum(axis=1)))


def _pairs(**polygon: Any) -> tuple[tuple[str, Any], ...]:
    return tuple(polygon.items())


_OVAL = _pairs(kind="ellipse", aspect=1.5)
_LONG = _pairs(kind="ellipse", aspect=2.0)
_LOBED = _pairs(kind="lobes", n=3)
_HEXAGON = _pairs(kind="stretched-hexagon", factor=2.0)

# sigma = 2 sqrt(3) k: the Dirichlet film that springs on equilateral triangles stand for.
_SPRING_LOAD = 700.0
SCENES = {
    scene.name: scene
    for scene in (
        Scene("disk, 1400", "area", 1400.0, _OVAL, lobes=2),
        Scene("two lobes, 1600", "area", 1600.0, _LONG, lobes=2),
        Scene("two lobes in the plane, 1600", "area", 1600.0, _LONG, True, 2),
        Scene("two lobes in the plane, 2000", "area", 2000.0, _LONG, True, 2),
        Scene("two lobes in the plane, 2400", "area", 2400.0, _LONG, True, 2),
        Scene(
            "three lobes in the plane, 4500", "area", 4500.0, _LOBED, True, 3, saddle=True
        ),
        Scene("hexagon x2, springs", "springs", _SPRING_LOAD, _HEXAGON),
        Scene("hexagon x2, dirichlet", "dirichlet", np.sqrt(12.0) * _SPRING_LOAD, _HEXAGON),
        *(
            Scene(
                f"disk's threshold {place}, {film}",
                film,
                math.nan,
                _pairs(kind="ellipse", aspect=1.0),
                threshold=multiple * math.pi**3,
                transverse=place == "across",
            )
            for film, place, multiple in (
                ("area", "in the plane", 48),
                ("area", "across", 96),
                ("dirichlet", "in the plane", 192),
                ("dirichlet", "across", 96),
            )
        ),
    )
}
