"""How the cost of a solve grows with the mesh: its exponent, fitted.

In vertices where meshes are uniform; in loop edges where they are graded, as it is the loop
that such meshes resolve.
"""

from __future__ import annotations

from itertools import groupby
from operator import attrgetter

from scripts.studies.error_vs_time.arithmetic import fitted_order
from scripts.studies.error_vs_time.records import Point

# Loop edges from which on solves are more than overhead.
_COARSEST = 72


def growth(known: list[Point]) -> list[str]:
    """Return the table of all solvers on three meshes or more, its lines."""
    rows = []
    for (scene, solver, mesh), group in groupby(known, attrgetter("ladder")):
        ladder = [p for p in group if p.first.loop_edges >= _COARSEST]
        if mesh not in ("uniform", "graded") or len(ladder) < 3:
            continue
        of = "vertices" if mesh == "uniform" else "loop_edges"
        sizes = [getattr(p.first, of) for p in ladder]
        power, spread = fitted_order(sizes, [p.cpu for p in ladder])
        what = f"{sizes[0]} to {sizes[-1]} {of.replace('_', ' ')}"
        rows.append(
            f"| {scene} | {solver} | {mesh} | {what} | {power:.2f} ± {spread:.2f} |"
        )
    return [
        "CPU seconds of a solve grow as this power of the vertices of uniform meshes, and "
        "of the loop edges of graded ones:",
        "",
        "| scene | solver | mesh | of | power |",
        "|---|---|---|---|---:|",
        *rows,
    ]
