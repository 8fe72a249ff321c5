"""Quantities over the load, of several runs, each in its own colour and marker."""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from eulerplateau.pictures.curves import Quantity, Run, pieces
from eulerplateau.pictures.figure import (
    ABS_KAPPA_N,
    BLACK,
    BLUE,
    GREEN,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
    enlarged,
    frame,
)
from eulerplateau.runs import Row

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase

MINUS_K = r"$-\langle K\rangle=-\int K\,dA$"

_COLOURS = (BLUE, VERMILION, BLACK, GREEN, PURPLE, ORANGE, SKY)
_MARKERS = ("o", "s", "^", "D", "v", "P", "X")
# Markers are this part of a panel's diagonal apart, and those of the next run shifted.
_APART, _SHIFT = 0.09, 0.035
_DASHES = (0, (4, 2))
# Letters of a legend per inch, and what the line or marker before a label takes.
_LETTERS, _KEY = 13.0, 9


def _over_disk(row: Row) -> float:
    return row.energy / (row.sigma_hat / (4 * pi) + 4 * pi**2)


QUANTITIES: dict[str, tuple[tuple[str, Quantity], ...]] = {
    "diagram": ((ABS_KAPPA_N, lambda row: row.abs_kappa_n),),
    "energy": (
        (r"$E\,L/\alpha$", lambda row: row.energy),
        (r"$E\,/\,(\hat\sigma/4\pi+4\pi^2)$, flat disk: 1", _over_disk),
    ),
    "curvature": ((MINUS_K, lambda row: -row.total_gauss_curvature),),
    "eigenvalue": (
        (r"smallest eigenvalue $\lambda_1 L^3/\alpha$", lambda row: row.lowest_eigenvalue),
    ),
}


def style(number: int) -> dict[str, Any]:
    """Return how the run of that number is drawn: told apart without colour by marker."""
    colour = _COLOURS[number % len(_COLOURS)]
    return {
        "color": colour,
        "marker": _MARKERS[number % len(_MARKERS)],
        "markersize": 4.0,
        "markerfacecolor": "white" if number % 2 else colour,
        "markeredgewidth": 0.9,
    }


def draw_panels(figure: FigureBase, runs: Sequence[Run], what: str) -> list[list[Axes]]:
    """Draw the quantities of `what`; return the axes of each column.

    A second column enlarges the loads at which a film is out of its plane, if they are few.
    """
    window = common_window(runs)
    columns = 1 if window is None else 2
    panels = QUANTITIES[what]
    axes = figure.subplots(len(panels), columns, sharex="col", squeeze=False)
    for (label, quantity), line in zip(panels, axes, strict=True):
        line[0].set_ylabel(label)
        for ax in line:
            for number, run in enumerate(runs):
                _draw(ax, run, quantity, number)
            frame(ax)
            ax.margins(y=0.12)
            if what == "eigenvalue":
                _scale(ax, runs)
    for column in axes.T:
        column[-1].set_xlabel(runs[0].rows[0].load_name.label)
    if window is not None:
        for ax in axes[:, 1]:
            ax.set_xlim(*window)
            _fit_height(ax)
    return [list(column) for column in axes.T]


def common_window(runs: Sequence[Run]) -> tuple[float, float] | None:
    """Return the loads to enlarge: those of all saddles that end, if they are few."""
    ends = [run.saddle for run in runs if run.saddle is not None]
    if not ends:
        return None
    loads = [row.load for run in runs for row in run.rows]
    return enlarged(min(low for low, _ in ends), max(high for _, high in ends), loads)


def legend(figure: FigureBase, runs: Sequence[Run]) -> None:
    """Name the runs, and the styles that occur, above the panels."""
    from matplotlib.lines import Line2D

    handles: list[Artist] = [
        Line2D([], [], **style(number), linewidth=1.0, label=run.label)
        for number, run in enumerate(runs)
    ]
    if any(run.branches for run in runs):
        handles.append(Line2D([], [], color="0.3", linestyle=_DASHES, label="unstable"))
    sweeps = [run for run in runs if not run.branches]
    if any(not p.solid for run in sweeps for p in pieces(run, lambda row: row.energy)):
        handles.append(Line2D([], [], color="0.3", linestyle=_DASHES, label="load falling"))
    if any(not row.converged for run in runs for row in run.rows):
        handles.append(
            Line2D([], [], marker="x", linestyle="none", color="0.3", label="not converged")
        )
    legend_above(figure, handles)


def legend_above(figure: FigureBase, handles: Sequence[Artist]) -> None:
    """Explain labelled `handles` above the panels, in as many columns as have room."""
    longest = max(len(str(handle.get_label())) for handle in handles)
    room = _LETTERS * figure.get_figure(root=True).get_figwidth()
    figure.legend(
        handles=handles,
        loc="outside upper center",
        ncols=max(1, int(room / (longest + _KEY))),
        frameon=False,
        fontsize=8,
    )


def _draw(ax: Axes, run: Run, quantity: Quantity, number: int) -> None:
    looks = style(number)
    label: str | None = run.label
    for piece in pieces(run, quantity):
        ax.plot(
            piece.loads,
            piece.values,
            **looks,
            markevery=((_SHIFT * number) % _APART, _APART),
            linestyle="-" if piece.solid else _DASHES,
            linewidth=1.2 if piece.solid else 0.9,
            label=label,
            zorder=3 if piece.solid else 2,
        )
        label = None
    bad = [row for row in run.rows if not row.converged]
    if bad:
        values = [quantity(row) for row in bad]
        loads = [row.load for row in bad]
        ax.plot(loads, values, "x", color=looks["color"], markersize=5)  # type: ignore[arg-type]


def _scale(ax: Axes, runs: Sequence[Run]) -> None:
    """Make the scale logarithmic, on both sides of zero if there are unstable films."""
    if any(row.n_unstable for run in runs for row in run.rows):
        ax.set_yscale("symlog", linthresh=1.0)
        ax.axhline(0, color="0.6", linewidth=0.6, zorder=0)
    else:
        ax.set_yscale("log")


def _fit_height(ax: Axes) -> None:
    """Choose the range of values from those at the loads shown."""
    low, high = ax.get_xlim()
    shown = [np.empty(0)]
    for line in ax.lines:
        x, y = np.asarray(line.get_data(), dtype=float)
        shown.append(y[(low <= x) & (x <= high) & np.isfinite(y)])
    scale = ax.yaxis.get_transform()
    heights = scale.transform(np.concatenate(shown))
    if len(heights) and np.ptp(heights) > 0:
        margin = 0.12 * np.ptp(heights)
        limits = np.array([heights.min() - margin, heights.max() + margin])
        ax.set_ylim(*scale.inverted().transform(limits))
