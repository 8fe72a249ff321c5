"""What is found of transitions, and its tables in Markdown and CSV."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from eulerplateau.film import FILM_LOADS
from eulerplateau.film.load import SPRING_TENSION
from scripts.studies.common import markdown_table

DISK, EIGHT, DOUBLE, BENT = "disk", "figure eight", "double disk", "not flat"
# Names of transitions, by the states below and above them.
LEAVES, LEAVES_AGAIN = "leaves the plane", "leaves the plane again"
FLAT_EIGHT, WOUND_TWICE = "flat eight", "jumps to the double disk"
NAMES = {
    (DISK, BENT): LEAVES,
    (BENT, EIGHT): FLAT_EIGHT,
    (EIGHT, BENT): LEAVES_AGAIN,
    (BENT, DOUBLE): WOUND_TWICE,
}

# Brackets are closed to this share of the load.
WIDTH = 1e-5

ELONGATED, HEXAGON = "hexagon stretched to twice its length", "regular hexagon"
# What is looked for on a polygon, and what the paper reports of it as kL3/alpha.
TWISTS = (LEAVES, FLAT_EIGHT, LEAVES_AGAIN)
SADDLE = (LEAVES, WOUND_TWICE)
PAPER = {
    ELONGATED: {LEAVES: 643.0, FLAT_EIGHT: 740.0, LEAVES_AGAIN: 2000.0},
    HEXAGON: {LEAVES: 855.0},
}
ALGORITHM_NAMES = {5: "Delaunay", 6: "Frontal-Delaunay", 8: "Frontal-Delaunay for quads"}
CSV_COLUMNS = (
    *("film", "polygon", "algorithm", "vertices", "loop_edges"),
    *("from", "to", "last_load", "first_load", "paper"),
)


@dataclass(frozen=True)
class Case:
    """A polygon's mesh, a start, and the loads of the coarse sweep, in order."""

    polygon: str
    loads: tuple[float, ...]
    vertices: int = 474
    algorithm: int = 6
    seed: int = 1
    displacement: float = 1e-3
    film: str = "springs"
    width: float = WIDTH


@dataclass(frozen=True)
class Transition:
    """A change of state between two loads, in the order of the sweep."""

    before: str
    after: str
    last: float
    first: float

    @property
    def rising(self) -> bool:
        """Whether it was met on the way up."""
        return self.last < self.first

    @property
    def name(self) -> str | None:
        """What it is called, whichever way it was met."""
        states = (self.before, self.after)
        return NAMES.get(states if self.rising else states[::-1])


@dataclass(frozen=True)
class Found:
    """What a case came to: its mesh, and its transitions in the order of the sweep."""

    case: Case
    n_v: int
    n_b: int
    transitions: tuple[Transition, ...]
    solves: int
    failures: tuple[str, ...]


def mesh_table(polygon: str, meshes: Iterable[Found]) -> str:
    """Return the Markdown table of a polygon: a row for each mesh.

    Of a film that does not depend on how the mesh is connected, also the limits.
    """
    names = SADDLE if polygon == HEXAGON else TWISTS
    here = [found for found in meshes if found.case.polygon == polygon]
    film = here[0].case.film
    rows = [["algorithm", "vertices", "loop edges", *names]]
    for found in here:
        name = f"{found.case.algorithm} ({ALGORITHM_NAMES[found.case.algorithm]})"
        rows.append([name, str(found.n_v), str(found.n_b), *cells(found, names)])
    if film != "springs":
        rows.append(["limit", "", "", *(limit_cell(here, name) for name in names)])
    if polygon in PAPER:
        known = [paper(film, polygon, name) for name in names]
        scale = "" if film == "springs" else ", times 2√3"
        rows.append([f"paper{scale}", "474", "", *known])
    return f"\n## {polygon.capitalize()}\n\n{markdown_table(rows, words=1)}"


def paper(film: str, polygon: str, name: str | None) -> str:
    """Return what the paper reports, as a load of the film with the same tension."""
    known = PAPER.get(polygon, {}).get(name or "")
    if known is None:
        return "-"
    return f"{known * SPRING_TENSION / FILM_LOADS[film].tension_per_load:.0f}"


def limit_cell(meshes: Sequence[Found], name: str) -> str:
    """Return a transition's limit under refinement and its error."""
    met = [
        (found.case.algorithm, found.n_b, 0.5 * (t.last + t.first))
        for found in meshes
        for t in found.transitions
        if t.name == name
    ]
    coarsest = min((n_b for _, n_b, _ in met), default=0)
    finer = [point for point in met if point[1] > 1.1 * coarsest]
    if len({algorithm for algorithm, _, _ in met}) + 1 >= len(finer):
        return "-"
    value, error = limit(met)
    return f"{value:.2f} ± {max(error, abs(value - limit(finer)[0])):.2f}"


def limit(points: Sequence[tuple[int, int, float]]) -> tuple[float, float]:
    """Return the common limit of (algorithm, n_b, load) for n_b to infinity, and 2 errors.

    By least squares, with an error of order 1/n_b^2 of its own for each algorithm.
    """
    algorithms = sorted({algorithm for algorithm, _, _ in points})
    design = np.ones((len(points), 1 + len(algorithms)))
    for row, (algorithm, n_b, _) in zip(design, points, strict=True):
        row[1:] = [(algorithm == other) / n_b**2 for other in algorithms]
    loads = np.array([load for _, _, load in points])
    # Columns of one size: 1/n_b^2 beside 1 would count as rounding.
    size = np.abs(design).max(axis=0)
    values, *_ = np.linalg.lstsq(design / size, loads, rcond=None)
    left = loads - design / size @ values
    variance = left @ left / (len(points) - len(values))
    covariance = variance * np.linalg.inv((design / size).T @ (design / size))
    return float(values[0]), 2 * float(np.sqrt(covariance[0, 0]))


def starts_table(starts: dict[str, Found]) -> str:
    """Return the Markdown table of the ways to reach the same transitions."""
    rows = [["start and sweep", *TWISTS]]
    rows += [[label, *cells(found, TWISTS)] for label, found in starts.items()]
    return f"\n## Starts and sweeps\n\n{markdown_table(rows, words=1)}"


def sequence_table(found: Found) -> str:
    """Return the Markdown table of everything that one sweep went through."""
    rows = [["direction", "from", "to", "load"]]
    rows += [
        ["up" if t.rising else "down", t.before, t.after, cell(t)]
        for t in found.transitions
    ]
    title = f"{found.case.polygon.capitalize()}, algorithm {found.case.algorithm}"
    return f"\n## {title}, up and down\n\n{markdown_table(rows, words=1)}"


def cells(found: Found, names: Iterable[str]) -> list[str]:
    """Return where the sweep last met each transition."""
    met = {t.name: cell(t) for t in found.transitions}
    return [met.get(name, "-") for name in names]


def cell(transition: Transition) -> str:
    """Return the middle of the bracket and half its width."""
    middle = 0.5 * (transition.last + transition.first)
    return f"{middle:.3f} ± {abs(transition.first - middle):.3f}"


def write_csv(path: Path, meshes: Iterable[Found]) -> None:
    """Write one row for each transition on each mesh."""
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(CSV_COLUMNS)
        for found in meshes:
            case = found.case
            mesh = [case.film, case.polygon, case.algorithm, found.n_v, found.n_b]
            for t in found.transitions:
                known = paper(case.film, case.polygon, t.name)
                table.writerow([*mesh, t.before, t.after, t.last, t.first, known])
