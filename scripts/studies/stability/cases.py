"""Stiff and extreme cases: disks that are badly scaled, badly shaped or badly started.

A case is a disk in the units it comes in, with the displacement, in units of L, that takes
its rest shape to the start. Every change of units, place or numbering takes the start
along, so that the same solver has the same work to do.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.errors import MeshError
from eulerplateau.film import FILM_LOADS
from eulerplateau.mesh import Disk, measure
from eulerplateau.solvers import Equilibrium, Problem, Status, solve, tangent_model

# A film that the cases are to be tried on too is one more word here.
FILMS = ("springs", "dirichlet", "area")
Spoiler = Callable[["DisplacedDisk", float], "DisplacedDisk"]
SOLVERS = ("newton", "cg")


@dataclass(frozen=True)
class DisplacedDisk:
    """Points (n_v, 3) in any unit, triangles (n_t, 3), displacement (n_v, 3) in L."""

    points: FloatArray
    triangles: IntArray
    displacement: FloatArray

    @property
    def mesh(self) -> Disk:
        """The mesh in units of L. Raises MeshError."""
        return Disk.from_triangles(self.points, self.triangles)


@dataclass(frozen=True)
class Outcome:
    """What a case came to; `refusal` is the mesh's, `found` the solver's."""

    refusal: MeshError | None = None
    found: Equilibrium | None = None
    measures: dict[str, float] | None = None
    condition: float = np.nan

    @property
    def word(self) -> str:
        """One word on what happened."""
        return "refused" if self.found is None else self.found.status.value

    @property
    def balanced(self) -> bool:
        """Whether it is an equilibrium, resolved or not."""
        return self.word in (Status.CONVERGED.value, Status.UNRESOLVED.value)


def disk(points: FloatArray, triangles: IntArray, seed: int = 1) -> DisplacedDisk:
    """Return a flat disk (n_v, 2) or (n_v, 3), its start 1e-3 L across the plane z = 0."""
    flat = np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))])
    noise = np.random.default_rng(seed).standard_normal(len(points))
    return DisplacedDisk(flat, triangles, 1e-3 * np.outer(noise, [0.0, 0.0, 1.0]))


def own_load(film: str, tension: float) -> float:
    """Return the load of a film that is under this tension sigma L^3 / alpha."""
    return tension / FILM_LOADS[film].tension_per_load


def run(case: DisplacedDisk, film: str, load: float, solver: str = "newton") -> Outcome:
    """Return what a solver makes of a case, within its own limit of iterations."""
    try:
        mesh = case.mesh
        problem = Problem(mesh, film)
    except MeshError as error:
        return Outcome(refusal=error)
    found = solve(problem, load, mesh.x + case.displacement, solver=solver)
    if not np.isfinite([found.energy, *found.shape.x.ravel()]).all():
        return Outcome(found=found)
    outcome = Outcome(None, found, asdict(measure(mesh, found.shape)))
    if not outcome.balanced:
        return outcome
    return replace(outcome, condition=condition(problem, found))


def condition(problem: Problem, found: Equilibrium) -> float:
    """Return the largest over the smallest eigenvalue of the second variation, by size.

    Rigid motions left out. It is the factor by which rounding of the forces may be
    magnified in the positions; infinite where a motion costs nothing, as of a square.
    """
    energy = problem.film.of_loop(found.shape).energy(problem.loop, found.load)
    model = tangent_model(energy, found.shape.x_loop)
    values = np.abs(model.eigenvalues)
    if not len(values):
        return 1.0
    return float(values.max() / values.min()) if values.min() else math.inf


# The same film, otherwise given -----------------------------------------------------------


def scaled(case: DisplacedDisk, factor: float) -> DisplacedDisk:
    """Return the disk in other units."""
    return replace(case, points=case.points * factor)


def rotated(case: DisplacedDisk, seed: int = 7) -> DisplacedDisk:
    """Return the disk turned by a rotation about no special axis."""
    q, r = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    q = q * np.sign(np.diag(r))
    q = q * np.sign(np.linalg.det(q))
    return replace(case, points=case.points @ q.T, displacement=case.displacement @ q.T)


def offset(case: DisplacedDisk, sizes: float) -> DisplacedDisk:
    """Return the disk moved by so many times its size, in no special direction."""
    size = float(np.linalg.norm(np.ptp(case.points, axis=0)))
    return replace(case, points=case.points + sizes * size * np.array([0.6, -0.64, 0.48]))


def renumbered(case: DisplacedDisk, seed: int = 2) -> DisplacedDisk:
    """Return the disk with vertices, triangles and their corners in another order."""
    rng = np.random.default_rng(seed)
    old = rng.permutation(len(case.points))
    triangles = np.argsort(old)[case.triangles]
    triangles = np.roll(triangles, 1, axis=1)[rng.permutation(len(triangles))]
    return DisplacedDisk(case.points[old], triangles, case.displacement[old])


def single(case: DisplacedDisk) -> DisplacedDisk:
    """Return the disk as a file in single precision gives it."""
    return DisplacedDisk(
        case.points.astype(np.float32), case.triangles.astype(np.int32), case.displacement
    )


# Bad shapes -------------------------------------------------------------------------------


def stretched(case: DisplacedDisk, factor: float) -> DisplacedDisk:
    """Return the disk drawn out along x, its triangles with it."""
    return replace(case, points=case.points * [factor, 1.0, 1.0])


def polygon(sides: int) -> DisplacedDisk:
    """Return a regular polygon with one vertex in the middle."""
    angle = 2 * np.pi * np.arange(sides) / sides
    rim = np.column_stack([np.cos(angle), np.sin(angle)])
    corner = np.arange(sides)
    fan = np.column_stack([np.full(sides, sides), corner, (corner + 1) % sides])
    return disk(np.concatenate([rim, np.zeros((1, 2))]), fan)


def needle(case: DisplacedDisk, ratio: float) -> DisplacedDisk:
    """Return the disk with two neighbours inside brought together: triangles 1 : ratio."""
    a, b, _ = case.triangles[_middle(case)]
    points = case.points.copy()
    points[b] = points[a] + ratio * (points[b] - points[a])
    return replace(case, points=points)


def sliver(case: DisplacedDisk, ratio: float) -> DisplacedDisk:
    """Return the disk with a triangle 1 : ratio laid along an inner edge.

    A new vertex splits the triangle on one side of the edge next to the edge's middle. For
    a film that is linear in each triangle that changes nothing in the limit of ratio 0.
    """
    split = _middle(case)
    a, b, apex = case.triangles[split]
    middle, new = 0.5 * (case.points[a] + case.points[b]), len(case.points)
    along = case.points[b] - case.points[a]
    place = middle + ratio * np.cross([0.0, 0.0, 1.0], along)
    kept = np.delete(case.triangles, split, axis=0)
    made = np.array([[a, b, new], [b, apex, new], [apex, a, new]])
    return DisplacedDisk(
        np.concatenate([case.points, place[None]]),
        np.concatenate([kept, made]),
        np.concatenate([case.displacement, np.zeros((1, 3))]),
    )


def short_edge(case: DisplacedDisk, ratio: float) -> DisplacedDisk:
    """Return the disk with one loop edge shortened by a factor."""
    start, end = case.mesh.loop[2:4]
    points = case.points.copy()
    points[end] = points[start] + ratio * (points[end] - points[start])
    return replace(case, points=points)


# Bad starts -------------------------------------------------------------------------------


def crumpled(case: DisplacedDisk, size: float, seed: int = 3) -> DisplacedDisk:
    """Return the disk with every vertex displaced by so many L, in all directions."""
    noise = np.random.default_rng(seed).standard_normal(case.points.shape)
    return replace(case, displacement=size * noise)


def crossed(case: DisplacedDisk) -> DisplacedDisk:
    """Return the disk started from a loop that lies in the plane as an exact eight."""
    angle = _angles(case)
    eight = np.column_stack([0.5 * np.sin(2 * angle), np.sin(angle), 0 * angle])
    return _started(case, eight / (2 * np.pi))


def doubly_covered(case: DisplacedDisk) -> DisplacedDisk:
    """Return the disk started from a loop that runs twice round an exact circle."""
    angle = 2 * _angles(case)
    circle = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    return _started(case, circle / (4 * np.pi))


def started_as(case: DisplacedDisk, value: float) -> DisplacedDisk:
    """Return the disk with one coordinate of its start replaced, by NaN or infinity."""
    displacement = case.displacement.copy()
    displacement[case.mesh.loop[3], 1] = value
    return replace(case, displacement=displacement)


def as_a_point(case: DisplacedDisk) -> DisplacedDisk:
    """Return the disk started from a single point."""
    return replace(case, displacement=-case.mesh.x)


def _angles(case: DisplacedDisk) -> FloatArray:
    return 2 * np.pi * np.concatenate([[0.0], np.cumsum(case.mesh.rest_lengths)[:-1]])


def _started(case: DisplacedDisk, x_loop: FloatArray) -> DisplacedDisk:
    mesh = case.mesh
    displacement = np.zeros_like(mesh.x)
    displacement[mesh.loop] = x_loop - mesh.x[mesh.loop]
    return replace(case, displacement=displacement)


def _middle(case: DisplacedDisk) -> int:
    """Return the triangle next to the centre."""
    middles = case.points[case.triangles].mean(axis=1)
    return int(np.argmin(np.linalg.norm(middles - middles.mean(axis=0), axis=1)))
