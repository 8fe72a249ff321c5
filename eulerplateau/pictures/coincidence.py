"""Dashed curves that coincide, drawn once: out of step, their dashes look solid."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from eulerplateau.arrays import BoolArray, FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

# Parts of a panel's height within which curves coincide: less than half a line's width.
_COINCIDE = 4e-3


def dash_once(ax: Axes) -> None:
    """Leave of dashed lines that coincide the first alone, and of the others the markers.

    The range of `ax` is to be final.
    """
    from matplotlib.lines import Line2D

    before: list[FloatArray] = []
    for line in [line for line in ax.lines if line.get_linestyle() == "--"]:
        points = _in_panel(ax, line)
        hidden = _covered(points, before)
        before += _one_way(points)
        if hidden.any():
            x, y = np.asarray(line.get_data(), dtype=float)
            markers = Line2D(x, y)
            markers.update_from(line)
            markers.set(linestyle="none", markevery=line.get_markevery(), label=None)
            ax.add_line(markers)
            line.set(markevery=[], ydata=np.where(hidden, np.nan, y))


def _in_panel(ax: Axes, line: Line2D) -> FloatArray:
    """Return a line's points (n, 2) as parts of its panel's width and height."""
    to_panel = ax.transScale + ax.transLimits
    points: FloatArray = to_panel.transform(np.asarray(line.get_data(), dtype=float).T)
    return points


def _covered(points: FloatArray, before: Sequence[FloatArray]) -> BoolArray:
    """Return which of points (n, 2) lie on one of the curves before, that do not turn."""
    covered = np.zeros(len(points), dtype=bool)
    x, y = points.T
    for curve in before:
        there = np.interp(x, curve[:, 0], curve[:, 1], left=np.nan, right=np.nan)
        covered |= np.abs(y - there) < _COINCIDE
    return covered


def _one_way(points: FloatArray) -> Iterator[FloatArray]:
    """Yield the parts of a curve (n, 2) from turn to turn, each to the right."""
    way = np.sign(np.diff(points[:, 0]))
    turns = np.flatnonzero(np.diff(way)) + 1
    for first, last in zip([0, *turns], [*turns, len(points) - 1], strict=True):
        part = points[first : last + 1]
        yield part if part[-1, 0] >= part[0, 0] else part[::-1]
