"""The diagram of a sweep, diagram.png: its quantities over the load, up and down."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

from eulerplateau.pictures.figure import (
    BLACK,
    BLUE,
    PAGE,
    VERMILION,
    drawn,
    enlarged,
    figure_of_panels,
    new_figure,
    save,
)
from eulerplateau.pictures.looks import CROSS, Look, legend_above
from eulerplateau.pictures.of_run import pictures_of
from eulerplateau.pictures.panels import Band, draw_panels
from eulerplateau.pictures.portraits import (
    PortraitLines,
    at_most,
    number_shapes,
    portrait_lines,
)
from eulerplateau.runs import Run, read_run

if TYPE_CHECKING:
    from matplotlib.figure import Figure, FigureBase

# Inches: a shape above the panels, if there are many, and the least for what is written.
_PORTRAIT, _WRITTEN = 1.1, 5.4
_RISING: dict[str, Any] = {
    "color": BLUE, "marker": "o", "markersize": 2.4, "markerfacecolor": BLUE,
    "linewidth": 0.8, "linestyle": "-",
}  # fmt: skip
_FALLING: dict[str, Any] = {
    "color": VERMILION, "marker": "v", "markersize": 4.2, "markerfacecolor": "none",
    "linewidth": 0.8, "linestyle": "--",
}  # fmt: skip
_NOT_CONVERGED: dict[str, Any] = {**CROSS, "color": BLACK, "label": "not converged"}


def draw_diagram(folder: Path) -> bool:
    """Draw diagram.png of a run folder; return whether it was drawn, and log why not."""
    path = folder / "diagram.png"
    return drawn(str(path), lambda: plot_diagram(read_run(folder), path))


def plot_diagram(run: Run, path: Path) -> None:
    """Draw the bifurcation diagram of a sweep to the PNG file `path`.

    Raises OutputError if the file cannot be written.
    """
    save(diagram_figure(run), path)


def diagram_figure(run: Run) -> Figure:
    """Return the bifurcation diagram of a sweep.

    Of a film over the load: the loop's total normal curvature, the order parameter of the
    paper (its fig. twisting); minus the film's total Gauss curvature; the twist of its
    normal across the waist; its aspect; its energy over that of the flat disk. Grey bands:
    loads at which the film is not planar. A second column enlarges the loads at which it
    first leaves its plane and returns to it, if they are few.

    Of a cell over its contractility or stiffness: perimeter; the least curvature half-way
    along its sides, below zero where they are inflected (grey bands); the mean traction;
    its area; its energy. Above stand the outlines of its states.
    """
    kind = pictures_of(run.kind)
    window = None
    if run.between is not None:
        window = enlarged(*run.between, (row.load for row in run.rows))
    columns = 1 if window is None else 2
    shown: Sequence[Any] = run.states() if kind.portrayed else []
    figure, part = figure_of_panels(columns, len(kind.sweep)), None
    if shown:
        (shown,), note = at_most([shown])
        shapes = portrait_lines([run], [shown], kind, note)
        figure, above, part = _figure_below(shapes, figure)
        shapes.draw(above)
    curves = [
        (series, Look(_RISING, _FALLING, _NOT_CONVERGED, series.name))
        for series in run.series
    ]
    # They are the first leg's: where there is another it is said whose.
    band = ", ".join([kind.band, *(each.name for each in run.series[:-1])])
    axes = draw_panels(
        part or figure,
        kind.sweep,
        curves,
        run.load.label,
        window=window,
        bands=_bands(run, kind.banded),
        band=band,
        one_height=True,
    )
    if shown:
        number_shapes(axes[0], window, [run], [shown], kind)
    (part or figure).align_ylabels(axes[:, 0])
    handles = axes[0, 0].get_legend_handles_labels()[0]
    legend_above(part or figure, handles)
    return figure


def _figure_below(
    shapes: PortraitLines, plain: Figure
) -> tuple[Figure, FigureBase, FigureBase]:
    """Return a figure, its part for the shapes and below it that of the `plain` one."""
    width, height = plain.get_size_inches()
    width = min(max(width, _PORTRAIT * shapes.columns, _WRITTEN), PAGE)
    heights = [shapes.height(width), height]
    figure = new_figure(width, sum(heights))
    parts = figure.subfigures(2, 1, height_ratios=heights, squeeze=False)
    above, below = parts[:, 0]
    return figure, above, below


def _bands(run: Run, banded: Callable[[Any], bool]) -> list[Band]:
    """Return the ranges of load (low, high) of the first leg's rows that are `banded`."""
    found = groupby(run.first_leg, key=banded)
    loads = [[row.load for row in rows] for shaded, rows in found if shaded]
    return [(min(those), max(those)) for those in loads]
