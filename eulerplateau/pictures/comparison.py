"""Figures of one run, or of several compared: the command `eulerplateau plot`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.arrays import FloatArray
from eulerplateau.mesh import Shape
from eulerplateau.mesh.drawing import aligned, common_view
from eulerplateau.pictures.figure import (
    ABS_KAPPA_N,
    MINUS_K,
    drawn,
    enlarged,
    new_figure,
    save,
)
from eulerplateau.pictures.onset import onset_figure
from eulerplateau.pictures.panels import (
    DASHES,
    Curve,
    Look,
    Panel,
    draw_panels,
    legend_above,
    panel,
    style,
)
from eulerplateau.pictures.vector_film import draw_film, room
from eulerplateau.runs import Row, Run, is_planar, read_shape

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, FigureBase
    from numpy.typing import NDArray


def _over_disk(row: Row) -> float:
    return row.energy / (row.sigma_hat / (4 * pi) + 4 * pi**2)


_PANELS: dict[str, tuple[Panel, ...]] = {
    "diagram": (panel(ABS_KAPPA_N, lambda row: row.abs_kappa_n),),
    "energy": (
        panel(r"$E\,L/\alpha$", lambda row: row.energy),
        panel(r"$E\,/\,(\hat\sigma/4\pi+4\pi^2)$, flat disk: 1", _over_disk),
    ),
    "curvature": (panel(MINUS_K, lambda row: -row.total_gauss_curvature),),
    "eigenvalue": (
        panel(
            r"smallest eigenvalue $\lambda_1 L^3/\alpha$",
            lambda row: row.lowest_eigenvalue,
            logarithmic=True,
        ),
    ),
}
WHAT = (*_PANELS, "onset")

# Markers are this part of a panel's diagonal apart, and those of the next run shifted.
_APART, _SHIFT = 0.09, 0.035
_PER_LINE = 6
# A curve steeper than this, in shares of its panel, has its numbers beside it.
_STEEP = 1.5
# Inches.
_COLUMN, _EXTRA, _PANEL, _TITLE = 3.4, 0.6, 3.0, 0.25


def draw_comparison(runs: Sequence[Run], what: str, path: Path) -> bool:
    """Draw one of WHAT to `path`; return whether it was drawn, and log why not."""
    return drawn(str(path), lambda: plot_runs(runs, what, path))


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
    window = common_window(runs)
    columns = 1 if window is None else 2
    shown = [_shown(run, steps) for run in runs] if what == "diagram" else []
    width = _COLUMN * (2 if any(shown) else max(columns, 1.5)) + _EXTRA
    heights = [_PANEL * len(_PANELS[what]) + 0.4]
    if any(shown):
        films = _films(runs, shown)
        heights.insert(0, films.height(width))
    figure = new_figure(width, sum(heights))
    parts = figure.subfigures(len(heights), 1, height_ratios=heights, squeeze=False)[:, 0]
    axes = draw_panels(
        parts[-1],
        _PANELS[what],
        [curve for number, run in enumerate(runs) for curve in _curves(run, number)],
        runs[0].load.label,
        window=window,
        margin=0.12,
    )
    if any(shown):
        _draw_films(parts[0], films)
        _number(axes[0], runs, shown)
    legend_above(parts[-1], _handles(runs))
    return figure


def common_window(runs: Sequence[Run]) -> tuple[float, float] | None:
    """Return the loads to enlarge: those of all saddles that end, if they are few."""
    ends = [run.saddle for run in runs if run.saddle is not None]
    if not ends:
        return None
    loads = [row.load for run in runs for row in run.rows]
    return enlarged(min(low for low, _ in ends), max(high for _, high in ends), loads)


def _curves(run: Run, number: int) -> list[Curve]:
    """Return the curves of a run in the colour and with the marker of its number."""
    looks = {**style(number), "markevery": ((_SHIFT * number) % _APART, _APART)}
    look = Look(
        solid={**looks, "linestyle": "-", "linewidth": 1.2, "zorder": 3},
        dashed={**looks, "linestyle": DASHES, "linewidth": 0.9, "zorder": 2},
        bad={"linestyle": "none", "marker": "x", "color": looks["color"], "markersize": 5},
        label=run.label,
    )
    return [(series, look) for series in run.series]


def _handles(runs: Sequence[Run]) -> list[Artist]:
    """Return what names the runs, and the styles that occur."""
    from matplotlib.lines import Line2D

    handles: list[Artist] = [
        Line2D([], [], **style(number), linewidth=1.0, label=run.label)
        for number, run in enumerate(runs)
    ]
    if any(run.branches for run in runs):
        handles.append(Line2D([], [], color="0.3", linestyle=DASHES, label="unstable"))
    if any(_falls(run) for run in runs):
        handles.append(Line2D([], [], color="0.3", linestyle=DASHES, label="load falling"))
    if any(not row.converged for run in runs for row in run.rows):
        handles.append(
            Line2D([], [], marker="x", linestyle="none", color="0.3", label="not converged")
        )
    return handles


def _falls(run: Run) -> bool:
    """Whether it is a sweep, a part of which is drawn as one whose load falls."""
    if run.branches:
        return False
    legs = [leg.pieces(leg.values(lambda row: row.energy)) for leg in run.series]
    return any(not piece.solid for pieces in legs for piece in pieces)


def _shown(run: Run, steps: Sequence[int] | None) -> list[Row]:
    if steps is None:
        return run.states()
    return [row for row in run.rows if row.step in steps]


@dataclass(frozen=True)
class _Films:
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


def _films(runs: Sequence[Run], shown: Sequence[Sequence[Row]]) -> _Films:
    films = [
        aligned([read_shape(run.shape_path(row)) for row in rows])
        for run, rows in zip(runs, shown, strict=True)
    ]
    every = [shape for shapes in films for shape in shapes]
    eye = common_view(every).eye
    lines = [
        (number, line)
        for number, (rows, shapes) in enumerate(zip(shown, films, strict=True))
        for line in _lines(list(zip(rows, shapes, strict=True)))
    ]
    return _Films(lines, eye, room(every, eye))


def _lines(
    shapes: Sequence[tuple[Row, Shape]],
) -> list[Sequence[tuple[Row, Shape]]]:
    """Break the shapes of a run into lines of nearly equal length."""
    count = max(-(-len(shapes) // _PER_LINE), 1)
    length = max(-(-len(shapes) // count), 1)
    return [shapes[first : first + length] for first in range(0, len(shapes), length)]


def _draw_films(figure: FigureBase, films: _Films) -> None:
    axes = figure.subplots(len(films.lines), films.columns, squeeze=False)
    count = 0
    for (number, line), cells in zip(films.lines, axes, strict=True):
        for ax in cells:
            ax.set_axis_off()
        for ax, (row, shape) in zip(cells, line, strict=False):
            count += 1
            draw_film(ax, shape, films.eye, films.half)
            title = rf"$\bf{{{count}}}$   ${row.load_name.tex}={row.load:.5g}$"
            ax.set_title(title, fontsize=7.5, color=style(number)["color"], pad=3)


def _number(
    panels: NDArray[Any], runs: Sequence[Run], shown: Sequence[Sequence[Row]]
) -> None:
    """Mark the shapes in the diagram, in the enlargement where it shows them."""
    from matplotlib.patheffects import withStroke

    window = common_window(runs)
    count = 0
    for number, (run, rows) in enumerate(zip(runs, shown, strict=True)):
        for row in rows:
            count += 1
            inside = window is not None and window[0] <= row.load <= window[1]
            ax = panels[1 if inside else 0]
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
