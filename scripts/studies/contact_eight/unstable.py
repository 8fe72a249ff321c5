"""An eight in contact that is no minimum, without a mesh and on meshes.

Where the moment M of twist falls with the writhe Wr, turning a rod of soft twist comes to a
fold. The films beyond it are met by stiffer rods, which turn as they writhe: an equilibrium
of one rod is one of any other that is turned by

    Lk = Wr + M / (2 pi C/B),

as M is. Whether it is a minimum depends on how soft the twist is.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from eulerplateau.branches import equilibrium_near
from eulerplateau.branches.conformal import ThickEight
from eulerplateau.branches.conformal.contact_eight import measured, reached, touching
from eulerplateau.branches.conformal.touching import Touching, settled
from eulerplateau.mesh import Disk
from eulerplateau.solvers import Equilibrium, Problem
from scripts.studies.contact_eight.on_meshes import (
    EDGES,
    eight_on,
    limit,
    off,
    orders,
    round_disk,
    shown,
)

DIAMETER, LOAD = 0.02, 600.0
# C / B of a rod that turns as it writhes, its link, and C / B of one that does not.
STIFF, LINK, SOFT = 3.0, 1.55, 0.1


def same_of(film: Touching, twist_ratio: float) -> Touching:
    """Return a film in contact as that of a rod of another C / B, turned as need be."""
    values, load = film.values, film.values["load"]
    writhe = film.family.twist(load).writhe(film.x)
    share = values["twist_ratio"] / twist_ratio
    link = writhe + share * (values["link"] - writhe)
    family = replace(
        film.family, values={**values, "twist_ratio": twist_ratio, "link": link}
    )
    found = settled(replace(film, family=family))
    if found is None:
        raise ArithmeticError("the film of another rod is none")
    return found


def rods() -> tuple[ThickEight, ThickEight]:
    """Return one film, of a rod of stiff twist and of one of soft twist."""
    values = {"load": LOAD, "diameter": DIAMETER, "twist_ratio": STIFF, "link": 1.0}
    stiff = reached(touching(values), {**values, "link": LINK})
    return measured(stiff), measured(same_of(stiff, SOFT))


def both_on(
    mesh: Disk, stiff: ThickEight, soft: ThickEight
) -> tuple[Equilibrium, Equilibrium]:
    """Return what they are on a mesh, the second found from the first."""
    first = eight_on(mesh, stiff)
    problem = Problem(
        mesh,
        "area",
        twist_ratio=soft.twist_ratio,
        link=soft.link,
        diameter=soft.diameter,
        refine=False,
    )
    found = equilibrium_near(problem, first.shape, soft.film.load)
    # The film is made anew where the loop has come to.
    return first, equilibrium_near(problem, found.shape, soft.film.load)


def table() -> Iterator[list[str]]:
    """Yield a head, then both rods on every mesh, the limit and the orders."""
    yield ["C/B", "Lk", "edges", "energy", "force", "angle", "unstable"]
    exact = rods()
    found = [both_on(round_disk(edges), *exact) for edges in EDGES]
    for rod, films in zip(exact, zip(*found, strict=True), strict=True):
        case = [f"{rod.twist_ratio:g}", f"{rod.link:.4f}"]
        rows = [off(film, rod) for film in films]
        for row in rows:
            yield [*case, str(row.n_b), *shown(row.numbers), str(row.n_unstable)]
        yield [*case, "limit", *shown(limit(rows)), str(rod.n_unstable)]
        yield [*case, "order", *(f"{order:.2f}" for order in orders(rows)), ""]
