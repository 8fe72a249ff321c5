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
EDGES = (60, 120, 180)
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
    """Yield a head, then by diameter loads on meshes, their limits, and that without one.

    Limits are those of two meshes in a row, errors of second order taken out.
    """
    heads = [f"{edges} edges" for edges in EDGES]
    yield ["d", *heads, "limit of the first two", "of the last two", "without a mesh"]
    for diameter in STARTS:
        loads = [on_mesh(diameter, edges) for edges in EDGES]
        limits = []
        for i in range(len(EDGES) - 1):
            more = (EDGES[i + 1] / EDGES[i]) ** 2 - 1
            limits.append(loads[i + 1] + (loads[i + 1] - loads[i]) / more)
        exact = splitting_load(diameter) if diameter >= KNOWN else None
        last = "-" if exact is None else f"{exact:.1f}"
        yield [f"{diameter:g}", *(f"{load:.1f}" for load in (*loads, *limits)), last]
