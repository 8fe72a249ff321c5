"""Random starts on a mesh, with random rods: where they end, and whether they should."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from eulerplateau.exact.conformal import BUCKLING
from eulerplateau.solvers import Problem, Status, solve
from eulerplateau.solvers.start import smooth_kick
from eulerplateau.threads import one_thread
from scripts.studies.welded_loop.answers import disk_link
from scripts.studies.welded_loop.curves import LOADS, Row, widest_at
from scripts.studies.welded_loop.meshes import ellipse

STARTS = 200
# Loop edges; a film is resolved whose waist is above three of them.
EDGES = 72
# Those that pinch where a stable film is known begin again on finer meshes.
FINER = (96, 144)
_WIDE = 3 / EDGES
# Times a kick of 1e-3 L, the largest: starts are up to a tenth of L out of their plane.
_KICKS = 100.0


@dataclass(frozen=True)
class Case:
    """A start: a load of curves.LOADS, a rod, and a seed of the displacement."""

    load: float
    twist_ratio: float
    link: float
    seed: int


@dataclass(frozen=True)
class End:
    """Where it ended; `index` is None where nobody looked."""

    case: Case
    status: str
    index: int | None


def cases() -> list[Case]:
    """Return cases with |Lk| up to 1.5, C/B from 0.1 to 1 and loads from 500 to 2300."""
    drawn = np.random.default_rng(14)
    loads = [load for load in LOADS if load >= 500]
    return [
        Case(
            load=float(drawn.choice(loads)),
            twist_ratio=float(drawn.uniform(0.1, 1.0)),
            link=float(drawn.uniform(-1.5, 1.5)),
            seed=seed,
        )
        for seed in range(STARTS)
    ]


def run(case: Case, edges: int = EDGES) -> End:
    """Solve one case, on a mesh of so many loop edges."""
    mesh = ellipse(edges)
    problem = Problem(mesh, "area", twist_ratio=case.twist_ratio, link=case.link)
    with one_thread():
        rng = np.random.default_rng(case.seed)
        kick = rng.uniform(0, _KICKS) * smooth_kick(mesh.x[mesh.loop], mesh.x, rng, 2)
        found = solve(problem, case.load, mesh.shape.moved(mesh.x + kick))
    return End(case, found.status.value, found.n_unstable)


def expected(case: Case, curves: dict[float, list[Row]]) -> bool:
    """Return whether a stable film with a wide waist exists at a case's load and link."""
    link = abs(case.link)
    if case.load < BUCKLING and link < disk_link(case.load, case.twist_ratio):
        return True
    return widest_at(curves[case.load], case.twist_ratio, link) > _WIDE


def again(ends: list[End], curves: dict[float, list[Row]]) -> list[tuple[str, ...]]:
    """Return where those end on finer meshes that pinched beside a known stable film."""
    head = ("status", "load", "C/B", "Lk", "loop edges", "unstable modes")
    pinched = [
        end.case
        for end in ends
        if end.status == Status.PINCHED.value and expected(end.case, curves)
    ]
    rows = [(case, edges, run(case, edges)) for case in pinched for edges in FINER]
    return [
        head,
        *(
            (
                end.status,
                f"{case.load:g}",
                f"{case.twist_ratio:.4f}",
                f"{case.link:.4f}",
                str(edges),
                str(end.index),
            )
            for case, edges, end in rows
        ),
    ]


def tabulated(ends: list[End], curves: dict[float, list[Row]]) -> list[tuple[str, ...]]:
    """Return how many ended how, by whether a stable film is known to exist."""
    counted = Counter(
        (end.status, str(end.index), expected(end.case, curves)) for end in ends
    )
    head = ("status", "unstable modes", "a stable film exists", "starts")
    rows = [
        (status, index, "yes" if known else "no", str(number))
        for (status, index, known), number in sorted(counted.items())
    ]
    return [head, *rows]
