"""Seconds at equal error: for each mesh of Evolver's, the first of ours that is as good.

The error is the worst of those of area, bending energy and shape. Evolver comes to its mesh
by the better of its ways, directly or coarse to fine; ours is solved directly on one mesh,
uniform or graded as Evolver's is, and corrected. No two meshes are extrapolated.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from scripts.studies.error_vs_time.records import COARSE_TO_FINE, CORRECTED, Point

# Loop edges from which on meshes are compared.
_COARSEST = 72
_THEIRS = ("evolver", f"evolver{COARSE_TO_FINE}")
_OURS = f"newton{CORRECTED}"


class Pair(NamedTuple):
    """A point of Evolver's, and the first of ours that is at least as good."""

    theirs: Point
    ours: Point

    @property
    def ratio(self) -> float:
        """How many times faster ours is."""
        return self.theirs.cpu / self.ours.cpu


def pairs(scene: list[Point]) -> Iterator[Pair]:
    """Yield those of one scene, mesh by mesh, where both are measured."""
    places = {
        (p.first.mesh, p.first.loop_edges) for p in scene if p.first.solver in _THEIRS
    }
    for mesh, edges in sorted(places):
        there = [p for p in scene if (p.first.mesh, p.first.loop_edges) == (mesh, edges)]
        theirs = min((p for p in there if p.first.solver in _THEIRS), key=lambda p: p.cpu)
        good = [
            p
            for p in scene
            if p.first.solver == _OURS
            and p.first.mesh == mesh
            and p.first.worst_error <= theirs.first.worst_error
        ]
        if edges >= _COARSEST and good:
            yield Pair(theirs, min(good, key=lambda p: p.first.loop_edges))


def equal_error(scenes: dict[str, list[Point]]) -> list[str]:
    """Return the table of all scenes, its lines; none if there is nothing to compare."""
    rows = [_row(name, pair) for name, group in scenes.items() for pair in pairs(group)]
    if not rows:
        return []
    return [
        "CPU seconds at equal error, the worst of area, bending energy and shape: for each "
        "of Evolver's meshes, in the faster of its ways, our first mesh at least as good.",
        "",
        "| scene | mesh | Evolver: loop | error | s | ours, corrected: loop | error | s "
        "| times faster |",
        "|---|---|" + "---:|" * 7,
        *rows,
        "",
    ]


def _row(name: str, pair: Pair) -> str:
    cells = [name, pair.theirs.first.mesh]
    for point in pair:
        m = point.first
        spread = f"{point.cpu:.3g} ({point.least:.2g}-{point.most:.2g})"
        cells += [str(m.loop_edges), f"{m.worst_error:.1e}", spread]
    return f"| {' | '.join(cells)} | {pair.ratio:.2g} |"
