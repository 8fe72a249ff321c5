"""The load at which one point of contact splits, on meshes, and what that says of none."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

from eulerplateau.branches import explore
from eulerplateau.branches.conformal import splitting_load, thick_eight
from eulerplateau.solvers import Problem
from scripts.studies.common import extrapolated
from scripts.studies.contact_eight.on_meshes import eight_on, round_disk

# Diameters, with loads from which branches are followed upwards, where films without a mesh
# are known, and the loop's edges of two meshes. Of the first two diameters the load where
# contact splits is known without a mesh, too.
STARTS = {0.05: 3800.0, 0.02: 4200.0, 0.01: 4200.0}
MESHES = ((0.05, (60, 120)), (0.02, (60, 120)), (0.01, (60, 120)), (0.01, (120, 180)))
KNOWN = 0.02
_HIGHEST = 6000.0


@cache
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
    """Yield a head, then by diameter loads on two meshes, their limit, and that of none.

    The limit is that of the two meshes, an error of second order taken out.
    """
    yield ["d", "edges", "coarse", "fine", "limit", "without a mesh"]
    for diameter, edges in MESHES:
        found = [on_mesh(diameter, each) for each in edges]
        exact = splitting_load(diameter) if diameter >= KNOWN else None
        last = "-" if exact is None else f"{exact:.2f}"
        loads = (f"{load:.2f}" for load in (*found, extrapolated(edges, found)))
        yield [f"{diameter:g}", f"{edges[0]}, {edges[1]}", *loads, last]
