"""A curve of special points over its two parameters."""

from __future__ import annotations

from eulerplateau.pictures.figure import (
    BLACK,
    BLUE,
    COLUMN,
    TEXT,
    VERMILION,
    drawn,
    frame,
    new_figure,
    save,
)
from eulerplateau.pictures.looks import MARKERS, legend_above
from eulerplateau.runs import Locus

LOCUS = "locus.png"


def draw_locus(locus: Locus) -> bool:
    """Draw locus.png into its folder; return whether it was, and log why not."""
    path = locus.folder / LOCUS
    return drawn(str(path), lambda: plot_locus(locus))


def plot_locus(locus: Locus) -> None:
    """Draw the second parameter upwards over the first, special points marked."""
    first, second = locus.names
    figure = new_figure(COLUMN, 3.2)
    ax = figure.subplots()
    rows = sorted(locus.rows, key=lambda row: float(row["arclength"]))
    for stable, look in ((True, "-"), (False, "--")):
        shown = [row if (row["n_unstable"] == 0) == stable else None for row in rows]
        x, y = (
            [float("nan") if row is None else row[name.column] for row in shown]
            for name in (first, second)
        )
        if any(row is not None for row in shown):
            text = "the last to be lost" if stable else "others unstable"
            ax.plot(x, y, look, color=BLUE, linewidth=1.4, label=text)
    kinds = dict.fromkeys(row["special"] for row in rows if row["special"])
    for number, kind in enumerate(kinds):
        points = [row for row in rows if row["special"] == kind]
        ax.plot(
            [row[first.column] for row in points],
            [row[second.column] for row in points],
            MARKERS[number],
            color=BLACK if kind == "start" else VERMILION,
            markersize=5,
            label=kind,
        )
    ax.set(xlabel=first.label, ylabel=second.label)
    ax.set_title(f"{rows[0]['kind']}s", fontsize=TEXT)
    frame(ax)
    legend_above(figure, ax.get_legend_handles_labels()[0])
    save(figure, locus.folder / LOCUS)
