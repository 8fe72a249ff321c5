"""The figures of `eulerplateau plot`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.pictures.child import draw_in_child
from eulerplateau.pictures.curves import Run
from eulerplateau.pictures.figure import save
from eulerplateau.pictures.onset import onset_figure
from eulerplateau.pictures.panels import (
    QUANTITIES,
    common_window,
    draw_panels,
    legend,
    style,
)
from eulerplateau.pictures.render.alignment import aligned
from eulerplateau.pictures.render.view import common_view
from eulerplateau.pictures.vector_film import draw_film, room
from eulerplateau.runs import Row, Shape, is_planar, read_shape, shape_name

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, FigureBase

WHAT = (*QUANTITIES, "onset")

_SECONDS = 300.0
_PER_LINE = 6
# A curve steeper than this, in shares of its panel, has its numbers beside it.
_STEEP = 1.5
# Inches.
_COLUMN, _EXTRA, _PANEL, _TITLE = 3.4, 0.6, 3.0, 0.25
# What a file says of when it was drawn, left out: one run, one file.


def draw_plot(folders: Sequence[Path], what: str, path: Path) -> bool:
    """Draw one of WHAT to `path` in a child process; return whether it was drawn."""
    names = [str(folder) for folder in folders]
    return draw_in_child("eulerplateau.pictures", what, str(path), *names, timeout=_SECONDS)


def plot_runs(runs: Sequence[Run], what: str, path: Path) -> None:
    """Draw one of WHAT to a PNG, PDF or SVG file, by its ending.

    Raises OutputError if the file cannot be written, or what is to be seen is not there.
    """
    save(runs_figure(runs, what), path)


def runs_figure(
    runs: Sequence[Run], what: str, steps: Sequence[int] | None = None
) -> Figure:
    """Return the figure of one of WHAT.

    The diagram has shapes above it, at one scale, with the numbers of their places in it:
    one shape for each distinct state, or those of `steps` (of every run).
    """
    if what == "onset":
        return onset_figure(runs)
    from matplotlib.figure import Figure

    columns = 1 if common_window(runs) is None else 2
    shown = [_shown(run, steps) for run in runs] if what == "diagram" else []
    width = _COLUMN * (2 if any(shown) else max(columns, 1.5)) + _EXTRA
    heights = [_PANEL * len(QUANTITIES[what]) + 0.4]
    if any(shown):
        gallery = _gallery(runs, shown)
        heights.insert(0, gallery.height(width))
    figure = Figure(figsize=(width, sum(heights)), layout="constrained")
    parts = figure.subfigures(len(heights), 1, height_ratios=heights, squeeze=False)[:, 0]
    axes = draw_panels(parts[-1], runs, what)
    if any(shown):
        _draw_films(parts[0], gallery)
        _number(axes, runs, shown)
    legend(parts[-1], runs)
    return figure


def _shown(run: Run, steps: Sequence[int] | None) -> list[Row]:
    if steps is None:
        return run.states()
    return [row for row in run.rows if row.step in steps]


@dataclass(frozen=True)
class _Gallery:
    """Shapes in lines, each with the number of its run, and how they are seen."""

    lines: list[tuple[int, Sequence[tuple[Row, Shape]]]]
    eye: FloatArray
    half: tuple[float, float]

    @property
    def columns(self) -> int:
        return max(len(line) for _, line in self.lines)

    def height(self, width: float) -> float:
        """Return the height that films of this width have room in."""
        film = width / self.columns * self.half[1] / self.half[0]
        return len(self.lines) * (film + _TITLE)


def _gallery(runs: Sequence[Run], shown: Sequence[Sequence[Row]]) -> _Gallery:
    films = [
        aligned([read_shape(run.folder / shape_name(row.step)) for row in rows])
        for run, rows in zip(runs, shown, strict=True)
    ]
    every = [shape for shapes in films for shape in shapes]
    eye = common_view(every).eye
    lines = [
        (number, line)
        for number, (rows, shapes) in enumerate(zip(shown, films, strict=True))
        for line in _lines(list(zip(rows, shapes, strict=True)))
    ]
    return _Gallery(lines, eye, room(every, eye))


def _lines(
    shapes: Sequence[tuple[Row, Shape]],
) -> list[Sequence[tuple[Row, Shape]]]:
    """Break the shapes of a run into lines of nearly equal length."""
    count = max(-(-len(shapes) // _PER_LINE), 1)
    length = max(-(-len(shapes) // count), 1)
    return [shapes[first : first + length] for first in range(0, len(shapes), length)]


def _draw_films(figure: FigureBase, gallery: _Gallery) -> None:
    axes = figure.subplots(len(gallery.lines), gallery.columns, squeeze=False)
    count = 0
    for (number, line), cells in zip(gallery.lines, axes, strict=True):
        for ax in cells:
            ax.set_axis_off()
        for ax, (row, shape) in zip(cells, line, strict=False):
            count += 1
            draw_film(ax, shape, gallery.eye, gallery.half)
            title = rf"$\bf{{{count}}}$   ${row.load_name.tex}={row.load:.5g}$"
            ax.set_title(title, fontsize=7.5, color=style(number)["color"], pad=3)


def _number(
    axes: Sequence[Sequence[Axes]], runs: Sequence[Run], shown: Sequence[Sequence[Row]]
) -> None:
    """Mark the shapes in the diagram, in the enlargement where it shows them."""
    from matplotlib.patheffects import withStroke

    window = common_window(runs)
    count = 0
    for number, (run, rows) in enumerate(zip(runs, shown, strict=True)):
        for row in rows:
            count += 1
            inside = window is not None and window[0] <= row.load <= window[1]
            ax = axes[1 if inside else 0][0]
            place = (row.load, row.abs_kappa_n)
            colour = style(number)["color"]
            ax.plot(*place, "o", color=colour, markersize=7, fillstyle="none", zorder=5)
            x, y, align = _beside(ax, row, run, number % 2 == 1)
            ax.annotate(
                str(count),
                place,
                xytext=(x, y),
                textcoords="offset points",
                ha=align,
                va="top" if y < 0 else "bottom",
                fontsize=8,
                fontweight="bold",
                color=colour,
                zorder=6,
                path_effects=[withStroke(linewidth=2.5, foreground="white")],
            )


def _beside(ax: Axes, row: Row, run: Run, below: bool) -> tuple[float, float, str]:
    """Return where a number is clear of the curve: offset in points, and alignment.

    That of every other run is `below` its curve, for runs that coincide.
    """
    if is_planar(row):
        return 0, -6, "center"
    place = run.rows.index(row)
    before, after = (
        run.rows[i] for i in (max(place - 1, 0), min(place + 1, len(run.rows) - 1))
    )
    climb = (after.abs_kappa_n - before.abs_kappa_n) / np.ptp(ax.get_ylim())
    way = (after.load - before.load) / np.ptp(ax.get_xlim())
    if abs(climb) <= _STEEP * abs(way):
        return 0, -6 if below else 5, "center"
    right = (climb * way < 0) != below
    return 5 if right else -5, -3 if below else 3, "left" if right else "right"
