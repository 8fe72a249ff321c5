"""What stands below a picture: what it shows, from where, how long it is, its colours."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from eulerplateau.pictures.figure import load_matplotlib
from eulerplateau.pictures.render.colours import Scale
from eulerplateau.pictures.render.scene import Pixels

# A picture is laid out as if it were so wide, in inches. Its letters, in points, are more
# than 6 points high in print in a third of two columns of 17.8 cm, as on contact sheets.
_INCHES, _LETTERS = 8.0, 21.0
# Heights of a line of text and of a colour bar with its numbers and name, in points.
_LINE, _BAR = 28.0, 72.0
_POINTS = 72.0
_SIDE = 0.04


@dataclass(frozen=True)
class Caption:
    """What is written below a picture.

    Attributes
    ----------
    text : str, what is shown
    view : str, from where
    bar : length of a scale bar, as a part of the picture's width, and what it is called
    scale : of the colours, if they are those of a field
    """

    text: str
    view: str
    bar: tuple[float, str]
    scale: Scale | None


def text_of(row: Any) -> str:
    """Return what is written below the shape of a row, of a sweep or of a branch."""
    parts = [f"${row.load_name.tex} = {row.load:.6g}$"]
    if hasattr(row, "branch"):
        parts.append(f"branch {row.branch}")
    if not row.converged:
        parts.append("not converged")
    return ", ".join(parts)


def captioned(pixels: Pixels, caption: Caption) -> Pixels:
    """Return an image (height, width, 3) with its caption below it."""
    return np.concatenate([pixels, _strip(caption, pixels.shape[1])])


# The frames of a turning shape have one caption: to write it takes longer than to render.
@lru_cache(maxsize=1)
def _strip(caption: Caption, width: int) -> Pixels:
    """Return a caption as an image (height, width, 3), of an even height as films need."""
    load_matplotlib()
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    points = 2.4 * _LINE + (_BAR if caption.scale is not None else 0.0)
    dpi = width / _INCHES
    height = 2 * math.ceil(0.5 * points * dpi / _POINTS)
    figure = Figure(figsize=(_INCHES, height / dpi), dpi=dpi, facecolor="white")
    canvas: Any = FigureCanvasAgg(figure)

    def up(lines: float) -> float:
        return 1.0 - lines * _LINE * dpi / _POINTS / height

    middle: Any = {"fontsize": _LETTERS, "va": "center_baseline"}
    figure.text(0.5, up(0.6), caption.text, ha="center", **middle)
    figure.text(1.0 - _SIDE, up(1.7), caption.view, ha="right", **middle)
    _add_length(figure, *caption.bar, up(1.7), middle)
    if caption.scale is not None:
        _add_colours(figure, caption.scale, up(2.6))
    canvas.draw()
    drawn: Pixels = np.asarray(canvas.buffer_rgba())[..., :3].copy()
    return drawn


def _add_length(figure: Any, length: float, name: str, height: float, text: Any) -> None:
    from matplotlib.lines import Line2D

    ends = [_SIDE, _SIDE + length]
    bar = Line2D(ends, [height] * 2, color="black", linewidth=3.0, solid_capstyle="butt")
    figure.add_artist(bar)
    figure.text(ends[1] + 0.015, height, name, ha="left", **text)


def _add_colours(figure: Any, scale: Scale, top: float) -> None:
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    high = 0.2 * _BAR / _POINTS / figure.get_figheight()
    axes = figure.add_axes((0.2, top - high, 0.6, high))
    colours = ScalarMappable(Normalize(scale.low, scale.high), scale.colours)
    bar = figure.colorbar(colours, cax=axes, orientation="horizontal", extend="both")
    bar.set_label(scale.label, fontsize=_LETTERS, labelpad=0)
    bar.ax.locator_params(nbins=5)
    bar.ax.tick_params(labelsize=0.8 * _LETTERS)
    bar.ax.xaxis.get_offset_text().set_fontsize(0.8 * _LETTERS)
    bar.formatter.set_powerlimits((-3, 4))
