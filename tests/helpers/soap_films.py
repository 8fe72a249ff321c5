"""Twisted soap films for tests: points of the branches that leave the plane."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import csr_array

from eulerplateau.arrays import FloatArray
from eulerplateau.branches import FilmFamily, film_point
from eulerplateau.branches.continuation import follow, released
from eulerplateau.branches.control import Direction, StepControl
from eulerplateau.branches.film_family import family_near
from eulerplateau.branches.point import BranchPoint, correct
from eulerplateau.branches.special import SpecialPoint, special_points
from eulerplateau.exact.conformal.equilibrium import ConformalFilm
from eulerplateau.film.tiling import Tiling
from eulerplateau.mesh.disk import Disk
from eulerplateau.mesh.shape import Shape
from eulerplateau.solvers import Problem, solve
from tests.helpers import shapes

# The disk gives way across its plane to cos 2 phi here (sigma_hat).
DISK_TWISTS = 96 * np.pi**3
CONTROL = StepControl(window=(1000.0, 4000.0), unit=2000.0)
# A film is made anew at its own shape until it is at rest there, but so often at most.
_TIMES = 6


def irregular_disk(rings: int, jitter: float = 0.15) -> Disk:
    """A disk without symmetry inside its loop of even edges."""
    points, triangles = shapes.disk_points(rings, jitter)
    points[-6 * rings :] = shapes.disk_points(rings)[0][-6 * rings :]
    return shapes.mesh_of(points, triangles)


def hessian(tiling: Tiling, x: FloatArray) -> csr_array:
    """The area's Hessian (3 n_v, 3 n_v) at a shape; vertex v has rows 3 v ... 3 v + 2."""
    i, k = tiling.pairs
    row = 3 * i[:, None, None] + np.arange(3)[:, None]
    column = 3 * k[:, None, None] + np.arange(3)
    blocks = tiling.hessian(tiling.sides(x))
    row, column, blocks = np.broadcast_arrays(row, column, blocks)
    entries = (blocks.ravel(), (row.ravel(), column.ravel()))
    return csr_array(entries, shape=(x.size, x.size))


def turn(angle: float) -> FloatArray:
    """The rotation (3, 3) about the z axis."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def two_lobed(mesh: Disk, load: float, angle: float = 0.0) -> BranchPoint:
    """The planar two-lobed film, its long axis turned by `angle` against the mesh."""
    problem = Problem(mesh, "area")
    oval = turn(angle) @ np.diag([1.25, 0.8, 1.0]) @ turn(angle).T
    found = solve(problem, load, mesh.x @ oval)
    assert found.converged
    return film_point(found, problem, CONTROL)


def shape(point: BranchPoint) -> Shape:
    """The whole film at a point of its branch."""
    assert isinstance(point.family, FilmFamily)
    return point.family.film.shape(point.x)


def twist_point(planar: BranchPoint) -> SpecialPoint:
    """The first bifurcation above a point of the planar branch."""
    before = planar
    for after in follow(planar, CONTROL):
        for special in special_points(before, after, CONTROL):
            return special
        before = after
    raise AssertionError("no bifurcation met")


def on_the_exact_loop(mesh: Disk, exact: ConformalFilm, angle: float) -> BranchPoint:
    """The film on a mesh that is next to an exact one, turned by `angle` on the mesh."""
    problem, whole = Problem(mesh, "area"), 2 * np.pi
    phi = np.linspace(0.0, whole, 4097)
    loop = exact.basis.at(exact.coefficients, phi).x
    arc = np.cumsum(np.linalg.norm(np.diff(loop, axis=0, prepend=loop[:1]), axis=1))
    first = mesh.x[mesh.loop[0]]
    place = np.cumsum(mesh.rest_lengths) - mesh.rest_lengths
    place += (np.arctan2(first[1], first[0]) - angle) / whole
    x_loop = [np.interp(place, arc / arc[-1], x, period=1.0) for x in loop.T]
    spanned = Problem(mesh, "dirichlet").film.of_loop(mesh.shape)
    family, x = family_near(problem, spanned.shape(np.stack(x_loop, axis=1)))
    still = Direction(np.zeros_like(x), CONTROL.unit)
    point = correct(family, x, exact.load, still, CONTROL)
    assert point is not None
    point = released(point, CONTROL)
    return _made_anew(point, point.x, exact.load, still)


def twisted_disk(mesh: Disk, size: float, angle: float = 0.0) -> BranchPoint:
    """The point of the branch that leaves the disk at 96 pi^3, twisted by so much.

    `size` is the r.m.s. displacement along cos 2 (phi - angle), in units of L.
    """
    problem = Problem(mesh, "area")
    family = FilmFamily(problem, problem.film.of_loop(mesh.shape))
    circle = mesh.x[mesh.loop]
    phi = np.arctan2(circle[:, 1], circle[:, 0])
    mode = np.outer(np.cos(2 * (phi - angle)), [0.0, 0.0, 1.0])
    mode /= np.sqrt(problem.loop.mean_lengths @ (mode**2).sum(axis=1))
    along = Direction(mode, 0.0)
    point = correct(family, circle + size / 3 * mode, DISK_TWISTS, along, CONTROL)
    assert point is not None
    for _ in range(2):
        point = _made_anew(point, point.x + size / 3 * mode, point.value, along)
    return point


def _made_anew(
    point: BranchPoint, guess: FloatArray, load: float, direction: Direction
) -> BranchPoint:
    """The equilibrium near a guess (n_b, 3), on a film made near the film itself."""
    for _ in range(_TIMES):
        there = point.family.near(point.x)
        found = correct(there, guess, load, direction, CONTROL)
        assert found is not None
        if found.corrections == 0:
            break
        point = replace(found, arclength=point.arclength)
        guess, load = point.x, point.value
    return point


def mesh_of(point: BranchPoint, mesh: Disk) -> Disk:
    """The mesh with the triangles that the film of a point has come to."""
    return replace(mesh, triangles=shape(point).triangles)
