"""Make the figures, and the page that compares their numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import click
import numpy as np

from eulerplateau.exact.planar import thresholds
from eulerplateau.pictures import fit_onset
from eulerplateau.pictures.comparison import runs_figure
from eulerplateau.pictures.figure import save
from eulerplateau.pictures.planar import plot_energy, plot_gallery
from eulerplateau.runs import Row, Run, load_run, read_run, run_sweep
from scripts.studies.common import ROOT, markdown_table, shrink, shrink_shaded
from scripts.studies.figures.cells import (
    draw_geometry,
    draw_phases,
    draw_spreading,
    draw_traction,
)
from scripts.studies.figures.numbers import Number

# Integral of |kappa_n| ds up to which a film is flat, as in scripts/transitions.
FLAT = 1e-3

# Table tab:contact: n, onset of point contact, onset of line contact.
CONTACT = (
    (2, 2603.0, 5127.7),
    (3, 10740.6, 40584.9),
    (4, 25719.8, 102795.4),
    (5, 48535.5, 203145.1),
    (6, 79910.4, 349245.2),
)
LOAD, SIGMA = "kL³/α", "σ̂"  # noqa: RUF001 - Greek letters
# Loads shown in the two figures of shapes.
TWISTING = (1, 600, 680, 716, 744, 1500, 2300, 3000)
ENNEPER = (1, 864, 920, 1000, 1500, 2000, 2500, 3000)
# Figures that show films.
SHADED = ("twisting", "enneper")

NOT_COMPUTED = (
    ("fig:frenet, fig:turning-tangents, fig:contact", "drawings that explain a notion"),
    ("fig:mora, fig:selection", "photographs of experiments"),
    ("fig:cell", "micrographs of cells"),
    ("fig:schematic", "three of the shapes of fig:phase and [cells](cells.md)"),
    ("the circles of fig:spreading", "measurements of cells, which are not ours"),
)


@dataclass(frozen=True)
class Figure:
    """A figure of the paper: what draws it to a file and returns its numbers."""

    label: str
    draw: Callable[[Path], list[Number]]


def main_figures() -> dict[str, Figure]:
    """Return the figures by the names of their files."""
    return {
        "planar-gallery": Figure("fig:gallery, tab:contact", draw_planar_gallery),
        "planar-energy": Figure("fig:energy", draw_planar_energy),
        "twisting": Figure("fig:twisting", draw_twisting),
        "enneper": Figure("fig:enneper", draw_enneper),
        "bifurcation": Figure("fig:bifurcation", draw_bifurcation),
        "cell-spreading": Figure("fig:spreading", draw_spreading),
        "cell-geometry": Figure("fig:geometry", draw_geometry),
        "cell-traction": Figure("fig:traction", draw_traction),
        "cell-phases": Figure("fig:phase", draw_phases),
    }


@click.command()
@click.argument("names", metavar="[NAME]...", nargs=-1)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    default=ROOT / "docs",
    help="The folder for figures/NAME.png and, if all are made, paper.md. Default: docs.",
)
def main(names: tuple[str, ...], out: Path) -> None:
    """Make the figures NAME, by default all, and print paper / here / difference.

    Names: planar-gallery, planar-energy, twisting, enneper, bifurcation, cell-spreading,
    cell-geometry, cell-traction, cell-phases.
    """
    figures = main_figures()
    unknown = [name for name in names if name not in figures]
    if unknown:
        raise click.BadParameter(f"{unknown[0]}: should be one of {', '.join(figures)}")
    (out / "figures").mkdir(parents=True, exist_ok=True)
    found = {}
    for name in names or figures:
        path = out / "figures" / f"{name}.png"
        found[name] = figures[name].draw(path)
        (shrink_shaded if name in SHADED else shrink)(path)
    text = page({name: figures[name].label for name in found}, found)
    click.echo(text, nl=False)
    if not names:
        (out / "paper.md").write_text(text, encoding="utf-8")


def draw_planar_gallery(path: Path) -> list[Number]:
    """Draw the planar films and compare the table of contacts."""
    plot_gallery(path)
    numbers = []
    for n, point, line in CONTACT:
        limits = thresholds(n)
        for kind, paper, here in (
            ("c", point, limits.sigma_contact),
            ("0", line, limits.sigma_line_contact),
        ):
            numbers.append(Number(f"{SIGMA}_{kind}{n}", paper, here))
    return numbers


def draw_planar_energy(path: Path) -> list[Number]:
    """Draw the energies of two- and three-lobed films; the paper gives no number."""
    plot_energy(path)
    return []


def draw_twisting(path: Path) -> list[Number]:
    """Draw the elongated film's diagram and locate its three transitions."""
    with TemporaryDirectory() as folder:
        run = carried_out("elongated", Path(folder))
        save(runs_figure([run], "diagram", steps_at(run, TWISTING)), path)
    papers = {
        "leaves the plane": 643.0,
        "flat eight": 740.0,
        "leaves the plane again": 2000.0,
    }
    return [
        Number(f"{LOAD}, {name}", paper, 0.5 * (low + high), 0.5 * (high - low))
        for (name, paper), (low, high) in zip(papers.items(), changes(run), strict=True)
    ]


def draw_enneper(path: Path) -> list[Number]:
    """Draw the regular hexagon's diagram and locate its transition."""
    with TemporaryDirectory() as folder:
        run = carried_out("hexagon", Path(folder))
        save(runs_figure([run], "diagram", steps_at(run, ENNEPER)), path)
    low, high = changes(run)[0]
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    return [Number(f"{LOAD}, leaves the plane", 855.0, middle, half)]


def draw_bifurcation(path: Path) -> list[Number]:
    """Draw the curvatures at the elongated film's onset with their exponents."""
    with TemporaryDirectory() as folder:
        run = carried_out("onset", Path(folder))
        save(runs_figure([run], "onset"), path)
    kappa, gauss = fit_onset(run)
    far = kappa.distance > 1e-3
    logs = np.log(kappa.distance[far]), np.log(kappa.values[far])
    coefficients, covariance = np.polyfit(*logs, 1, cov=True)
    slope, error = float(coefficients[0]), 2 * float(np.sqrt(covariance[0, 0]))
    law = kappa.law
    straight = "the same, a straight line over ε = 1e-3 … 1e-2"
    return [
        Number("exponent of ⟨\\|κₙ\\|⟩", 0.489, law.exponent, law.exponent_error, 0.005),
        Number(straight, 0.489, slope, error, 0.005),
        Number("exponent of ⟨K⟩", 1.0, gauss.law.exponent, gauss.law.exponent_error),
    ]


def carried_out(name: str, folder: Path) -> Run:
    """Carry out runs/NAME.toml and return the run."""
    run_sweep(load_run(ROOT / "runs" / f"{name}.toml", {}), folder / name)
    return read_run(folder / name)


def steps_at(run: Run, loads: Sequence[float]) -> list[int]:
    """Return the steps of a run whose loads are nearest to these."""
    return [min(run.rows, key=lambda row: abs(row.kL3_alpha - load)).step for load in loads]


def changes(run: Run) -> list[tuple[float, float]]:
    """Return the pairs of loads between which a film leaves a plane or returns to one."""

    def flat(row: Row) -> bool:
        return row.abs_kappa_n < FLAT

    return [
        (row.kL3_alpha, after.kL3_alpha)
        for row, after in pairwise(run.first_leg)
        if flat(row) != flat(after)
    ]


def page(labels: dict[str, str], found: dict[str, list[Number]]) -> str:
    """Return the Markdown page: the table, the figures, and what is not computed."""
    rows = [["figure", "quantity", "paper", "here", "difference"]]
    for name, numbers in found.items():
        title = f"[{labels[name]}](figures/{name}.png)"
        rows += [[title, *cells(number)] for number in numbers]
        if not numbers:
            rows.append([title, "no number in the paper", "", "", ""])
    others = [["figures", "why not"], *map(list, NOT_COMPUTED)]
    parts = [
        INTRODUCTION,
        markdown_table(rows, words=2),
        "\n## Not computed here\n\n",
        markdown_table(others, words=2),
    ]
    pictures = [f"\n## {labels[name]}\n\n![{name}](figures/{name}.png)\n" for name in found]
    return "".join([*parts, *pictures])


INTRODUCTION = """# The paper's figures

Giomi, *Softly constrained films*: its numbers beside those of this program, as printed by
`scripts/figures`. Loads of films in space are the middles of the brackets that a sweep's
steps leave; they depend on the mesh by a few per cent, and the paper does not specify its
elongated hexagon ([transitions](transitions.md)). It does not say how its exponent was
fitted: a straight line through the logarithms is one way to a value like it, and depends on
the range of ε = load/onset - 1. Ours has the next term of the law too, A εⁿ (1 + b ε).

"""


def cells(number: Number) -> list[str]:
    """Return the name, the paper's value, ours, and the difference."""
    digits = 5 if abs(number.paper) < 10 else 1
    paper = f"{number.paper:.10g}"
    if number.paper_error:
        paper += f" ± {number.paper_error:g}"
    here = f"{number.here:.{digits}f}"
    if number.here_error:
        here += f" ± {number.here_error:.{digits}f}"
    difference = number.here - number.paper
    text = f"{difference:+.{digits}f}"
    if abs(difference) > 1e-3 * number.paper:
        text += f" ({100 * difference / number.paper:+.1f} %)"
    return [number.name, paper, here, text]


if __name__ == "__main__":
    main()
