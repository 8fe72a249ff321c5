"""The eight of a thin line unloaded, on meshes as they are and refined at its contact."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence

import numpy as np

from eulerplateau.branches.conformal.contact_eight import reached, refined, touching
from eulerplateau.branches.conformal.touching import Touching
from eulerplateau.mesh import mesh_polygon
from eulerplateau.solvers import Problem, sweep

DIAMETER = 0.001
# From two lobes over the jump to the eight, and down again to the loads of the table.
WAY = (1850.0, 1860.0, 2000.0, 1860.0, 1600.0)
LOADS = (1200.0, 1000.0, 800.0, 600.0, 520.0)
VERTICES = (200, 400, 700, 960, 1200)
_NUMBERS = ("edges", "vertices", "status", "energy", "force", "seconds")


def exact_films() -> dict[float, Touching]:
    """Return the films without a mesh, by load, from that next to where they open."""
    values = {"diameter": DIAMETER, "twist_ratio": 0.0, "link": 0.0}
    loads = sorted(LOADS)
    films = [touching({**values, "load": loads[0]})]
    for load in loads[1:]:
        films.append(reached(films[-1], {**values, "load": load}))
    return {load: refined(film)[1] for load, film in zip(loads, films, strict=True)}


def table() -> Iterator[list[str]]:
    """Yield a head, then for every mesh and load what films are off by, plain and refined.

    Energy and force are relative to the film without a mesh, seconds those of one CPU.
    """
    heads = [f"{what}, {how}" for what in _NUMBERS for how in ("plain", "refined")]
    yield ["load", *heads]
    films = exact_films()
    for vertices in VERTICES:
        plain, finer = (_swept(vertices, films, refine=refine) for refine in (False, True))
        for load, one, other in zip(LOADS, plain, finer, strict=True):
            pairs = zip(one, other, strict=True)
            yield [f"{load:g}", *(text for pair in pairs for text in pair)]


def _swept(
    vertices: int, films: dict[float, Touching], *, refine: bool
) -> Sequence[list[str]]:
    """Return lines of the table's loads, of a mesh."""
    mesh = mesh_polygon("ellipse", aspect=2.0, vertices=vertices, grading=5.0)
    problem = Problem(mesh, "area", diameter=DIAMETER, refine=refine)
    lines, began = [], time.process_time()
    for found in sweep(problem, [*WAY, *LOADS]):
        now = time.process_time()
        seconds, began = now - began, now
        if found.load not in films:
            continue
        exact, contacts = films[found.load], found.contacts
        force = contacts.force / exact.force - 1 if contacts else np.nan
        lines.append(
            [
                str(len(found.shape.loop)),
                str(len(found.shape.x)),
                str(found.status.value),
                f"{found.energy / exact.energy - 1:.1e}",
                f"{force:.1e}",
                f"{seconds:.1f}",
            ]
        )
    return lines
