"""What is compared at equal error, measured again by turns.

A machine that is shared is faster now and slower then. So each pair is run side by side:
Evolver, ours, Evolver, ours, and how many times faster ours is is told for each round.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from statistics import median

from eulerplateau.mesh import Disk
from scripts.studies.error_vs_time.equal_error import Pair, pairs
from scripts.studies.error_vs_time.ours import run_point, write_mesh
from scripts.studies.error_vs_time.records import COARSE_TO_FINE, Measurement, points
from scripts.studies.error_vs_time.report import by_scene
from scripts.studies.error_vs_time.scenes import SCENES
from scripts.studies.error_vs_time.theirs import evolver_record

_ROUNDS = 5


def by_turns(found: list[Measurement], coarsest: int, folder: Path) -> Iterator[list[str]]:
    """Yield a head, then each pair of the measurements with its ratio, median and spread.

    coarsest : loop edges of the mesh that Evolver begins with from coarse to fine
    """
    yield ["scene", "mesh", "Evolver: loop", "s", "ours: loop", "s", "times faster"]
    for name, group in by_scene(points(found)).items():
        for pair in pairs(group):
            theirs, ours = zip(*rounds(pair, coarsest, folder), strict=True)
            ratio = [a / b for a, b in zip(theirs, ours, strict=True)]
            spread = f"{median(ratio):.2g} ({min(ratio):.2g}-{max(ratio):.2g})"
            place = pair.theirs.first
            yield [
                name,
                place.mesh,
                f"{place.loop_edges}{place.solver.removeprefix('evolver')}",
                f"{median(theirs):.3g}",
                str(pair.ours.first.loop_edges),
                f"{median(ours):.3g}",
                spread,
            ]


def rounds(pair: Pair, coarsest: int, folder: Path) -> Iterator[tuple[float, float]]:
    """Yield the CPU seconds of both, round by round; ours is the median of a process."""
    theirs, ours = pair.theirs.first, pair.ours.first
    scene = SCENES[theirs.scene]

    def mesh(edges: int) -> Disk:
        return scene.mesh(theirs.mesh, edges)

    ladder = [mesh(theirs.loop_edges)]
    while theirs.solver.endswith(COARSE_TO_FINE) and ladder[0].n_b > coarsest:
        ladder.insert(0, mesh(ladder[0].n_b // 2))
    path = folder / "mesh.npz"
    write_mesh(path, mesh(ours.loop_edges))
    for number in range(1, _ROUNDS + 1):
        record = evolver_record(scene, ladder, number, 0.0)
        repeats = run_point([path], scene, ours.solver)
        yield record["cpu"], median(each["cpu"] for each in repeats)
