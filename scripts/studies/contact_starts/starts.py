"""A random start of a loop with a diameter: what it is, and what becomes of it."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cache
from math import pi

import numpy as np
from scipy.linalg import LinAlgError

from eulerplateau.arrays import FloatArray
from eulerplateau.film import FILM_LOADS
from eulerplateau.loop import close_with_lengths, strands_of
from eulerplateau.mesh import Disk, Shape
from eulerplateau.solvers import RESIDUAL_TOLERANCE, Equilibrium, Problem, solve
from eulerplateau.solvers.contact.separation import separated
from eulerplateau.solvers.start import smooth_kick
from scripts.studies.contact_eight.on_meshes import round_disk
from scripts.studies.contact_starts.brute_force import least_distance

FILMS = tuple(FILM_LOADS)
KINDS = ("turned", "drawn")
EDGES = 48
ASPECTS = (1.0, 1.6)
DIAMETERS = 1e-3, 0.05
TENSIONS = 100.0, 6000.0
# Times a kick of 1e-3 L, the largest: turned starts are also displaced by a tenth of L.
_KICKS = 100.0
# A start that is drawn at random has so many harmonics, and is flattened, so that strands
# come near each other, down to this factor.
_HARMONICS = 3
_FLATTEST = 0.01
# By which part of the diameter strands may overlap; which part of the largest force a
# contact may pull with; what the energy may rise by from rounding, and in one step what
# must fall.
OVERLAP, PULL, RISE, MERIT = 1e-5, RESIDUAL_TOLERANCE, 1e-9, 1e-12
FAILURES = ("not parted", "overlaps", "pulls", "merit rises", "rises")


@dataclass(frozen=True)
class Case:
    """A film, a tension sigma L^3 / alpha, a diameter, and a start, all by its seed."""

    seed: int
    film: str
    kind: str
    aspect: float
    tension: float
    diameter: float

    @property
    def load(self) -> float:
        """The film's own load: that of springs under the same tension."""
        return self.tension / FILM_LOADS[self.film].tension_per_load


@dataclass(frozen=True)
class End:
    """What became of a case.

    Attributes
    ----------
    status : the equilibrium's; "not parted" where no loop without overlaps is near the
        start, or the name of an exception
    overlaps : by which part of the diameter strands overlap, by brute force: at the start,
        when they have been parted, at the end; not positive where they do not
    contacts : how many there are
    pull : the lowest of their forces over the largest force in the loop; 0 without any
    rise : the energy at the end over that of the parted start, less 1
    risen : the largest rise in one step of what must fall, the energy or the merit
        function, over the energy at the end
    seconds : CPU time of the solution
    """

    case: Case
    status: str
    overlaps: tuple[float, float, float] = (np.nan, np.nan, np.nan)
    contacts: int = 0
    pull: float = 0.0
    rise: float = np.nan
    risen: float = 0.0
    seconds: float = 0.0

    @property
    def converged(self) -> bool:
        """Whether it is said to be an equilibrium."""
        return self.status == "converged"

    @property
    def failures(self) -> list[str]:
        """What is not as it should be, of `FAILURES`."""
        found = {
            "not parted": not self.overlaps[1] <= OVERLAP,
            "overlaps": self.overlaps[2] > OVERLAP,
            "pulls": self.pull < -PULL,
            "merit rises": self.risen > MERIT,
            "rises": self.rise > RISE,
        }
        return [name for name, failed in found.items() if failed]


def case(seed: int) -> Case:
    """Return the case of a seed: films and kinds of starts take turns."""
    rng = np.random.default_rng([15, seed])

    def between(least: float, most: float) -> float:
        return float(np.exp(rng.uniform(np.log(least), np.log(most))))

    return Case(
        seed=seed,
        film=FILMS[seed % len(FILMS)],
        kind=KINDS[seed // len(FILMS) % len(KINDS)],
        aspect=float(rng.choice(ASPECTS)),
        tension=between(*TENSIONS),
        diameter=between(*DIAMETERS),
    )


@cache
def disk_of(aspect: float) -> Disk:
    """Return the mesh of a disk, or of an ellipse so many times as long as it is wide."""
    disk = round_disk(EDGES)
    return Disk.from_triangles(disk.x * [aspect, 1.0, 1.0], disk.triangles)


def loop_of(disk: Disk, case: Case) -> FloatArray:
    """Return the loop (n, 3) that a case begins with, however long its edges are."""
    rng = np.random.default_rng(case.seed)
    if case.kind == "drawn":
        angle = 2 * pi * np.cumsum(disk.rest_lengths)[:, None]
        k = np.arange(1, _HARMONICS + 1)
        waves = np.hstack([np.cos(k * angle), np.sin(k * angle)])
        sizes = rng.standard_normal((2 * _HARMONICS, 3)) / np.tile(k**2, 2)[:, None]
        flatter = np.exp(rng.uniform(np.log(_FLATTEST), 0.0))
        drawn: FloatArray = waves @ sizes * [1.0, 1.0, flatter] / (2 * pi)
        return drawn
    x = disk.x[disk.loop] - disk.x[disk.loop].mean(axis=0)
    along = x[:, 0] / np.abs(x[:, 0]).max()
    angle = pi * rng.uniform(0.0, 1.2) * np.tanh(along / 0.35)
    turned = np.stack([x[:, 0], x[:, 1] * np.cos(angle), x[:, 1] * np.sin(angle)], axis=1)
    kicks = [smooth_kick(turned, turned, rng, axis) for axis in range(3)]
    kicked: FloatArray = turned + np.tensordot(rng.uniform(0.0, _KICKS, 3), kicks, axes=1)
    return kicked


def run(case: Case) -> End:
    """Solve a case, and look at what it comes to; what is raised is an end too."""
    try:
        return _ended(case)
    except Exception as error:
        return End(case, type(error).__name__)


def _ended(case: Case) -> End:
    disk = disk_of(case.aspect)
    problem = Problem(disk, case.film, diameter=case.diameter)
    tied = problem.tied_film()
    assert tied is not None
    loop = close_with_lengths(problem.loop, loop_of(disk, case))
    if loop is None:
        return End(case, "no loop")
    first = _overlap(case, loop, disk.rest_lengths)
    parted = separated(strands_of(problem.loop), loop)
    if parted is None:
        return End(case, "not parted", overlaps=(first, np.nan, np.nan))
    began = time.process_time()
    found = solve(problem, case.load, tied.shape(loop))
    seconds = time.process_time() - began
    before = _energy_of_start(problem, tied.shape(parted), case.load)
    x_loop, lengths = found.shape.x_loop, problem.loop_of(found.shape).rest_lengths
    last = _overlap(case, x_loop, lengths)
    return End(
        case,
        found.status.value,
        overlaps=(first, _overlap(case, parted, disk.rest_lengths), last),
        contacts=0 if found.contacts is None else len(found.contacts),
        pull=_pull(found),
        rise=found.energy / before - 1,
        risen=0.0 if found.contacts is None else found.contacts.risen / found.energy,
        seconds=seconds,
    )


def _overlap(case: Case, x_loop: FloatArray, rest_lengths: FloatArray) -> float:
    """Return by which part of the diameter strands overlap, negative where they do not."""
    least = least_distance(x_loop, rest_lengths, 0.5 * pi * case.diameter)
    return 1 - least / case.diameter


def _pull(found: Equilibrium) -> float:
    if found.contacts is None or not len(found.contacts):
        return 0.0
    forces = found.contacts.forces
    return float(forces.min() / max(forces.max(), np.abs(found.tensions).max()))


def _energy_of_start(problem: Problem, shape: Shape, load: float) -> float:
    """Return the energy of a loop with its film at rest; if there is none, the shape's."""
    film = problem.film
    try:
        near = film.prepared(film.carried(shape, shape.x_loop))
        shape = film.of_loop(near).shape(shape.x_loop)
    except LinAlgError:
        pass  # the shape has a larger area than a soap film on its loop
    return film.energy_gradient(shape, load)[0] + problem.bending_energy(shape)[0]
