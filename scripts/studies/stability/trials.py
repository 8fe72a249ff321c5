"""The trials: extreme cases, and what each is held against."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from eulerplateau.arrays import FloatArray, IntArray
from eulerplateau.solvers import Problem, Status
from scripts.studies.common import make_mesh
from scripts.studies.stability import cases
from scripts.studies.stability.cases import DisplacedDisk, Outcome

# Flat and long (springs: twisted) on the hexagon stretched to twice its length; below the
# disk's first threshold, where there is one minimum only.
# A film of true area has two flat lobes there.
TENSION, ONE_MINIMUM = {"springs": 2600.0, "dirichlet": 2600.0, "area": 1700.0}, 1000.0
LOADS = (0.0, 1e-12, 1e-6, 1e5, 1e6, 1e8, 1e12)
MODULI = (1e-3, 1e-6, 1e-9)
# Finer meshes than this are not tried as references.
_LARGEST = 10_000

TWIN, BARE, FINER = "twin", "bare loop", "finer mesh"


@dataclass(frozen=True)
class Trial:
    """One case on one film: what is solved, and what it is compared with.

    Against TWIN that is `twin` at the same load, by Newton; against BARE the film-free
    loop's energy plus the load times its film's; against FINER the same state followed to
    a mesh that resolves it, or the finest that is tried.
    """

    group: str
    name: str
    film: str
    load: float
    case: DisplacedDisk
    against: str = TWIN
    twin: DisplacedDisk | None = None
    solver: str = "newton"


@dataclass(frozen=True)
class Row:
    """What a trial came to; errors are NaN where there is nothing to compare."""

    group: str
    name: str
    film: str
    solver: str
    load: float
    happened: str
    iterations: int
    against: str
    energy_error: float
    shape_error: float
    eigenvalue_error: float
    condition: float


def trials(film: str) -> Iterator[Trial]:
    """Yield all trials of a film."""
    base = hexagon(2.0)
    own = cases.own_load(film, TENSION[film])
    yield from _loads(film, base)
    for factor in (5.0, 20.0, 50.0):
        yield _twinned("stretched polygon", f"{factor:g}:1", film, own, hexagon(factor))
    for sides in (3, 4, 5, 6):
        polygon = cases.polygon(sides)
        trial = partial(Trial, "few loop vertices", f"{sides}", film)
        yield trial(cases.own_load(film, ONE_MINIMUM), polygon, FINER)
    for make in (cases.needle, cases.sliver):
        name = f"{make.__name__} 1 : 1e-8"
        yield _twinned("slivers", name, film, own, make(base, 1e-8))
    for ratio in (1e-2, 1e-3, 1e-4, 1e-6):
        case = cases.short_edge(base, ratio)
        yield _twinned("one short loop edge", f"{ratio:g} of the others", film, own, case)
    for name, change in _CHANGES.items():
        yield Trial("same film", name, film, own, change(base), twin=base)
    soft = cases.own_load(film, ONE_MINIMUM)
    for name, change in _STARTS.items():
        for solver in cases.SOLVERS:
            case = change(base)
            yield Trial("start", name, film, soft, case, twin=base, solver=solver)


def row(trial: Trial) -> Row:
    """Carry out a trial."""
    outcome = cases.run(trial.case, trial.film, trial.load, trial.solver)
    reference, name = _reference(trial, outcome)
    return Row(
        group=trial.group,
        name=trial.name,
        film=trial.film,
        solver=trial.solver,
        load=trial.load,
        happened=outcome.word if outcome.refusal is None else f"refused: {outcome.refusal}",
        iterations=0 if outcome.found is None else outcome.found.iterations,
        against=name,
        energy_error=_energy_error(trial, outcome, reference),
        shape_error=_shape_error(outcome, reference) if trial.against == TWIN else np.nan,
        eigenvalue_error=_eigenvalue_error(trial, outcome, reference),
        condition=outcome.condition,
    )


def hexagon(factor: float) -> DisplacedDisk:
    """Return the paper's kind of mesh: a hexagon stretched along a diagonal."""
    polygon = {"kind": "stretched-hexagon", "factor": factor}
    mesh = make_mesh(polygon=polygon, vertices=474)
    return cases.disk(mesh.x, mesh.triangles)


def _twinned(group: str, name: str, film: str, load: float, case: DisplacedDisk) -> Trial:
    """A trial against the same disk, turned and renumbered: rounding shows, and no more."""
    return Trial(group, name, film, load, case, twin=_turned(case))


def _turned(case: DisplacedDisk) -> DisplacedDisk:
    return cases.renumbered(cases.rotated(case))


def _loads(film: str, base: DisplacedDisk) -> Iterator[Trial]:
    for load in LOADS:
        against = BARE if load < 1 else FINER
        yield Trial("load", f"{load:g}", film, load, base, against)
    for alpha in MODULI:
        load = cases.own_load(film, TENSION[film]) / alpha
        yield Trial("alpha to 0", f"{alpha:g}", film, load, base, FINER)


_CHANGES: dict[str, Callable[[DisplacedDisk], DisplacedDisk]] = {
    "1e-9 m": partial(cases.scaled, factor=1e-9),
    "1e9 m": partial(cases.scaled, factor=1e9),
    "2^-30 m": partial(cases.scaled, factor=2.0**-30),
    "rotated": cases.rotated,
    "renumbered": cases.renumbered,
    **{f"offset {d:g} sizes": partial(cases.offset, sizes=d) for d in (1e2, 1e4, 1e8)},
    "single precision": cases.single,
}
_STARTS: dict[str, Callable[[DisplacedDisk], DisplacedDisk]] = {
    "crumpled by 0.05 L": partial(cases.crumpled, size=0.05),
    "crumpled by 0.5 L": partial(cases.crumpled, size=0.5),
    "crossed": cases.crossed,
    "doubly covered": cases.doubly_covered,
    "a point": cases.as_a_point,
    "infinite": partial(cases.started_as, value=np.inf),
}


def _reference(trial: Trial, outcome: Outcome) -> tuple[Outcome, str]:
    """Return what a trial is compared with, and what that is called in the table."""
    if trial.against == BARE:
        return cases.run(trial.case, trial.film, 0.0), BARE
    if trial.against == TWIN:
        assert trial.twin is not None
        return cases.run(trial.twin, trial.film, trial.load), TWIN
    case, found = trial.case, outcome
    while found.word == Status.UNRESOLVED.value and 4 * len(case.points) < _LARGEST:
        assert found.found is not None
        case = refined(case, found.found.shape.x)
        found = cases.run(case, trial.film, trial.load)
    return found, f"{len(case.points)} vertices, {found.word}"


def refined(case: DisplacedDisk, x: FloatArray) -> DisplacedDisk:
    """Return the disk with each triangle cut in four, started from the shape x (n_v, 3)."""
    mesh = case.mesh
    edges, n = mesh.edges, mesh.n_v
    number = {(a, b): n + k for k, (a, b) in enumerate(edges.tolist())}
    made: list[tuple[int, int, int]] = []
    for a, b, c in mesh.triangles.tolist():
        ab, bc, ca = (number[min(p), max(p)] for p in ((a, b), (b, c), (c, a)))
        made += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    points = _with_middles(mesh.x, edges)
    fine = DisplacedDisk(points, np.array(made), np.zeros_like(points))
    return replace(fine, displacement=_with_middles(x, edges) - fine.mesh.x)


def _with_middles(points: FloatArray, edges: IntArray) -> FloatArray:
    return np.concatenate([points, points[edges].mean(axis=1)])


def _energy_error(trial: Trial, outcome: Outcome, reference: Outcome) -> float:
    one, two = outcome.found, reference.found
    if one is None or two is None or not outcome.balanced:
        return np.nan
    expected = two.energy
    if trial.against == BARE:
        film = Problem(trial.case.mesh, trial.film).film
        expected += trial.load * film.energy_gradient(two.shape, 1.0)[0]
    return abs(one.energy / expected - 1)


def _shape_error(outcome: Outcome, reference: Outcome) -> float:
    """Return the largest difference of the measures, relative where they are above 1.

    All but the smallest angle, which is the mesh's and not the shape's.
    """
    one, two = outcome.measures, reference.measures
    if one is None or two is None or not outcome.balanced:
        return np.nan
    return max(
        abs(one[key] - two[key]) / max(1.0, abs(two[key]))
        for key in two
        if key != "min_angle"
    )


def _eigenvalue_error(trial: Trial, outcome: Outcome, reference: Outcome) -> float:
    one, two = outcome.found, reference.found
    if trial.against != TWIN or one is None or two is None or not outcome.balanced:
        return np.nan
    if one.lowest_eigenvalue is None or two.lowest_eigenvalue is None:
        return np.nan
    return abs(one.lowest_eigenvalue / two.lowest_eigenvalue - 1)
