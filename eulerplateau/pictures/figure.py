"""What the diagrams have in common: labels, colours, the enlargement, saving."""

from __future__ import annotations

import io
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from eulerplateau.mesh import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ABS_KAPPA_N = r"$\langle|\kappa_n|\rangle=\oint|\kappa_n|\,ds$"

# Okabe and Ito's colours: told apart by the colour-blind and, by lightness, in grey.
BLACK, BLUE, ORANGE, GREEN = "#000000", "#0072B2", "#E69F00", "#009E73"
VERMILION, PURPLE, SKY = "#D55E00", "#CC79A7", "#56B4E9"

_UNDATED: dict[str, dict[str, None]] = {
    "pdf": {"CreationDate": None},
    "svg": {"Date": None},
    "png": {},
}
_DPI = 200
_WIDTH, _EXTRA, _HEIGHT = 3.4, 0.6, 7.2
# A range of loads narrower than this part of all loads gets a column of its own.
_NARROW = 0.2


def new_figure(columns: int) -> Figure:
    """Return an empty figure for panels above each other in so many columns."""
    from matplotlib.figure import Figure

    return Figure(figsize=(_WIDTH * columns + _EXTRA, _HEIGHT), layout="constrained")


def frame(ax: Axes) -> None:
    """Turn the ticks inwards, on all sides, and leave the curves some room."""
    ax.margins(x=0.03, y=0.08)
    ax.tick_params(direction="in", top=True, right=True)


def enlarged(low: float, high: float, loads: Iterable[float]) -> tuple[float, float] | None:
    """Return a window about [low, high], or None if that is no small part of `loads`."""
    loads = list(loads)
    if not 0 < high - low < _NARROW * (max(loads) - min(loads)):
        return None
    margin = 0.4 * (high - low)
    return low - margin, high + margin


def save(figure: Figure, path: Path) -> None:
    """Write a figure to a PNG, PDF or SVG file, whole or not at all; raises OutputError."""
    from matplotlib import rc_context

    form = path.suffix[1:].lower()
    content = io.BytesIO()
    # Type 42: text in a PDF stays text. Simplified, a curve loses its corners.
    settings: Any = {
        "pdf.fonttype": 42,
        "svg.hashsalt": "eulerplateau",
        "path.simplify": False,
    }
    with rc_context(settings):
        figure.savefig(content, format=form, dpi=_DPI, metadata=_UNDATED[form])
    write_whole(path, content.getvalue())
