"""What all figures have in common: labels, colours, the enlargement, saving, failing."""

from __future__ import annotations

import gc
import io
import logging
import math
import os
import sys
import textwrap
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.errors import EulerPlateauError
from eulerplateau.mesh import write_whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, FigureBase

# What draws a shape into a field.
DrawShape = Callable[["Axes"], None]

_log = logging.getLogger(__name__)

MINUS_K = r"$-\langle K\rangle=-\int K\,dA$"
ABS_KAPPA_N = r"$\langle|\kappa_n|\rangle=\oint|\kappa_n|\,ds$"

# Okabe and Ito's colours: told apart by the colour-blind and, by lightness, in grey.
BLACK, BLUE, ORANGE, GREEN = "#000000", "#0072B2", "#E69F00", "#009E73"
VERMILION, PURPLE, SKY = "#D55E00", "#CC79A7", "#56B4E9"

# A file does not say when it was drawn: one run makes one file.
_UNDATED: dict[str, dict[str, None]] = {
    "pdf": {"CreationDate": None},
    "svg": {"Date": None},
}
_DPI = 300
# Inches: one column of a journal, two, and what a panel takes of the height.
COLUMN, PAGE, _PANEL, _ABOVE = 8.6 / 2.54, 17.8 / 2.54, 1.35, 1.2
# Inches above and below each part of a figure.
_ROOM = 0.06
# How far a bar is below its field, as a part of that.
_BELOW = 0.04
# Points, at the size at which figures are printed: of labels, and of ticks and legends.
TEXT, SMALL = 8.0, 7.0
# Small letters of a line of text per inch.
_LETTERS = 16.0
# A range of loads narrower than this part of all loads gets a column of its own.
_NARROW = 0.2


@dataclass(frozen=True)
class Portraits:
    """Shapes of several runs, ready to be drawn at one scale.

    Attributes
    ----------
    draw : of every run, what draws each of its shapes
    half : half the width and height of a field, in the unit of the shapes
    lines : int, how many lines are written above each
    widest : float, what is wide enough for one, in inches
    note : str, what there is to be said below them, in a line
    bar : float, the length of the bar that shows the scale, which the note explains
    """

    draw: Sequence[Sequence[DrawShape]]
    half: tuple[float, float]
    lines: int = 1
    widest: float = math.inf
    note: str = ""
    bar: float = 0.0


@dataclass(frozen=True)
class FieldLook:
    """How a field of the shape files is shown.

    Attributes
    ----------
    label : str, beside the colour bar
    signed : bool, whether it is coloured symmetrically about zero
    """

    label: str
    signed: bool = False


def load_matplotlib() -> None:
    """Import matplotlib; to be called before anything of it is imported.

    Figures here are drawn without a window, so that the backend MPLBACKEND names does not
    matter to them. But matplotlib refuses to be imported if there is no such backend, and
    Jupyter exports one that other environments do not have. Where there is one, it stays
    the backend of whoever opens windows beside.
    """
    if "matplotlib" in sys.modules:
        return
    named = os.environ.pop("MPLBACKEND", None)
    try:
        import matplotlib
    finally:
        if named is not None:
            os.environ["MPLBACKEND"] = named
    if named:
        with suppress(ValueError):
            matplotlib.rcParams["backend"] = named
    if not hasattr(sys, "ps1"):
        _load_without_help()


def _load_without_help() -> None:
    """Import what draws, without the lists of properties that help() shows of its classes.

    To make them takes as long as all else of that; only who types at a prompt can ask.
    """
    from matplotlib import artist

    idle: list[tuple[Any, str, Any]] = [
        (artist, "kwdoc", lambda artist: ""),
        (
            artist.Artist,
            "_update_set_signature_and_docstring",
            classmethod(lambda cls: None),
        ),
    ]
    known = [vars(owner).get(name) for owner, name, _ in idle]
    try:
        for owner, name, stub in idle:
            setattr(owner, name, stub)
        from matplotlib import figure  # noqa: F401 - loads all that draws
    finally:
        for (owner, name, _), own in zip(idle, known, strict=True):
            setattr(owner, name, own)


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure of so many inches that leaves its parts the room they need."""
    load_matplotlib()
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    return Figure(figsize=(width, height), layout=ConstrainedLayoutEngine(h_pad=_ROOM))


def figure_of_panels(columns: int, count: int) -> Figure:
    """Return an empty figure for `count` panels above each other in so many columns."""
    return new_figure(COLUMN if columns == 1 else PAGE, _PANEL * count + _ABOVE)


def frame(ax: Axes) -> None:
    """Turn the ticks inwards, on all sides, and leave the curves some room.

    Letters get the size at which they are read in print.
    """
    ax.margins(x=0.03, y=0.08)
    ax.tick_params(direction="in", which="both", top=True, right=True, labelsize=SMALL)
    # With their ticks inside, its lines take no more room than the field does; to ask each
    # takes a quarter of a layout.
    for spine in ax.spines.values():
        spine.set_in_layout(False)
    for text in (ax.xaxis.label, ax.yaxis.label, ax.title):
        text.set_fontsize(TEXT)
    for axis in (ax.xaxis, ax.yaxis):
        axis.get_offset_text().set_fontsize(SMALL)


def wrapped(note: str, width: float) -> str:
    """Return a note in lines that have room in so many inches, in small letters."""
    letters = int(_LETTERS * width)
    return "\n".join(textwrap.fill(line, letters) for line in note.splitlines())


def write_below(figure: FigureBase, note: str) -> None:
    """Write a note below a figure, in lines that have room there."""
    width = figure.get_figure(root=True).get_figwidth()
    figure.supxlabel(wrapped(note, width), fontsize=SMALL, color="0.3")


def scale_bar(ax: Axes, length: float) -> None:
    """Draw a bar of so much below the lower left corner of a field of shapes."""
    left, low = ax.get_xlim()[0], ax.get_ylim()[0]
    place = [low - _BELOW * np.ptp(ax.get_ylim())] * 2
    ax.plot([left, left + length], place, color=BLACK, linewidth=1.8, clip_on=False)


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
    _fix_layout(figure, form)
    with rc_context(settings):
        if form == "png":
            _write_png(figure, content)
        else:
            figure.savefig(content, format=form, dpi=_DPI, metadata=_UNDATED[form])
    write_whole(path, content.getvalue())


def _write_png(figure: Figure, file: io.BytesIO) -> None:
    """Write a figure as matplotlib does, but for what is transparent nowhere."""
    from PIL import Image

    # What the layout was measured on: it knows the texts that it has measured.
    canvas: Any = figure.canvas
    canvas.draw()
    seen = np.asarray(canvas.buffer_rgba())
    image = Image.fromarray(seen).convert("RGB")
    # Less than a seventh longer than at the default, in half of the time.
    image.save(file, "png", dpi=(_DPI, _DPI), compress_level=3)


def lay_out(figure: Figure) -> None:
    """Give the parts of an unfinished figure about the room that they will have."""
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)


def _fix_layout(figure: Figure, form: str) -> None:
    """Give a figure's parts their room in a format; matplotlib draws it once for that."""
    from matplotlib.backend_bases import get_registered_canvas_class

    get_registered_canvas_class(form)(figure)
    figure.set_dpi(_DPI)
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine(None)


def drawn(name: str, draw: Callable[[], None]) -> bool:
    """Call `draw`, which draws the picture `name`; return whether it ended well.

    An exception is logged as a warning of one line: it costs the picture, not the run.
    """
    looked_for = gc.isenabled()
    # A figure is made of many small things, none of which is garbage before it is drawn.
    gc.disable()
    try:
        draw()
    except Exception as error:
        kind = "" if isinstance(error, EulerPlateauError) else f"{type(error).__name__}: "
        _log.warning(
            "%s could not be drawn: %s%s", name, kind, " ".join(str(error).split())
        )
        return False
    finally:
        if looked_for:
            gc.enable()
    return True
