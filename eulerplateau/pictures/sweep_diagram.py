"""The diagram of a sweep, diagram.png: four quantities over the load, up and down."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from eulerplateau.pictures.figure import (
    ABS_KAPPA_N,
    BLUE,
    MINUS_K,
    ORANGE,
    VERMILION,
    drawn,
    enlarged,
    figure_of_panels,
    save,
)
from eulerplateau.pictures.panels import Band, Look, draw_panels, legend_above, panel
from eulerplateau.runs import Run, planar_stretches, read_run

_PANELS = (
    panel(ABS_KAPPA_N, lambda row: row.abs_kappa_n),
    panel(MINUS_K, lambda row: -row.total_gauss_curvature),
    panel("waist twist (deg)", lambda row: abs(row.waist_twist), ticks=(0, 90, 180)),
    panel("short / long axis", lambda row: row.aspect, limits=(0, 1.05)),
)
_RISING: dict[str, Any] = {
    "color": BLUE, "marker": "o", "markersize": 3.6, "markerfacecolor": BLUE,
    "linewidth": 0.8, "linestyle": "-",
}  # fmt: skip
_FALLING: dict[str, Any] = {
    "color": ORANGE, "marker": "v", "markersize": 5.0, "markerfacecolor": "none",
    "linewidth": 0.8, "linestyle": "--",
}  # fmt: skip
_NOT_CONVERGED: dict[str, Any] = {
    "color": VERMILION, "marker": "s", "markersize": 5, "markerfacecolor": "none",
    "linestyle": "none", "label": "not converged",
}  # fmt: skip


def draw_diagram(folder: Path) -> bool:
    """Draw diagram.png of a run folder; return whether it was drawn, and log why not."""
    path = folder / "diagram.png"
    return drawn(str(path), lambda: plot_diagram(read_run(folder), path))


def plot_diagram(run: Run, path: Path) -> None:
    """Draw the bifurcation diagram of a sweep to the PNG file `path`.

    Over the load: the loop's total normal curvature, the order parameter of the paper
    (its fig. twisting); minus the film's total Gauss curvature; the twist of its normal
    across the waist; its aspect. Grey bands: loads at which the film is not planar. A
    second column enlarges the loads at which it first leaves its plane and returns to it,
    if they are few. Raises OutputError if the file cannot be written.
    """
    window = None
    if run.saddle is not None:
        window = enlarged(*run.saddle, (row.load for row in run.rows))
    figure = figure_of_panels(1 if window is None else 2)
    curves = [
        (series, Look(_RISING, _FALLING, _NOT_CONVERGED, series.name))
        for series in run.series
    ]
    axes = draw_panels(
        figure,
        _PANELS,
        curves,
        run.load.label,
        window=window,
        bands=_bands(run),
        one_height=True,
    )
    figure.align_ylabels()
    handles = axes[0, 0].get_legend_handles_labels()[0]
    legend_above(figure, handles, columns=4, size=10)
    save(figure, path)


def _bands(run: Run) -> list[Band]:
    """Return the ranges of load (low, high) where the first leg's film is not planar."""
    bent = [rows for planar, rows in planar_stretches(run.first_leg) if not planar]
    loads = [[row.load for row in rows] for rows in bent]
    return [(min(those), max(those)) for those in loads]
