"""The load at which one point of contact splits, on meshes, and what that says of none."""

from __future__ import annotations

from collections.abc import Iterator

from eulerplateau.branches import explore
from eulerplateau.branches.conformal import splitting_load, thick_eight
from eulerplateau.solvers import Problem
from scripts.studies.contact_eight.on_meshes import eight_on, round_disk

# Diameters with loads from which branches are followed upwards, where films without a mesh
# are known; of the first two that at which contact splits is known without a mesh, too.
STARTS = {0.05: 3800.0, 0.02: 4200.0, 0.01: 4200.0}
KNOWN = 0.02
EDGES = 60, 120
_HIGHEST = 6000.0


def on_mesh(diameter: float, edges: int) -> float:
    """Return the load at which contact splits on a mesh of so many loop edges."""
    start = STARTS[diameter]
    mesh = round_disk(edges)
    problem = Problem(mesh, "area", diameter=diameter)
    found = eight_on(mesh, thick_eight(start, diameter))
    for point in explore(problem, (start, _HIGHEST), found, special_points=0):
        special = point.special
        if special is not None and special.contact == "splits":
            return point.equilibrium.load
    raise ArithmeticError(f"contact does not split below {_HIGHEST:g}")


def table() -> Iterator[list[str]]:
    """Yield a head, then by diameter loads on meshes, their limit, and that without one.

    The limit is that of two meshes, an error of second order taken out.
    """
    heads = [f"{edges} edges" for edges in EDGES]
    yield ["d", *heads, "limit", "without a mesh"]
    more = (EDGES[1] / EDGES[0]) ** 2 - 1
    for diameter in STARTS:
        coarse, fine = (on_mesh(diameter, edges) for edges in EDGES)
        limit = fine + (fine - coarse) / more
        exact = splitting_load(diameter) if diameter >= KNOWN else None
        last = "-" if exact is None else f"{exact:.2f}"
        yield [f"{diameter:g}", *(f"{load:.2f}" for load in (coarse, fine, limit)), last]
