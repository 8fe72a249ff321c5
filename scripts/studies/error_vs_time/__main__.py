"""Measure errors against run time: all scenes, or one point in this process."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import click

from scripts.studies.common import machine, markdown_table
from scripts.studies.error_vs_time.by_turns import by_turns
from scripts.studies.error_vs_time.conformal import (
    CONFORMAL,
    TANGENT_ANGLE,
    mesh_free_repeats,
)
from scripts.studies.error_vs_time.evolver import find_evolver
from scripts.studies.error_vs_time.measure import ENOUGH, repeated
from scripts.studies.error_vs_time.ours import (
    kinds,
    measure_mesh_free,
    read_mesh,
    run_point,
    solvers,
    write_mesh,
)
from scripts.studies.error_vs_time.picture import draw
from scripts.studies.error_vs_time.points import Place, as_measurement, summarise
from scripts.studies.error_vs_time.records import (
    COARSE_TO_FINE,
    CORRECTED,
    Measurement,
    read_csv,
    with_errors,
    write_csv,
)
from scripts.studies.error_vs_time.report import markdown
from scripts.studies.error_vs_time.scenes import SCENES, Scene
from scripts.studies.error_vs_time.theirs import measure_evolver

# Loop edges of the meshes, each twice as fine as the one before.
LEVELS = {"uniform": 5, "graded": 5, "fan": 5, "lattice": 4}
COARSEST = 36
# Without its interior a film's loop of 36 edges leads Evolver astray.
COARSEST_IN_PLANE = 72
# And of those that are corrected, before them.
COARSER = (24, 30)
SOLVERS = ("newton", f"newton{CORRECTED}", "cg", CONFORMAL, TANGENT_ANGLE)


@click.group(invoke_without_command=True)
@click.option("--scene", "names", multiple=True, type=click.Choice(list(SCENES)))
@click.option("--solver", "only", multiple=True, help="By default all, and Evolver.")
@click.option("--out", default="docs", type=click.Path(path_type=Path, file_okay=False))
@click.option(
    "--from",
    "table",
    type=click.Path(path_type=Path, dir_okay=False, exists=True),
    help="Only draw error_vs_time.png to OUT, from its .csv; nothing is measured.",
)
@click.pass_context
def main(
    context: click.Context,
    names: tuple[str, ...],
    only: tuple[str, ...],
    out: Path,
    table: Path | None,
) -> None:
    """Measure all scenes, or those named; write error_vs_time.csv and .png to OUT."""
    if context.invoked_subcommand is not None:
        return
    if table is not None:
        draw(out / "error_vs_time.png", read_csv(table))
        return
    out.mkdir(parents=True, exist_ok=True)
    found: list[Measurement] = []
    with TemporaryDirectory() as folder:
        for name in names or SCENES:
            scene = SCENES[name]
            found += with_errors(list(measure_scene(scene, Path(folder), only)))
            write_csv(out / "error_vs_time.csv", found)
    draw(out / "error_vs_time.png", found)
    click.echo(markdown(found))


@main.command()
@click.argument("meshes", nargs=-1, type=click.Path(path_type=Path, exists=True))
@click.option("--scene", required=True, type=click.Choice(list(SCENES)))
@click.option("--solver", required=True, type=click.Choice(SOLVERS))
@click.option("--harmonics", default=0, help="In place of meshes.")
def point(meshes: tuple[Path, ...], scene: str, solver: str, harmonics: int) -> None:
    """Measure one point in this process and print its repeats as JSON.

    Solved on the last of the meshes, coming from the ones before it.
    """
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, user_api="blas"):
        if solver in (CONFORMAL, TANGENT_ANGLE):
            records = mesh_free_repeats(SCENES[scene], harmonics)
        else:
            sequence = [read_mesh(path) for path in meshes]
            records = repeated(sequence, SCENES[scene], solver)
        for record in records:
            click.echo(json.dumps(record))


@main.command()
@click.argument("table", type=click.Path(path_type=Path, dir_okay=False, exists=True))
def pairs(table: Path) -> None:
    """Measure what TABLE, an error_vs_time.csv, compares at equal error again, by turns."""
    with TemporaryDirectory() as folder:
        rows = by_turns(read_csv(table), COARSEST, Path(folder))
        click.echo(f"{machine()}\n\n{markdown_table(rows, 2)}")


def measure_scene(
    scene: Scene, folder: Path, only: tuple[str, ...] = ()
) -> Iterator[Measurement]:
    """Yield every repeat of every point of a scene, of the solvers that begin so."""

    def wanted(solver: str) -> bool:
        return not only or solver.startswith(only)

    if wanted(CONFORMAL) and scene.film == "area" and scene.threshold is None:
        yield from measure_mesh_free(scene)
    for kind in kinds(scene):
        coarsest = COARSEST_IN_PLANE if scene.in_plane else COARSEST
        levels = 4 if scene.in_plane else LEVELS[kind]
        meshes = [scene.mesh(kind, coarsest * 2**level) for level in range(levels)]
        for solver in filter(wanted, solvers(scene)):
            coarser = COARSER if solver.endswith(CORRECTED) else ()
            ladder = [*(scene.mesh(kind, edges) for edges in coarser), *meshes]
            paths = [folder / f"{number}.npz" for number in range(len(ladder))]
            for path, mesh in zip(paths, ladder, strict=True):
                write_mesh(path, mesh)
            for last, mesh in enumerate(ladder):
                first = 0 if solver.endswith(COARSE_TO_FINE) else last
                place = Place(kind, mesh.n_b, mesh.n_v)
                records = run_point(paths[first : last + 1], scene, solver)
                yield from (as_measurement(scene, solver, place, r) for r in records)
                summarise(scene, solver, place, records)
                if not records or records[-1]["cpu"] > ENOUGH:
                    break
        with_evolver = (
            wanted("evolver") and scene.film == "area" and scene.threshold is None
        )
        if with_evolver and find_evolver() is not None:
            yield from measure_evolver(scene, kind, meshes)


if __name__ == "__main__":
    main()
