"""The bifurcation diagram of a sweep; `python -m eulerplateau.plots DIR` draws it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

from eulerplateau.pictures.child import draw_in_child
from eulerplateau.pictures.figure import (
    ABS_KAPPA_N,
    BLUE,
    ORANGE,
    VERMILION,
    enlarged,
    frame,
    new_figure,
    save,
)
from eulerplateau.runs import Row, is_planar, legs, read_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_UP, _DOWN, _NOT_CONVERGED = BLUE, ORANGE, VERMILION
_SECONDS = 120.0

_PANELS: tuple[tuple[str, Callable[[Row], float]], ...] = (
    (ABS_KAPPA_N, lambda row: row.abs_kappa_n),
    (r"$-\langle K\rangle=-\int K\,dA$", lambda row: -row.total_gauss_curvature),
    ("waist twist (deg)", lambda row: abs(row.waist_twist)),
    ("short / long axis", lambda row: row.aspect),
)


def draw_diagram(folder: Path) -> bool:
    """Draw diagram.png of a run folder in a child process; return whether it was drawn."""
    return draw_in_child("eulerplateau.pictures.plots", str(folder), timeout=_SECONDS)


def plot_diagram(rows: Sequence[Row], path: Path) -> None:
    """Draw the bifurcation diagram of `rows` to the PNG file `path`.

    Over the load: the loop's total normal curvature, the order parameter of the paper
    (its fig. twisting); minus the film's total Gauss curvature; the twist of its normal
    across the waist; its aspect. Grey bands: loads at which the film is not planar. If
    the first band is narrow, a second column enlarges it. Raises OutputError if the file
    cannot be written.
    """
    bands = _bands(rows)
    window = _window(rows, bands)
    columns = 1 if window is None else 2
    figure = new_figure(columns)
    axes = figure.subplots(len(_PANELS), columns, sharex="col", sharey="row", squeeze=False)
    for column in axes.T:
        for ax, (_, quantity) in zip(column, _PANELS, strict=True):
            _draw(ax, rows, quantity, bands)
        column[-1].set_xlabel(rows[0].load_name.label if rows else "load")
    for ax, (label, _) in zip(axes[:, 0], _PANELS, strict=True):
        ax.set_ylabel(label)
    axes[2, 0].set_yticks([0, 90, 180])
    axes[3, 0].set_ylim(0, 1.05)
    if window is not None:
        axes[0, 1].set_xlim(*window)
    figure.align_ylabels()
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4, frameon=False)
    save(figure, path)


def _draw(
    ax: Axes,
    rows: Sequence[Row],
    quantity: Callable[[Row], float],
    bands: Sequence[tuple[float, float]],
) -> None:
    for number, (low, high) in enumerate(bands):
        label = "not planar" if number == 0 else None
        ax.axvspan(low, high, color="0.9", linewidth=0, zorder=0, label=label)
    drawn = set()
    for rising, leg in legs(rows):
        good = [row for row in leg if row.converged]
        name = "load rising" if rising else "load falling"
        ax.plot(
            [row.load for row in good],
            [quantity(row) for row in good],
            marker="o" if rising else "v",
            markersize=3.6 if rising else 5.0,
            markerfacecolor=_UP if rising else "none",
            linewidth=0.8,
            linestyle="-" if rising else "--",
            color=_UP if rising else _DOWN,
            label=None if name in drawn else name,
        )
        drawn.add(name)
    bad = [row for row in rows if not row.converged]
    if bad:
        ax.plot(
            [row.load for row in bad],
            [quantity(row) for row in bad],
            marker="s",
            markersize=5,
            linestyle="none",
            markerfacecolor="none",
            color=_NOT_CONVERGED,
            label="not converged",
        )
    frame(ax)


def _bands(rows: Sequence[Row]) -> list[tuple[float, float]]:
    """Return the ranges of load (low, high) where the first leg's film is not planar."""
    leg = [row for row in legs(rows)[0][1] if row.converged]
    bands = []
    for planar, alike in _planar_runs(leg):
        if not planar:
            loads = [row.load for row in alike]
            bands.append((min(loads), max(loads)))
    return bands


def _planar_runs(rows: Iterable[Row]) -> list[tuple[bool, list[Row]]]:
    return [(planar, list(alike)) for planar, alike in groupby(rows, key=is_planar)]


def _window(
    rows: Sequence[Row], bands: Sequence[tuple[float, float]]
) -> tuple[float, float] | None:
    """Return the loads to enlarge, or None if the first band is wide or there is none."""
    if not bands:
        return None
    low, high = min(bands)
    loads = [row.load for row in rows]
    return None if high == max(loads) else enlarged(low, high, loads)


if __name__ == "__main__":
    _folder = Path(sys.argv[1])
    plot_diagram(read_table(_folder), _folder / "diagram.png")
