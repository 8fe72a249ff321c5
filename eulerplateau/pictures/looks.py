"""How curves are told apart, in colour and in grey, and the legends that name them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from eulerplateau.pictures.figure import (
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    SKY,
    SMALL,
    VERMILION,
)

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import FigureBase

DASHES, DOTS = (0, (4, 2)), (0, (1, 1.5))
COLOURS = (BLUE, VERMILION, BLACK, GREEN, PURPLE, ORANGE, SKY)
# In grey curves are told apart by these, each filled or open. Their number and that of the
# colours have no common divisor: of 91 curves no two share both.
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<", "h", ">", "*", "p", "d")
# What did not converge is marked by a cross, which is none of them.
CROSS: Mapping[str, Any] = {"linestyle": "none", "marker": "x", "markersize": 5.0}
# Markers on a smooth curve are this part of a panel's diagonal apart, and those of the
# next curve shifted.
_APART, _SHIFT = 0.12, 0.045
# Rows up to which each has a marker of the larger size (points).
_FEW, _LARGE, _DENSE = 60, 3.6, 2.4
# Letters of a legend per inch at 8 points, what the line before a label takes, and the
# height of its lines as a part of the size of its letters.
_LETTERS, _KEY, _LINE = 13.0, 9, 1.7


@dataclass(frozen=True)
class Look:
    """How a curve is drawn, in matplotlib's words.

    Attributes
    ----------
    solid, dashed : of its pieces, as they are solid or not
    bad : of its rows that are not converged
    label : str or None, in the legend; curves that share it are named once
    """

    solid: Mapping[str, Any]
    dashed: Mapping[str, Any]
    bad: Mapping[str, Any] = field(default_factory=dict)
    label: str | None = None


def style(number: int, rows: int = 1, markers: Sequence[str] = MARKERS) -> dict[str, Any]:
    """Return how the curve of that number, of so many rows, is drawn: a marker a row."""
    colour = COLOURS[number % len(COLOURS)]
    return {
        "color": colour,
        "marker": markers[number % len(markers)],
        "markersize": _LARGE if rows <= _FEW else _DENSE,
        "markerfacecolor": "white" if number % 2 else colour,
        "markeredgewidth": 0.8,
    }


def tagged(number: int, markers: Sequence[str] = MARKERS) -> dict[str, Any]:
    """Return how the smooth curve of that number is drawn: markers tell which it is."""
    shifted = (_SHIFT * number) % _APART
    return {**style(number, 1, markers), "markevery": (shifted, _APART)}


def legend_columns(labels: Sequence[str], width: float, size: float = SMALL) -> int:
    """Return in how many columns a legend of so many inches has room for labels."""
    longest = max(map(len, labels), default=0)
    return max(1, int(_LETTERS * 8.0 / size * width / (longest + _KEY)))


def legend_height(labels: Sequence[str], width: float, size: float = SMALL) -> float:
    """Return the height (inches) of a legend of that width."""
    lines = math.ceil(len(labels) / legend_columns(labels, width, size))
    return lines * _LINE * size / 72.0


def legend_above(
    figure: FigureBase, handles: Sequence[Artist | tuple[Artist, ...]], size: float = SMALL
) -> None:
    """Explain labelled `handles` above the panels, in as many columns as have room.

    Of several artists with one label, the first has it.
    """
    from matplotlib.legend_handler import HandlerTuple

    if not handles:
        return
    labels = label_of(handles)
    figure.legend(
        handles=handles,
        labels=labels,
        handler_map={tuple: HandlerTuple(ndivide=None, pad=0.6)},
        loc="outside upper center",
        ncols=legend_columns(labels, figure.get_figure(root=True).get_figwidth(), size),
        frameon=False,
        fontsize=size,
        handlelength=3.0,
    )


def label_of(handles: Sequence[Artist | tuple[Artist, ...]]) -> list[str]:
    """Return the labels of handles, of several artists together that of the first."""
    first = (handle[0] if isinstance(handle, tuple) else handle for handle in handles)
    return [str(handle.get_label()) for handle in first]
