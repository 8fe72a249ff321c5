"""Figures of one run, or of several compared: the command `eulerplateau plot`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from eulerplateau.errors import SpecError
from eulerplateau.pictures.figure import (
    PAGE,
    drawn,
    enlarged,
    load_matplotlib,
    new_figure,
    save,
)
from eulerplateau.pictures.film_pictures import FILM
from eulerplateau.pictures.looks import (
    CROSS,
    DASHES,
    DOTS,
    Look,
    label_of,
    legend_above,
    legend_height,
    style,
    tagged,
)
from eulerplateau.pictures.of_run import pictures_of
from eulerplateau.pictures.onset import onset_figure
from eulerplateau.pictures.panels import Curve, draw_panels
from eulerplateau.pictures.portraits import at_most, number_shapes, portrait_lines
from eulerplateau.runs import Run

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.figure import Figure

WHAT = (*FILM.plots, "onset")

# Inches: a figure with one column of panels and no shapes, a panel, and its labels.
_WIDTH, _PANEL, _LABELS = 14.0 / 2.54, 2.7, 0.5


def check_plot(runs: Sequence[Run], what: str) -> None:
    """Raise SpecError if `what`, one of WHAT, is not asked of such runs."""
    kind = runs[0].kind
    pictures = pictures_of(kind)
    if what not in pictures.plots and not (what == "onset" and pictures.has_onset):
        known = ", ".join(pictures.plots)
        raise SpecError("--what", f"a {kind.name} has no {what}: ask for {known}")
    needed = pictures.needs.get(what)
    if needed is not None and not any(needed in run.kind.columns for run in runs):
        problem = f"{what} needs the column {needed}: a run with loop.diameter has it"
        raise SpecError("--what", problem)


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
    one shape for each distinct state, or those of `steps` (of every run), or a few of them
    where they are many, which is said there. Raises SpecError if such runs have no such
    figure.
    """
    check_plot(runs, what)
    load_matplotlib()
    if what == "onset":
        return onset_figure(runs)
    kind = pictures_of(runs[0].kind)
    panels = kind.plots[what]
    window = common_window(runs)
    shown, note = at_most([_shown(run, steps) for run in runs if what == "diagram"])
    width = PAGE if any(shown) or window is not None else _WIDTH
    # Dashes are for what is unstable, where anything is.
    falling = DOTS if any(run.branches for run in runs) else DASHES
    handles = _handles(runs, falling)
    heights = [_PANEL * len(panels) + _LABELS + legend_height(label_of(handles), width)]
    if any(shown):
        shapes = portrait_lines(runs, shown, kind, note)
        heights.insert(0, shapes.height(width))
    figure = new_figure(width, sum(heights))
    parts = figure.subfigures(len(heights), 1, height_ratios=heights, squeeze=False)[:, 0]
    axes = draw_panels(
        parts[-1],
        panels,
        [
            curve
            for number, run in enumerate(runs)
            for curve in _curves(run, number, falling)
        ],
        runs[0].load.label,
        window=window,
        margin=0.12,
    )
    if any(shown):
        shapes.draw(parts[0])
    legend_above(parts[-1], handles)
    if any(shown):
        number_shapes(axes[0], window, runs, shown, kind)
    return figure


def common_window(runs: Sequence[Run]) -> tuple[float, float] | None:
    """Return the loads to enlarge: those asking for a closer look, if few."""
    ends = [run.between for run in runs if run.between is not None]
    if not ends:
        return None
    loads = [row.load for run in runs for row in run.rows]
    return enlarged(min(low for low, _ in ends), max(high for _, high in ends), loads)


def _curves(run: Run, number: int, falling: Any) -> list[Curve]:
    """Return the curves of a run in the colour and with the marker of its number.

    A sweep has a marker for each row, and where its load falls the line style `falling`;
    branches are smooth between theirs, and dashed where unstable.
    """
    looks = tagged(number) if run.branches else style(number, len(run.rows))
    dashes = DASHES if run.branches else falling
    look = Look(
        solid={**looks, "linestyle": "-", "linewidth": 1.2, "zorder": 3},
        dashed={**looks, "linestyle": dashes, "linewidth": 0.9, "zorder": 2},
        bad={**CROSS, "color": looks["color"]},
        label=run.label,
    )
    return [(series, look) for series in run.series]


def _handles(runs: Sequence[Run], falling: Any) -> list[Artist]:
    """Return what names the runs, and the styles that occur."""
    from matplotlib.lines import Line2D

    handles: list[Artist] = [
        Line2D([], [], **style(number), linewidth=1.0, label=run.label)
        for number, run in enumerate(runs)
    ]
    if any(run.branches for run in runs):
        handles.append(Line2D([], [], color="0.3", linestyle=DASHES, label="unstable"))
    for name in dict.fromkeys(name for run in runs for name in _falling(run)):
        handles.append(Line2D([], [], color="0.3", linestyle=falling, label=name))
    if any(not row.converged for run in runs for row in run.rows):
        handles.append(Line2D([], [], color="0.3", label="not converged", **CROSS))
    return handles


def _falling(run: Run) -> list[str]:
    """Return what the parts of a sweep are called that are drawn with its load falling."""
    if run.branches:
        return []
    return [
        leg.name
        for leg in run.series
        if any(not piece.solid for piece in leg.pieces(leg.values(lambda row: row.energy)))
    ]


def _shown(run: Run, steps: Sequence[int] | None) -> list[Any]:
    if steps is None:
        return run.states()
    return [row for row in run.rows if row.step in steps]
