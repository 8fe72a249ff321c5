"""Shapes in lines above a diagram, each with the number it has there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.pictures.figure import (
    BLACK,
    SMALL,
    DrawShape,
    Portraits,
    lay_out,
    scale_bar,
    wrapped,
    write_below,
)
from eulerplateau.pictures.kinds import KindPictures
from eulerplateau.pictures.looks import style
from eulerplateau.pictures.numbers import MARK, joined, spread
from eulerplateau.pictures.panels import Band
from eulerplateau.runs import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase
    from numpy.typing import NDArray

# Shapes in a line, and in all.
_PER_LINE, _MOST = 6, 12
# A curve steeper than this, in shares of its panel, has its numbers beside it.
_STEEP = 1.5
# Numbers farther from their marks than this (points) have lines to them.
_FAR = 18.0
_LEADER: dict[str, Any] = {
    "arrowstyle": "-", "color": "0.4", "linewidth": 0.6, "shrinkA": 1, "shrinkB": MARK
}  # fmt: skip
# Inches.
_TITLE, _NOTE = 0.25, 0.28


# A shape that is drawn: the number of its run, its row, and what draws it.
Drawn = tuple[int, Any, DrawShape]


@dataclass(frozen=True)
class PortraitLines:
    """Shapes in lines, all at one scale.

    Attributes
    ----------
    lines : of shapes, in the order of their runs
    portraits : the scale, and what is written
    kind : what the pictures show of such runs
    note : str, which shapes there are, in a line; empty if all that were asked for
    """

    lines: list[Sequence[Drawn]]
    portraits: Portraits
    kind: KindPictures
    note: str = ""

    @property
    def columns(self) -> int:
        """How many shapes there are in the longest line."""
        return max(map(len, self.lines))

    @property
    def notes(self) -> str:
        """What stands below the shapes."""
        return "\n".join(filter(None, (self.portraits.note, self.note)))

    def height(self, width: float) -> float:
        """Return the height (inches) in which shapes of this width have room."""
        half, title = self.portraits.half, self.portraits.lines * _TITLE
        shape = min(width / self.columns, self.portraits.widest) * half[1] / half[0]
        notes = _NOTE * len(wrapped(self.notes, width).splitlines())
        return len(self.lines) * (shape + title) + notes

    def draw(self, figure: FigureBase) -> None:
        """Draw the shapes, numbered through all runs, with their loads above them."""
        axes = figure.subplots(len(self.lines), self.columns, squeeze=False)
        count = 0
        for line, cells in zip(self.lines, axes, strict=True):
            for ax in cells:
                ax.set_axis_off()
            for ax, (number, row, draw) in zip(cells, line, strict=False):
                count += 1
                draw(ax)
                if self.portraits.bar and count == 1:
                    scale_bar(ax, self.portraits.bar)
                place = f"${row.load_name.tex}={row.load:.5g}$"
                state = self.kind.state(row)
                words = f"{state}\n{place}" if state else place
                title = rf"$\bf{{{count}}}$   {words}"
                ax.set_title(title, fontsize=SMALL, color=style(number)["color"], pad=3)
        if self.notes:
            write_below(figure, self.notes)


def at_most(
    shown: Sequence[Sequence[Any]], most: int = _MOST
) -> tuple[list[Sequence[Any]], str]:
    """Return of the rows of each run so many in all, evenly chosen, and a note if some.

    The first and the last are among them.
    """
    total = sum(map(len, shown))
    if total <= most:
        return list(shown), ""
    kept = {round(place) for place in np.linspace(0, total - 1, most)}
    first = np.cumsum([0, *map(len, shown)])
    chosen: list[Sequence[Any]] = [
        [row for place, row in enumerate(rows, start) if place in kept]
        for start, rows in zip(first, shown, strict=False)
    ]
    return chosen, f"shapes: {most} of the {total} states of these runs, evenly chosen"


def portrait_lines(
    runs: Sequence[Run], shown: Sequence[Sequence[Any]], kind: KindPictures, note: str = ""
) -> PortraitLines:
    """Return the shapes of the rows `shown` of each run, at least one in all.

    Each run begins a line, unless that makes too many of them.
    """
    paths = [
        [run.shape_path(row) for row in rows] for run, rows in zip(runs, shown, strict=True)
    ]
    portraits = kind.portraits(paths)
    drawn = [
        [(number, row, draw) for row, draw in zip(rows, draws, strict=True)]
        for number, (rows, draws) in enumerate(zip(shown, portraits.draw, strict=True))
    ]
    lines = [line for own in drawn for line in _lines(own)]
    if len(lines) > _MOST // _PER_LINE + 1:
        lines = _lines([shape for own in drawn for shape in own])
    return PortraitLines(lines, portraits, kind, note)


def number_shapes(
    panels: NDArray[Any],
    window: Band | None,
    runs: Sequence[Run],
    shown: Sequence[Sequence[Any]],
    kind: KindPictures,
) -> None:
    """Mark the shapes in the first panel, or in its enlargement where that shows them.

    `panels` are its axes (1 or 2,), the second those of the enlarged `window` of loads. The
    rest of the figure is to be there: where numbers have room depends on the panels' size.
    """
    marks: list[list[_Mark]] = [[] for _ in panels]
    pairs = [(number, row) for number, rows in enumerate(shown) for row in rows]
    for count, (number, row) in enumerate(pairs, 1):
        inside = window is not None and window[0] <= row.load <= window[1]
        ax = panels[1 if inside else 0]
        place = row.load, kind.numbered(row)
        colour = style(number)["color"]
        ax.plot(*place, "o", color=colour, markersize=2 * MARK, fillstyle="none", zorder=5)
        wish = _beside(ax, row, runs[number], number % 2 == 1, kind)
        marks[1 if inside else 0].append(_Mark(count, place, colour, wish))
    lay_out(panels[0].get_figure(root=True))
    for ax, own in zip(panels, marks, strict=True):
        if own:
            _write_numbers(ax, own)


@dataclass(frozen=True)
class _Mark:
    """A shape's number, its place in its panel, its colour, where its number is to be."""

    number: int
    place: tuple[float, float]
    colour: str
    wish: tuple[float, float]


def _write_numbers(ax: Any, marks: Sequence[_Mark]) -> None:
    """Write numbers beside their marks, those of one place together, none on another."""
    from matplotlib.patheffects import withStroke

    points = 72.0 / ax.get_figure(root=True).dpi
    box = ax.get_window_extent()
    places = points * (ax.transData.transform([mark.place for mark in marks]) - box.min)
    groups = joined(places)
    firsts = [marks[group[0]] for group in groups]
    words = [", ".join(str(marks[one].number) for one in group) for group in groups]
    places = places[[group[0] for group in groups]]
    middles = spread(
        places,
        list(map(len, words)),
        np.array([mark.wish for mark in firsts]),
        points * np.array([box.width, box.height]),
    )
    for mark, group, text, offset in zip(
        firsts, groups, words, middles - places, strict=True
    ):
        alone = len({marks[one].colour for one in group}) == 1
        ax.annotate(
            text,
            mark.place,
            xytext=tuple(offset),
            textcoords="offset points",
            ha="center",
            va="center_baseline",
            fontsize=8,
            fontweight="bold",
            color=mark.colour if alone else BLACK,
            zorder=6,
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
            arrowprops=_LEADER if np.hypot(*offset) > _FAR else None,
        )


def _lines(shapes: Sequence[Drawn]) -> list[Sequence[Drawn]]:
    """Break shapes into lines of nearly equal length; no shapes make none."""
    if not shapes:
        return []
    count = -(-len(shapes) // _PER_LINE)
    length = -(-len(shapes) // count)
    return [shapes[first : first + length] for first in range(0, len(shapes), length)]


def _beside(
    ax: Axes, row: Any, run: Run, below: bool, kind: KindPictures
) -> tuple[float, float]:
    """Return the direction in which a number is clear of the curve.

    That of every other run is `below` its curve, for runs that coincide.
    """
    if kind.flat(row):
        return 0.0, -1.0
    place = run.rows.index(row)
    before, after = (
        run.rows[i] for i in (max(place - 1, 0), min(place + 1, len(run.rows) - 1))
    )
    climb = (kind.numbered(after) - kind.numbered(before)) / np.ptp(ax.get_ylim())
    way = (after.load - before.load) / np.ptp(ax.get_xlim())
    if abs(climb) <= _STEEP * abs(way):
        return 0.0, -1.0 if below else 1.0
    right = (climb * way < 0) != below
    return 1.0 if right else -1.0, -0.5 if below else 0.5
