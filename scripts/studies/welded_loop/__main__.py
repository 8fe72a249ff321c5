"""Write the numbers, tables and figures of docs/welded-loop.md."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from dataclasses import astuple, fields
from math import pi
from pathlib import Path
from typing import Any

import click
from threadpoolctl import threadpool_limits

from eulerplateau.branches.conformal import Start, rod_film
from eulerplateau.exact.conformal import BUCKLING, flat_eight
from eulerplateau.loop import polygon_writhe
from scripts.studies.common import ROOT, markdown_table, processes
from scripts.studies.welded_loop.answers import (
    ISOTROPIC,
    at_load,
    disk_link,
    disk_turns_supercritical,
    flat_up_to,
    hardest,
    nature,
    nature_changes,
    snaps,
)
from scripts.studies.welded_loop.curves import LOADS, Row, rows_at, stable_links
from scripts.studies.welded_loop.figures import draw_energies, draw_map, draw_shapes
from scripts.studies.welded_loop.meshes import (
    curved_film,
    ellipse,
    keeping_ratio,
    richardson,
    twisted_film,
)
from scripts.studies.welded_loop.starts import again, cases, run, tabulated

# Closer where the curve over them bends down.
DISK_LOADS = tuple(
    float(load) for load in (50, *range(100, 1000, 100), *range(1000, 1290, 20), 1290)
)
TURNS = (0.25, 0.5, 0.75)
EDGES = (96, 128, 192, 256)
# Films that are computed on meshes too: load, C/B, link and loop edges. The last one's
# waist is 0.012 L: on 96 edges its strands meet.
BOTH = (
    (1700.0, 2 / 3, 0.25, EDGES),
    (1600.0, 1.0, 0.5, EDGES),
    (1700.0, 1.0, 0.75, (128, 160, 192, 256)),
)
# Of rods that are curved by nature, from the disk: load, C/B, link, q and loop edges.
CURVED = (
    (500.0, 0.5, 1.0, 0.5, (128, 160, 192, 256)),
    (500.0, 0.75, 0.3, 0.3, EDGES),
)
KEPT_FLAT = (1900.0, 2000.0, 2100.0)


@click.command()
@click.option("--out", type=click.Path(path_type=Path), default=ROOT / "docs")
@click.option(
    "--from",
    "table",
    type=click.Path(path_type=Path, dir_okay=False, exists=True),
    help="Only draw the pictures, from a welded_loop.csv.",
)
def main(out: Path, table: Path | None) -> None:
    """Print the tables as Markdown; write welded_loop.csv, .json and the pictures."""
    if table is not None:
        with threadpool_limits(1):
            _draw(out / "pictures" / "welded-loop", _read(table))
        return
    out.mkdir(parents=True, exist_ok=True)
    with processes() as pool:
        curves = dict(zip(LOADS, pool.map(rows_at, LOADS), strict=True))
        ends = list(pool.map(run, cases(), chunksize=5))
    with threadpool_limits(1):
        for head, text in _tables(curves):
            click.echo(f"{head}\n\n{text}")
        click.echo(f"Random starts\n\n{markdown_table(tabulated(ends, curves), 1)}")
        click.echo(f"Again, on finer meshes\n\n{markdown_table(again(ends, curves), 1)}")
        numbers = _numbers()
    click.echo(json.dumps(numbers, indent=2))
    (out / "welded_loop.json").write_text(json.dumps(numbers, indent=2) + "\n")
    with (out / "welded_loop.csv").open("w", newline="") as file:
        table_of_films = csv.writer(file)
        table_of_films.writerow([field.name for field in fields(Row)])
        table_of_films.writerows(astuple(row) for rows in curves.values() for row in rows)
    _draw(out / "pictures" / "welded-loop", curves)


def _tables(curves: dict[float, list[Row]]) -> Iterator[tuple[str, str]]:
    yield "By load", markdown_table(_by_load(curves), 0)
    yield "An isotropic rod that was turned", markdown_table(_turned(), 0)
    yield "Folds in the link", markdown_table(_folds(curves), 0)
    yield "By meshes", markdown_table(_on_meshes(), 1)


def _by_load(curves: dict[float, list[Row]]) -> Iterator[tuple[str, ...]]:
    """Yield what at_load says of each load, with the worst checks of its films."""
    yield "σ̂", "flat", "every link", "twisted", "films", "tail", "balance"  # noqa: RUF001
    for rows in curves.values():
        answer = at_load(rows)
        beside = f"{answer.flat:.4f}" if answer.load > BUCKLING else "-"
        yield (
            f"{answer.load:g}",
            beside,
            f"{answer.every:.4f}",
            f"{answer.twisted:.4f}" if answer.twisted > 0 else "-",
            str(len(rows)),
            f"{max(row.tail for row in rows):.0e}",
            f"{max(row.balance for row in rows):.0e}",
        )


def _turned() -> Iterator[tuple[str, ...]]:
    """Yield the stable films of isotropic rods at fractions of a turn."""
    yield "σ̂", "C/B", "Lk", "energy", "eight", "writhe", "waist", "unstable"  # noqa: RUF001
    for load in (1500.0, 1700.0, 2000.0):
        for ratio in ISOTROPIC:
            for link in TURNS:
                found = rod_film(Start.LOBES, load, ratio, link)
                said = found.numbers()
                eight = flat_eight(load).energy + 4 * pi**2 * ratio * (link - 1) ** 2
                yield (
                    f"{load:g}",
                    f"{ratio:.3g}",
                    f"{link:g}",
                    f"{found.energy:.6f}",
                    f"{eight:.4f}",
                    f"{found.writhe:.6f}",
                    f"{said['waist']:.5f}",
                    str(found.n_unstable),
                )


def _folds(curves: dict[float, list[Row]]) -> Iterator[tuple[str, ...]]:
    """Yield where isotropic rods snap, and at which links films are stable."""
    yield "σ̂", "C/B", "disk yields at", "folds at links", "stable links"  # noqa: RUF001
    for load, rows in curves.items():
        for ratio in ISOTROPIC:
            folds = [f"{link:.3f}" for link, _ in snaps(rows, ratio)]
            ranges = [
                f"{round(low, 3) + 0.0:.3f} to {high:.3f}"
                for low, high in stable_links(rows, ratio)
            ]
            yields = f"{disk_link(load, ratio):.4f}" if load < BUCKLING else "-"
            yield f"{load:g}", f"{ratio:.3g}", yields, ", ".join(folds), ", ".join(ranges)


def _on_meshes() -> Iterator[tuple[str, ...]]:
    """Yield numbers by both methods."""
    yield "", "without a mesh", "meshes, extrapolated", "order"
    meshes = [ellipse(edges) for edges in EDGES]
    for load in KEPT_FLAT:
        values = [keeping_ratio(mesh, load) for mesh in meshes]
        name = f"C/B that keeps lobes flat at {load:g}"
        yield _compared(name, nature(load)[0], EDGES, values)
    for load, ratio, link, edges in BOTH:
        found = rod_film(Start.LOBES, load, ratio, link)
        same = [twisted_film(ellipse(n), load, ratio, link) for n in edges]
        at = f"{load:g}, C/B {ratio:.3g}, Lk {link:g}"
        for what, known, values in (
            ("energy", found.energy, [film.energy for film in same]),
            ("area", found.film.area, [film.film_energy / load for film in same]),
            ("writhe", found.writhe, [polygon_writhe(film.shape.x_loop) for film in same]),
        ):
            yield _compared(f"{what} at {at}", known, edges, values)
    for load, ratio, link, curvature, edges in CURVED:
        found = rod_film(Start.DISK, load, ratio, link, curvature)
        both = [curved_film(n, load, ratio, link, curvature) for n in edges]
        at = f"{load:g}, C/B {ratio:.3g}, Lk {link:g}, q {curvature:g}"
        for what, known, values in (
            ("energy", found.energy, [film.energy for film, _ in both]),
            ("area", found.film.area, [film.film_energy / load for film, _ in both]),
            ("writhe", found.writhe, [said["writhe"] for _, said in both]),
        ):
            yield _compared(f"{what} at {at}", known, edges, values)


def _compared(
    what: str, known: float, edges: tuple[int, ...], values: list[float]
) -> tuple[str, ...]:
    """Return a number without a mesh, and what meshes come to."""
    limit, error, order = richardson(edges, values)
    return what, f"{known:.7f}", f"{limit:.7f} ± {error:.0e}", f"{order:.2f}"


def _numbers() -> dict[str, float]:
    load, ratio = nature_changes()
    ratio_of_all, load_of_all = hardest()
    return {
        "twist_turns_supercritical_at_load": load,
        "twist_turns_supercritical_at_ratio": ratio,
        **{
            f"flat_up_to_load_at_ratio_{r:g}": flat_up_to(r)
            for r in (0.1, 0.2, 0.3, 0.4, 0.45)
        },
        "ratio_that_keeps_lobes_flat": ratio_of_all,
        "load_at_which_that_is_asked": load_of_all,
        "ratio_that_keeps_lobes_flat_at_2450": nature(2450.0)[0],
        "disk_supercritical_above_load_isotropic_0.67": disk_turns_supercritical(
            ISOTROPIC[0]
        ),
        "disk_supercritical_above_load_isotropic_1": disk_turns_supercritical(ISOTROPIC[1]),
    }


def _read(table: Path) -> dict[float, list[Row]]:
    """Return the curves of a stored welded_loop.csv, by their loads."""
    kinds: dict[Any, Any] = {
        "int": int,
        "float": float,
        "int | None": lambda text: int(text) if text else None,
    }
    curves: dict[float, list[Row]] = {}
    with table.open(newline="") as file:
        for line in csv.DictReader(file):
            row = Row(**{f.name: kinds[f.type](line[f.name]) for f in fields(Row)})
            curves.setdefault(row.load, []).append(row)
    return curves


def _draw(folder: Path, curves: dict[float, list[Row]]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    draw_energies(folder / "energies.png", curves, (1000.0, 1700.0))
    disk = [(load, nature(load)[0]) for load in DISK_LOADS]
    draw_map(folder / "map.png", [at_load(rows) for rows in curves.values()], disk)
    draw_shapes(folder / "shapes.png")


if __name__ == "__main__":
    main()
