"""A catalogue as a picture: each equilibrium, and how their count has settled."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from eulerplateau.pictures.figure import (
    BLUE,
    COLUMN,
    SMALL,
    TEXT,
    VERMILION,
    drawn,
    frame,
    new_figure,
    save,
    scale_bar,
    wrapped,
    write_below,
)
from eulerplateau.pictures.film_pictures import FILM
from eulerplateau.pictures.looks import legend_above
from eulerplateau.runs import CatalogueRow, read_catalogue, shape_name

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from eulerplateau.runs import Catalogue

_COLUMNS = 5
# Inches: a shape, what is written above it and below all, and the curves.
_WIDTH, _TITLE, _NOTE, _COUNTS = 1.4, 0.5, 0.25, 2.3
# In one piece, however a note is broken.
_UNIT = "$E$\N{NO-BREAK SPACE}in\N{NO-BREAK SPACE}" r"$\alpha/L$"
_CURVES = {
    "together": ("both", "0.3"),
    "by_starts": ("random starts", BLUE),
    "by_deflation": ("deflation", VERMILION),
}
_STYLES = {"together": "-", "by_starts": "--", "by_deflation": ":"}


def draw_catalogue(folder: Path) -> bool:
    """Draw catalogue.png of a folder; return whether it was drawn, and log why not."""
    path = folder / "catalogue.png"
    return drawn(str(path), lambda: plot_catalogue(read_catalogue(folder), path))


def plot_catalogue(catalogue: Catalogue, path: Path) -> None:
    """Draw a catalogue with a row or more to the PNG file `path`.

    Above, load by load, the equilibria by energy, at one scale; what is written over each
    is its energy, its Morse index and in how many searches it was met. Below, how many
    were known after so many searches. Raises OutputError if the file cannot be written.
    """
    loads = sorted({row.load for row in catalogue.rows})
    lines = [
        line
        for load in loads
        for line in _lines([row for row in catalogue.rows if row.load == load])
    ]
    paths = [[catalogue.folder / shape_name(row.step) for row in line] for line in lines]
    portraits = FILM.portraits(paths)
    columns = max(map(len, lines))
    width = max(COLUMN, _WIDTH * columns)
    field = width / columns * portraits.half[1] / portraits.half[0] + _TITLE
    note = "; ".join(filter(None, (portraits.note, _UNIT)))
    above = len(lines) * field + _NOTE * len(wrapped(note, width).splitlines())
    figure = new_figure(width, above + _COUNTS)
    top, bottom = figure.subfigures(2, 1, squeeze=False, height_ratios=(above, _COUNTS))[
        :, 0
    ]
    axes = top.subplots(len(lines), columns, squeeze=False)
    for line, draws, cells in zip(lines, portraits.draw, axes, strict=True):
        for ax in cells:
            ax.set_axis_off()
        for row, draw, ax in zip(line, draws, cells, strict=False):
            draw(ax)
            ax.set_title(_words(row), fontsize=SMALL, pad=3)
    if portraits.bar:
        scale_bar(axes[0, 0], portraits.bar)
    write_below(top, note)
    counts = bottom.subplots(1, len(loads), squeeze=False, sharey=True)[0]
    for load, ax in zip(loads, counts, strict=True):
        _draw_counts(ax, catalogue, load)
    counts[0].set_ylabel("distinct equilibria", fontsize=TEXT)
    legend_above(bottom, counts[0].get_legend_handles_labels()[0])
    save(figure, path)


def _lines(rows: Sequence[CatalogueRow]) -> list[Sequence[CatalogueRow]]:
    return [rows[first : first + _COLUMNS] for first in range(0, len(rows), _COLUMNS)]


def _words(row: CatalogueRow) -> str:
    place = f"${row.load_name.tex}={row.load:.6g}$" if row.number == 0 else ""
    state = f"$E={row.energy:.5g}$, index {row.n_unstable}"
    starts = f"{row.by_starts} start{'s' if row.by_starts != 1 else ''}"
    found = f"{starts}, {row.by_deflation} deflated"
    return f"{place}\n{state}\n{found}"


def _draw_counts(ax: Axes, catalogue: Catalogue, load: float) -> None:
    """Draw how many equilibria were known at a load after so many searches."""
    own = [count for count in catalogue.counts if count["load"] == load]
    searches = [count["search"] for count in own]
    for name, (label, colour) in _CURVES.items():
        found = [count[name] for count in own]
        ax.step(searches, found, _STYLES[name], where="post", color=colour, label=label)
    ax.set_xlabel("searches of each kind")
    ax.set_title(f"${catalogue.rows[0].load_name.tex}={load:.6g}$")
    ax.locator_params(integer=True)
    frame(ax)
    ax.set_ylim(0, 1 + max(count["together"] for count in catalogue.counts))
